#include "plan/kept_scans.h"

#include <stddef.h>

#include "base/fixed.h"
#include "base/trig.h"

enum { RANGE_STEP_UM = 4000, MOST_STEPS = UINT16_MAX - 1, NO_RETURN = UINT16_MAX, BEARING_SHIFT = 16 };
enum { STEP_UM = 100000, TURN_MRAD = 125, MOVED_UM = ALE_GRID_CELL_UM / 2, MOVED_MRAD = 5 };
/* From one kept scan to the next: farther, and the robot was put elsewhere. */
enum { FARTHEST_DRIVEN_UM = 2000000 };

void ale_kept_scans_clear(ale_kept_scans_t *kept)
{
    kept->count = 0;
    kept->thinned = 0;
}

static bool is_apart(ale_pose_t a, ale_pose_t b, int64_t um, int64_t mrad)
{
    const int64_t dx = (int64_t)a.x_um - b.x_um;
    const int64_t dy = (int64_t)a.y_um - b.y_um;
    return dx * dx + dy * dy > um * um ||
           ale_abs64(ale_bam_diff(a.theta_bam, b.theta_bam)) > mrad * ALE_BAM_PER_MRAD;
}

static void make_room(ale_kept_scans_t *kept)
{
    if (kept->count < ALE_KEPT_SCANS) {
        return;
    }
    for (size_t k = 0; k < ALE_KEPT_SCANS / 2; k++) {
        kept->scan[k] = kept->scan[2 * k];
    }
    kept->count = ALE_KEPT_SCANS / 2;
    kept->thinned++;
}

static uint16_t packed_range(const ale_scan_t *scan, int32_t k)
{
    if (scan->flag[k] == ALE_BEAM_VALID) {
        return (uint16_t)ale_clamp64(ale_round_div(scan->range_um[k], RANGE_STEP_UM), 1, MOST_STEPS);
    }
    return scan->flag[k] == ALE_BEAM_NO_RETURN ? NO_RETURN : 0;
}

void ale_kept_scans_offer(ale_kept_scans_t *kept, uint32_t number, const ale_scan_t *scan,
                          const uint32_t bearing_bam[], ale_pose_t robot)
{
    const int64_t times = INT64_C(1) << kept->thinned;
    if (kept->count > 0 &&
        !is_apart(kept->scan[kept->count - 1].robot, robot, STEP_UM * times, TURN_MRAD * times)) {
        return;
    }
    make_room(kept);
    ale_kept_scan_t *one = &kept->scan[kept->count++];
    one->number = number;
    one->robot = robot;
    one->drawn = robot;
    one->range_max_um = scan->range_max_um;
    one->beams = scan->beams;
    for (int32_t k = 0; k < scan->beams; k++) {
        one->range_4mm[k] = packed_range(scan, k);
        one->bearing_bam_q16[k] = (uint16_t)(bearing_bam[k] >> BEARING_SHIFT);
    }
}

bool ale_kept_scans_correct(ale_kept_scans_t *kept, const ale_correction_t *correction)
{
    bool moved = false;
    for (uint32_t k = 0; k < kept->count; k++) {
        ale_kept_scan_t *one = &kept->scan[k];
        one->robot = ale_pose_compose(ale_correction_at(correction, one->number), one->robot);
        moved = moved || is_apart(one->robot, one->drawn, MOVED_UM, MOVED_MRAD);
    }
    return moved;
}

static void unpack(const ale_kept_scan_t *one, ale_straight_scan_t *out)
{
    out->scan.beams = one->beams;
    out->scan.range_max_um = one->range_max_um;
    for (int32_t k = 0; k < one->beams; k++) {
        const uint16_t range = one->range_4mm[k];
        const bool valid = range != 0 && range != NO_RETURN;
        out->scan.range_um[k] = valid ? range * RANGE_STEP_UM : 0;
        out->scan.flag[k] =
            valid ? ALE_BEAM_VALID : (range == NO_RETURN ? ALE_BEAM_NO_RETURN : ALE_BEAM_UNKNOWN);
        out->bearing_bam[k] = (uint32_t)one->bearing_bam_q16[k] << BEARING_SHIFT;
    }
}

/* Straight from one place to the next, cell by cell, without the first. */
static void draw_path(ale_grid_t *grid, ale_pose_t from, ale_pose_t to, int32_t radius_um)
{
    const int64_t dx_um = (int64_t)to.x_um - from.x_um;
    const int64_t dy_um = (int64_t)to.y_um - from.y_um;
    const int64_t longer_um = ale_max64(ale_abs64(dx_um), ale_abs64(dy_um));
    const int64_t steps = longer_um < FARTHEST_DRIVEN_UM ? 1 + longer_um / ALE_GRID_CELL_UM : 1;
    for (int64_t left = steps - 1; left >= 0; left--) {
        const ale_point_t p = {to.x_um - (int32_t)(dx_um * left / steps),
                               to.y_um - (int32_t)(dy_um * left / steps)};
        ale_grid_add_disc(grid, p, radius_um);
    }
}

void ale_kept_scans_draw(ale_kept_scans_t *kept, ale_pose_t sensor, int32_t radius_um, ale_grid_t *grid,
                         ale_straight_scan_t *spare)
{
    for (uint32_t k = 0; k < kept->count; k++) {
        ale_kept_scan_t *one = &kept->scan[k];
        unpack(one, spare);
        ale_grid_add_scan(grid, &spare->scan, spare->bearing_bam, ale_pose_compose(one->robot, sensor));
        draw_path(grid, kept->scan[k > 0 ? k - 1 : 0].robot, one->robot, radius_um);
        one->drawn = one->robot;
    }
}
