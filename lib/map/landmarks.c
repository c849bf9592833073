#include "map/landmarks.h"

#include <string.h>

#include "base/fixed.h"
#include "base/trig.h"
#include "motion/ratio.h"

enum {
    CELL_UM = 100000,
    FACING_BAM = 60 * ALE_BAM_PER_DEGREE,
    VAR_FLOOR_UM2 = 9000000 /* (3 mm)^2: a mark stays open to change */
};

void ale_marks_clear(ale_marks_t *marks)
{
    memset(marks, 0, sizeof *marks);
}

static int32_t cell_of(int32_t v_um)
{
    return v_um >= 0 ? v_um / CELL_UM : -1 - (-1 - v_um) / CELL_UM;
}

static uint32_t set_of(int32_t cell_x, int32_t cell_y)
{
    const uint32_t h = (uint32_t)cell_x * 73856093u ^ (uint32_t)cell_y * 19349663u;
    return (h ^ h >> 15) % ALE_MARK_SETS;
}

static int64_t distance2(ale_point_t a, ale_point_t b)
{
    const int64_t x = (int64_t)a.x_um - b.x_um;
    const int64_t y = (int64_t)a.y_um - b.y_um;
    return x * x + y * y;
}

static bool faces(const ale_mark_t *m, uint32_t normal_bam, bool spot)
{
    return (m->spot && spot) || ale_abs64(ale_bam_diff(m->normal_bam, normal_bam)) < FACING_BAM;
}

static uint32_t first_of_set(int32_t cell_x, int32_t cell_y)
{
    return set_of(cell_x, cell_y) * ALE_MARK_WAYS;
}

int32_t ale_marks_find(const ale_marks_t *marks, ale_point_t p, uint32_t normal_bam, bool spot,
                       int32_t reach_um)
{
    int32_t best = ALE_NO_MARK;
    int64_t least = (int64_t)reach_um * reach_um;
    const int32_t cx = cell_of(p.x_um);
    const int32_t cy = cell_of(p.y_um);
    for (int32_t i = 0; i < 9; i++) {
        const uint32_t first = first_of_set(cx + i % 3 - 1, cy + i / 3 - 1);
        for (uint32_t k = first; k < first + ALE_MARK_WAYS; k++) {
            const ale_mark_t *m = &marks->mark[k];
            const int64_t d = m->seen ? distance2(m->p, p) : INT64_MAX;
            if (d < least && faces(m, normal_bam, spot)) {
                least = d;
                best = (int32_t)k;
            }
        }
    }
    return best;
}

void ale_marks_add(ale_marks_t *marks, const ale_mark_t *mark)
{
    ale_mark_t *set = &marks->mark[first_of_set(cell_of(mark->p.x_um), cell_of(mark->p.y_um))];
    ale_mark_t *place = &set[0];
    for (int32_t w = 1; w < ALE_MARK_WAYS; w++) {
        const bool older = set[w].seen == place->seen && set[w].last_scan < place->last_scan;
        place = set[w].seen < place->seen || older ? &set[w] : place;
    }
    *place = *mark;
}

void ale_mark_observe(ale_mark_t *mark, ale_point_t p, uint32_t normal_bam, int64_t var_um2, uint32_t scan)
{
    const int64_t gain_q30 = ale_ratio_q30(mark->var_um2, mark->var_um2 + var_um2);
    const int64_t turn_bam = (int64_t)ale_bam_diff(normal_bam, mark->normal_bam);
    mark->p.x_um += (int32_t)ale_round_shift(gain_q30 * (p.x_um - mark->p.x_um), 30);
    mark->p.y_um += (int32_t)ale_round_shift(gain_q30 * (p.y_um - mark->p.y_um), 30);
    mark->normal_bam += (uint32_t)(uint64_t)ale_mul_shift(gain_q30, turn_bam, 30);
    mark->var_um2 = ale_max64(mark->var_um2 - ale_mul_shift(gain_q30, mark->var_um2, 30), VAR_FLOOR_UM2);
    mark->seen = (uint16_t)ale_min64(mark->seen + 1, UINT16_MAX);
    mark->last_scan = scan;
    mark->missed = 0;
}
