#include "map/visibility.h"

#include "base/fixed.h"
#include "base/trig.h"

enum {
    TOLERANCE_UM = 120000, /* by which the range may differ, and per mille of the range */
    TOLERANCE_PER_MILLE = 30,
    SAME_PLACE_UM = 60000, /* the same where noise and incidence alone differ */
    SAME_PLACE_PER_MILLE = 10,
    GRAZING_Q30 = 278000000, /* cosine of 75 degrees */
    BEAMS_ASIDE_MOST = 16,
    NOT_IN_VIEW = -1
};

int64_t ale_farthest_um(const ale_scan_t *scan)
{
    int32_t most_um = 0;
    for (uint32_t k = 0; k < scan->beams; k++) {
        most_um = scan->range_um[k] > most_um ? scan->range_um[k] : most_um;
    }
    return most_um;
}

/* The beam that points in a direction of the sensor's frame. Deskewing moves bearings by a few steps: the
 * index of the evenly spaced beam is corrected twice. */
static int32_t beam_towards(const ale_posed_scan_t *from, uint32_t direction_bam)
{
    const ale_scan_t *scan = from->scan;
    const bool reversed = scan->step_bam < 0;
    const uint32_t step = reversed ? 0u - (uint32_t)scan->step_bam : (uint32_t)scan->step_bam;
    const uint32_t from_first =
        reversed ? scan->first_bearing_bam - direction_bam : direction_bam - scan->first_bearing_bam;
    if (step == 0 || from_first / step >= scan->beams) {
        return NOT_IN_VIEW;
    }
    int32_t beam = (int32_t)(from_first / step);
    for (int i = 0; (from->bearing_bam || scan->own_bearings) && i < 2; i++) {
        const int32_t error = ale_bam_diff(direction_bam, ale_posed_bearing(from, beam));
        const int64_t next = beam + ale_round_div(reversed ? -(int64_t)error : error, step);
        if (next < 0 || next >= scan->beams) {
            return NOT_IN_VIEW;
        }
        beam = (int32_t)next;
    }
    return beam;
}

static ale_visibility_t beam_visibility(const ale_scan_t *scan, int32_t beam, int64_t range_um,
                                        int64_t tolerance_um, bool same_place)
{
    if (beam < 0 || beam >= scan->beams) {
        return ALE_VISIBILITY_NONE;
    }
    if (scan->flag[beam] != ALE_BEAM_VALID) {
        return same_place && scan->flag[beam] == ALE_BEAM_NO_RETURN ? ALE_VISIBILITY_VIOLATED
                                                                    : ALE_VISIBILITY_NONE;
    }
    const int64_t beyond_um = scan->range_um[beam] - range_um;
    if (beyond_um > tolerance_um) {
        return ALE_VISIBILITY_VIOLATED;
    }
    return beyond_um < -tolerance_um ? ALE_VISIBILITY_NONE : ALE_VISIBILITY_SUPPORTED;
}

/* Beams to either side of the middle one within the allowance for the pose. */
static int32_t beams_aside(const ale_scan_t *scan, int64_t range_um, int64_t slack_um)
{
    const int64_t spacing_um = ale_mul_div(range_um, ale_abs64(scan->step_bam), ALE_BAM_PER_RAD);
    return (int32_t)ale_min64(slack_um / ale_max64(spacing_um, 1), BEAMS_ASIDE_MOST);
}

/* Supported by any beam within the allowance, violated by all of them. */
static ale_visibility_t point_visibility(const ale_wall_t *wall, int64_t t_um, const ale_posed_scan_t *from,
                                         ale_slack_t slack)
{
    const ale_scan_t *scan = from->scan;
    const ale_point_t p = ale_wall_point(wall, t_um);
    const int64_t x = (int64_t)from->sensor.x_um - p.x_um;
    const int64_t y = (int64_t)from->sensor.y_um - p.y_um;
    const int64_t range_um = ale_isqrt((uint64_t)(x * x + y * y));
    const int64_t height_um = ale_round_shift(x * wall->normal_x_q30 + y * wall->normal_y_q30, 30);
    if (height_um < ale_mul_shift(range_um, GRAZING_Q30, 30) || range_um <= scan->range_min_um ||
        range_um > scan->range_max_um) {
        return ALE_VISIBILITY_NONE;
    }
    const int32_t middle = beam_towards(from, ale_atan2_bam(-y, -x) - from->sensor.theta_bam);
    if (middle == NOT_IN_VIEW) {
        return ALE_VISIBILITY_NONE;
    }
    const int64_t slack_um = slack.offset_um + ale_mul_div(range_um, slack.angle_urad, 1000000);
    const int64_t tolerance_um =
        slack_um + (slack.same_place ? SAME_PLACE_UM + range_um * SAME_PLACE_PER_MILLE / 1000
                                     : TOLERANCE_UM + range_um * TOLERANCE_PER_MILLE / 1000);
    const int32_t aside = beams_aside(scan, range_um, slack_um);
    ale_visibility_t sum = ALE_VISIBILITY_VIOLATED;
    for (int32_t beam = middle - aside; beam <= middle + aside; beam++) {
        const ale_visibility_t visibility =
            beam_visibility(scan, beam, range_um, tolerance_um, slack.same_place);
        if (visibility == ALE_VISIBILITY_SUPPORTED) {
            return visibility;
        }
        sum = visibility == ALE_VISIBILITY_NONE ? visibility : sum;
    }
    return sum;
}

ale_points_visibility_t ale_wall_points_visibility(const ale_wall_t *wall, const ale_posed_scan_t *from,
                                                   ale_slack_t slack)
{
    ale_points_visibility_t sum = {0, 0};
    for (int32_t k = 1; k < 2 * ALE_VISIBILITY_POINTS; k += 2) {
        const int64_t length_um = (int64_t)wall->end_um - wall->start_um;
        const int64_t t_um = wall->start_um + length_um * k / ((int64_t)2 * ALE_VISIBILITY_POINTS);
        const ale_visibility_t visibility = point_visibility(wall, t_um, from, slack);
        sum.supported = (uint8_t)(sum.supported + (visibility == ALE_VISIBILITY_SUPPORTED));
        sum.violated = (uint8_t)(sum.violated + (visibility == ALE_VISIBILITY_VIOLATED));
    }
    return sum;
}

ale_visibility_t ale_wall_visibility(const ale_wall_t *wall, const ale_posed_scan_t *from)
{
    const ale_points_visibility_t sum = ale_wall_points_visibility(wall, from, (ale_slack_t){0, 0, false});
    if (sum.supported > 0) {
        return ALE_VISIBILITY_SUPPORTED;
    }
    return sum.violated >= 2 ? ALE_VISIBILITY_VIOLATED : ALE_VISIBILITY_NONE;
}

ale_visibility_t ale_wall_point_visibility(const ale_wall_t *wall, int64_t t_um, const ale_posed_scan_t *from)
{
    return point_visibility(wall, t_um, from, (ale_slack_t){0, 0, false});
}
