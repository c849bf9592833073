#include "map/landmarks.h"

#include <string.h>

#include "base/fixed.h"
#include "base/trig.h"
#include "motion/ratio.h"

enum {
    CELL_UM = 100000,
    FACING_BAM = 60 * ALE_BAM_PER_DEGREE,
    VAR_FLOOR_UM2 = 9000000 /* (3 mm)^2: a landmark stays open to change */
};

void ale_landmarks_clear(ale_landmarks_t *landmarks)
{
    memset(landmarks, 0, sizeof *landmarks);
}

static int32_t cell_of(int32_t v_um)
{
    return v_um >= 0 ? v_um / CELL_UM : -1 - (-1 - v_um) / CELL_UM;
}

static uint32_t set_of(int32_t cell_x, int32_t cell_y)
{
    const uint32_t h = (uint32_t)cell_x * 73856093u ^ (uint32_t)cell_y * 19349663u;
    return (h ^ h >> 15) % ALE_LANDMARK_SETS;
}

static int64_t distance2(ale_point_t a, ale_point_t b)
{
    const int64_t x = (int64_t)a.x_um - b.x_um;
    const int64_t y = (int64_t)a.y_um - b.y_um;
    return x * x + y * y;
}

static bool faces(const ale_landmark_t *m, uint32_t normal_bam, bool is_point)
{
    return (m->is_point && is_point) || ale_abs64(ale_bam_diff(m->normal_bam, normal_bam)) < FACING_BAM;
}

static uint32_t first_of_set(int32_t cell_x, int32_t cell_y)
{
    return set_of(cell_x, cell_y) * ALE_LANDMARK_WAYS;
}

int32_t ale_landmarks_find(const ale_landmarks_t *landmarks, ale_point_t p, uint32_t normal_bam,
                           bool is_point, int32_t reach_um)
{
    int32_t best = ALE_NO_LANDMARK;
    int64_t least = (int64_t)reach_um * reach_um;
    const int32_t cx = cell_of(p.x_um);
    const int32_t cy = cell_of(p.y_um);
    for (int32_t i = 0; i < 9; i++) {
        const uint32_t first = first_of_set(cx + i % 3 - 1, cy + i / 3 - 1);
        for (uint32_t k = first; k < first + ALE_LANDMARK_WAYS; k++) {
            const ale_landmark_t *m = &landmarks->landmark[k];
            const int64_t d = m->seen > 0 && m->map == landmarks->selected ? distance2(m->p, p) : INT64_MAX;
            if (d < least && faces(m, normal_bam, is_point)) {
                least = d;
                best = (int32_t)k;
            }
        }
    }
    return best;
}

void ale_landmarks_add(ale_landmarks_t *landmarks, const ale_landmark_t *landmark)
{
    ale_landmark_t *set =
        &landmarks->landmark[first_of_set(cell_of(landmark->p.x_um), cell_of(landmark->p.y_um))];
    ale_landmark_t *place = &set[0];
    for (int32_t w = 1; w < ALE_LANDMARK_WAYS; w++) {
        const bool older = set[w].seen == place->seen && set[w].last_scan < place->last_scan;
        place = set[w].seen < place->seen || older ? &set[w] : place;
    }
    *place = *landmark;
}

void ale_landmarks_give_up(ale_landmarks_t *landmarks, uint8_t map)
{
    for (uint32_t i = 0; i < ALE_LANDMARK_SETS * ALE_LANDMARK_WAYS; i++) {
        if (landmarks->landmark[i].map == map) {
            landmarks->landmark[i].seen = 0;
        }
    }
}

void ale_landmarks_keep_within(ale_landmarks_t *landmarks, uint8_t map, const ale_box_t *box)
{
    for (uint32_t i = 0; i < ALE_LANDMARK_SETS * ALE_LANDMARK_WAYS; i++) {
        ale_landmark_t *landmark = &landmarks->landmark[i];
        if (landmark->map == map && landmark->seen > 0 && !ale_box_has(box, landmark->p)) {
            landmark->seen = 0;
        }
    }
}

void ale_landmark_observe(ale_landmark_t *landmark, ale_point_t p, uint32_t normal_bam, int64_t var_um2,
                          uint32_t scan)
{
    const int64_t gain_q30 = ale_ratio_q30(landmark->var_um2, landmark->var_um2 + var_um2);
    const int64_t turn_bam = (int64_t)ale_bam_diff(normal_bam, landmark->normal_bam);
    landmark->p.x_um += (int32_t)ale_round_shift(gain_q30 * (p.x_um - landmark->p.x_um), 30);
    landmark->p.y_um += (int32_t)ale_round_shift(gain_q30 * (p.y_um - landmark->p.y_um), 30);
    landmark->normal_bam += (uint32_t)(uint64_t)ale_mul_shift(gain_q30, turn_bam, 30);
    landmark->var_um2 =
        ale_max64(landmark->var_um2 - ale_mul_shift(gain_q30, landmark->var_um2, 30), VAR_FLOOR_UM2);
    landmark->seen = (uint16_t)ale_min64(landmark->seen + 1, UINT16_MAX);
    landmark->last_scan = scan;
}
