#include "map/map_exchange.h"

#include <string.h>

#include "base/fixed.h"
#include "base/trig.h"

enum { SHORTEST_UM = 1000, NRAD_PER_URAD = 1000, NRAD2_PER_URAD2 = 1000000 };

static ale_map_line_t line_of(const ale_wall_t *w, const ale_atlas_t *atlas)
{
    return (ale_map_line_t){.id = w->id,
                            .start = ale_wall_point(w, w->start_um),
                            .end = ale_wall_point(w, w->end_um),
                            .var_alpha_nrad2 = w->var_angle_urad2 * NRAD2_PER_URAD2,
                            .cov_alpha_rho = w->cov_um_urad * NRAD_PER_URAD,
                            .var_rho_um2 = w->var_offset_um2,
                            .seen = w->seen,
                            .map_id = atlas->id[w->map]};
}

void ale_map_export(const ale_local_map_t *map, const ale_atlas_t *atlas, ale_map_t *out)
{
    memset(out, 0, sizeof *out);
    out->version = map->version;
    out->refused = map->refused + map->corners.refused;
    for (uint16_t i = 0; i < map->count; i++) {
        if (map->wall[i].seen >= ALE_MAP_CONFIRMED) {
            out->line[out->line_count++] = line_of(&map->wall[i], atlas);
        }
    }
    for (uint16_t i = 0; i < map->corners.count; i++) {
        if (map->corners.corner[i].seen >= ALE_CORNER_CONFIRMED) {
            out->corner[out->corner_count++] = map->corners.corner[i];
        }
    }
}

/* The anchor lies in the middle: where offset and angle of the whole wall are least correlated. */
bool ale_map_line_wall(const ale_map_line_t *line, ale_wall_t *out)
{
    const ale_point_t d = ale_minus(line->end, line->start);
    const uint32_t tangent_bam = ale_atan2_bam(d.y_um, d.x_um);
    const int64_t half_um = ale_along(d, tangent_bam) / 2;
    *out = (ale_wall_t){.anchor = ale_plus(line->start, ale_polar(half_um, tangent_bam)),
                        .normal_bam = tangent_bam + ALE_BAM_QUARTER_TURN,
                        .start_um = (int32_t)-half_um,
                        .end_um = (int32_t)half_um,
                        .var_offset_um2 = ale_max64(line->var_rho_um2, 1),
                        .cov_um_urad = line->cov_alpha_rho / NRAD_PER_URAD,
                        .var_angle_urad2 = ale_max64(line->var_alpha_nrad2 / NRAD2_PER_URAD2, 1),
                        .born = ALE_BORN_BEFORE,
                        .seen = line->seen};
    ale_wall_set_normal(out, tangent_bam + ALE_BAM_QUARTER_TURN);
    return half_um * 2 >= SHORTEST_UM;
}

void ale_map_import(ale_local_map_t *map, const ale_map_t *from)
{
    ale_local_map_clear(map);
    for (uint16_t i = 0; i < from->line_count && i < ALE_MAP_MAX_LINES; i++) {
        ale_wall_t wall;
        if (ale_map_line_wall(&from->line[i], &wall)) {
            ale_local_map_add(map, &wall);
        }
    }
    map->corners.count = (uint16_t)ale_min64(from->corner_count, ALE_MAP_MAX_CORNERS);
    memcpy(map->corners.corner, from->corner, map->corners.count * sizeof from->corner[0]);
    for (uint16_t i = 0; i < map->corners.count; i++) {
        map->corners.born[i] = ALE_BORN_BEFORE;
        map->corners.map[i] = map->selected;
    }
    map->version = from->version + 1;
}
