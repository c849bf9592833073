#include "map/tile_change.h"

#include "base/fixed.h"
#include "base/trig.h"
#include "map/atlas.h"
#include "map/map_exchange.h"

enum {
    SAME_OFFSET_UM = 100000, /* what the drive has seen so near is the wall that comes */
    SAME_ANGLE_BAM = 100 * ALE_BAM_PER_MRAD,
    SAME_PERCENT = 70 /* if so much of it lies on that */
};

static bool is_listed(const ale_tile_change_t *change, uint32_t prior_id)
{
    uint32_t low = 0;
    uint32_t high = change->gone_count;
    while (low < high) {
        const uint32_t middle = (low + high) / 2;
        if (change->gone[middle] < prior_id) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return low < change->gone_count && change->gone[low] == prior_id;
}

/* A wall of the drive in the map that tiles belong to. */
static bool is_of_drive(const ale_wall_t *wall)
{
    return wall->map == ALE_FIRST_MAP && wall->prior_id == 0;
}

static void remove_gone(ale_local_map_t *map, const ale_tile_change_t *change)
{
    for (uint16_t i = map->count; change->gone_count > 0 && i > 0; i--) {
        const ale_wall_t *wall = &map->wall[i - 1];
        if (wall->map == ALE_FIRST_MAP && wall->prior_id != 0 && is_listed(change, wall->prior_id)) {
            ale_local_map_remove(map, (uint16_t)(i - 1));
        }
    }
}

static bool is_outside(const ale_wall_t *wall, const ale_box_t *window)
{
    return !ale_box_touches(window, ale_wall_point(wall, wall->start_um), ale_wall_point(wall, wall->end_um));
}

static void remove_outside(ale_local_map_t *map, const ale_box_t *window)
{
    for (uint16_t i = map->count; i > 0; i--) {
        if (is_of_drive(&map->wall[i - 1]) && is_outside(&map->wall[i - 1], window)) {
            ale_local_map_remove(map, (uint16_t)(i - 1));
        }
    }
    ale_landmarks_keep_within(&map->landmarks, ALE_FIRST_MAP, window);
    ale_map_corners_keep_within(&map->corners, ALE_FIRST_MAP, window);
}

/* A piece of a line, and how it faces. */
typedef struct {
    ale_point_t middle;
    int64_t half_um;
    uint32_t normal_bam;
} extent_t;

static extent_t extent_of(const ale_wall_t *wall)
{
    const int64_t middle_um = ((int64_t)wall->start_um + wall->end_um) / 2;
    return (extent_t){ale_wall_point(wall, middle_um), wall->end_um - middle_um, wall->normal_bam};
}

/* Whether what was seen is a part of the wall. */
static bool is_part_of(const ale_wall_t *wall, const extent_t *seen)
{
    const int64_t turned_bam = ale_bam_diff(seen->normal_bam, wall->normal_bam);
    if (turned_bam > SAME_ANGLE_BAM || turned_bam < -SAME_ANGLE_BAM ||
        ale_abs64(ale_wall_offset(wall, seen->middle)) > SAME_OFFSET_UM) {
        return false;
    }
    const int64_t t_um = ale_wall_along(wall, seen->middle);
    const int64_t common_um =
        ale_min64(wall->end_um, t_um + seen->half_um) - ale_max64(wall->start_um, t_um - seen->half_um);
    return common_um * 100 >= 2 * seen->half_um * SAME_PERCENT;
}

static bool is_part_of_any(const ale_wall_t wall[], uint32_t count, const ale_wall_t *seen)
{
    const extent_t extent = extent_of(seen);
    for (uint32_t k = 0; k < count; k++) {
        if (is_part_of(&wall[k], &extent)) {
            return true;
        }
    }
    return false;
}

static void remove_parts_of(ale_local_map_t *map, const ale_wall_t wall[], uint32_t count)
{
    for (uint16_t i = map->count; count > 0 && i > 0; i--) {
        if (is_of_drive(&map->wall[i - 1]) && is_part_of_any(wall, count, &map->wall[i - 1])) {
            ale_local_map_remove(map, (uint16_t)(i - 1));
        }
    }
}

static void add_walls(ale_local_map_t *map, const ale_tile_change_t *change)
{
    ale_wall_t wall[ALE_TILE_PIECE_WALLS];
    uint32_t count = 0;
    for (uint16_t k = 0; k < change->line_count; k++) {
        if (ale_map_line_wall(&change->line[k], &wall[count])) {
            wall[count++].prior_id = change->line[k].id;
        }
    }
    remove_parts_of(map, wall, count);
    for (uint32_t k = 0; k < count; k++) {
        const uint16_t index = ale_local_map_add(map, &wall[k]);
        if (index != ALE_NO_WALL) {
            map->wall[index].map = ALE_FIRST_MAP;
        }
    }
}

static void add_corners(ale_map_corners_t *corners, const ale_tile_change_t *change)
{
    for (uint16_t k = 0; k < change->corner_count; k++) {
        if (corners->count == ALE_MAP_MAX_CORNERS) {
            corners->refused++;
            continue;
        }
        corners->corner[corners->count] = change->corner[k];
        corners->born[corners->count] = ALE_BORN_BEFORE;
        corners->map[corners->count++] = ALE_FIRST_MAP;
    }
}

void ale_tile_change_apply(ale_local_map_t *map, const ale_tile_change_t *change)
{
    remove_gone(map, change);
    add_walls(map, change);
    if (change->last) {
        remove_outside(map, &change->window);
    }
    add_corners(&map->corners, change);
    map->version++;
}
