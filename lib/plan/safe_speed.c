#include "plan/safe_speed.h"

#include "base/fixed.h"
#include "base/trig.h"

#define STRAIGHT_UM 1000000000
#define UNIT_PPM 1000000
#define LOOK_BAM (30u * ALE_BAM_PER_DEGREE)

static int64_t square(int64_t v)
{
    return v * v;
}

static int64_t straight_distance_um(int64_t x, int64_t y, int64_t radius_um)
{
    if (x <= 0 || ale_abs64(y) >= radius_um) {
        return INT64_MAX;
    }
    return ale_max64(0, x - ale_isqrt((uint64_t)(square(radius_um) - square(y))));
}

/* Forward and to the left round (0, turn_um). The triangle centre of turning, robot at contact, point has the
 * sides turn, distance and radius; its angle at the centre from the half-angle formula, which is stable where
 * the arc is flat. */
static int64_t arc_distance_um(int64_t x, int64_t y, int64_t radius_um, int64_t turn_um)
{
    const int64_t distance_um = ale_isqrt((uint64_t)(square(x) + square(turn_um - y)));
    const int64_t off_um = distance_um - turn_um;
    const int64_t both_um = distance_um + turn_um;
    if (ale_abs64(off_um) >= radius_um || both_um <= radius_um) {
        return INT64_MAX;
    }
    const int64_t near = ale_isqrt((uint64_t)(square(radius_um) - square(off_um)));
    const int64_t far = ale_isqrt((uint64_t)(square(both_um) - square(radius_um)));
    const int64_t to_point = ale_atan2_bam(x, turn_um - y);
    const int64_t to_contact = to_point - 2 * (int64_t)ale_atan2_bam(near, far);
    const int64_t nrad = ale_mul_div(ale_max64(0, to_contact), 6283185307, (int64_t)1 << 32);
    return ale_mul_div(nrad, turn_um, 1000000000);
}

int64_t ale_distance_to_contact_um(ale_point_t p, int32_t radius_um, int32_t speed_um_s, int32_t turn_urad_s)
{
    const int64_t x = speed_um_s < 0 ? -(int64_t)p.x_um : p.x_um;
    if (square(p.x_um) + square(p.y_um) < square(radius_um)) {
        return x > 0 ? 0 : INT64_MAX;
    }
    if (ale_abs64(speed_um_s) * UNIT_PPM >= ale_abs64(turn_urad_s) * STRAIGHT_UM) {
        return straight_distance_um(x, p.y_um, radius_um);
    }
    const int64_t turn_um =
        ale_round_div((int64_t)speed_um_s * UNIT_PPM * (turn_urad_s < 0 ? -1 : 1), ale_abs64(turn_urad_s));
    return arc_distance_um(x, turn_um < 0 ? -(int64_t)p.y_um : p.y_um, radius_um, ale_abs64(turn_um));
}

int32_t ale_stopping_speed_um_s(int64_t distance_um, const ale_robot_shape_t *shape)
{
    const int64_t farthest_um = (int64_t)1 << 31;
    const int64_t lost_um_s = ale_mul_div(shape->deceleration_um_s2, shape->reaction_us, UNIT_PPM);
    const int64_t braking = 2 * ale_min64(distance_um, farthest_um) * shape->deceleration_um_s2;
    return (int32_t)ale_clamp64(ale_isqrt((uint64_t)(square(lost_um_s) + braking)) - lost_um_s, 0, INT32_MAX);
}

/* Does the scanner look where the robot goes: at least half of the beams about that direction say something.
 */
static bool looks_ahead(const ale_scan_t *scan, const ale_pose_t *sensor, bool backward)
{
    const uint32_t ahead_bam = (backward ? ALE_BAM_HALF_TURN : 0u) - sensor->theta_bam;
    int32_t beams = 0;
    int32_t good = 0;
    for (int32_t k = 0; k < scan->beams; k++) {
        if (ale_scan_bearing(scan, k) - ahead_bam + LOOK_BAM <= 2 * LOOK_BAM) {
            beams++;
            good += scan->flag[k] != ALE_BEAM_UNKNOWN && scan->flag[k] != ALE_BEAM_BLIND;
        }
    }
    return beams > 0 && 2 * good >= beams;
}

static int32_t obstacle_um(const ale_scan_t *scan, int32_t beam)
{
    switch (scan->flag[beam]) {
    case ALE_BEAM_VALID:
    case ALE_BEAM_OUTLIER:
        return scan->range_um[beam];
    case ALE_BEAM_TOO_NEAR:
        return scan->range_min_um;
    default:
        return 0;
    }
}

static bool obstacle_at(const ale_scan_t *scan, int32_t beam, const ale_pose_t *sensor, ale_point_t *p)
{
    const int32_t range_um = obstacle_um(scan, beam);
    if (range_um <= 0) {
        return false;
    }
    *p = ale_pose_apply(*sensor, ale_rotate((ale_point_t){range_um, 0}, ale_scan_bearing(scan, beam)));
    return true;
}

/* The disc with its margin; where something stands within that already, as much of it as is free, so that the
 * robot may go along it and away from it. */
static int32_t free_radius_um(const ale_scan_t *scan, const ale_pose_t *sensor,
                              const ale_robot_shape_t *shape)
{
    const int64_t radius_um = shape->width_um / 2;
    int64_t nearest2 = square(radius_um + shape->margin_um);
    ale_point_t p;
    for (int32_t k = 0; k < scan->beams; k++) {
        if (obstacle_at(scan, k, sensor, &p)) {
            nearest2 = ale_min64(nearest2, square(p.x_um) + square(p.y_um));
        }
    }
    return (int32_t)ale_max64(radius_um, ale_isqrt((uint64_t)nearest2));
}

static int64_t free_distance_um(const ale_scan_t *scan, const ale_pose_t *sensor, int32_t radius_um,
                                int32_t speed_um_s, int32_t turn_urad_s)
{
    int64_t distance_um = INT64_MAX;
    ale_point_t p;
    for (int32_t k = 0; k < scan->beams; k++) {
        if (obstacle_at(scan, k, sensor, &p)) {
            distance_um =
                ale_min64(distance_um, ale_distance_to_contact_um(p, radius_um, speed_um_s, turn_urad_s));
        }
    }
    return distance_um;
}

int32_t ale_safe_speed_um_s(const ale_scan_t *scan, const ale_pose_t *sensor, const ale_robot_shape_t *shape,
                            int32_t wanted_um_s, int32_t wanted_urad_s)
{
    if (wanted_um_s == 0) {
        return 0;
    }
    const int32_t radius_um = free_radius_um(scan, sensor, shape);
    const int64_t distance_um = free_distance_um(scan, sensor, radius_um, wanted_um_s, wanted_urad_s);
    int64_t safe_um_s = ale_stopping_speed_um_s(distance_um, shape);
    if (!looks_ahead(scan, sensor, wanted_um_s < 0)) {
        safe_um_s = ale_min64(safe_um_s, shape->blind_um_s);
    }
    safe_um_s = ale_min64(safe_um_s, ale_abs64(wanted_um_s));
    return (int32_t)(wanted_um_s < 0 ? -safe_um_s : safe_um_s);
}
