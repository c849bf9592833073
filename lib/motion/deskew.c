#include "motion/deskew.h"

#include "base/fixed.h"
#include "base/trig.h"

enum {
    BAM_PER_RAD = 683565276,
    NEAREST_UM = 10000,
    RESTING_UM = 20,
    HIGHER_TERMS_Q30 = 1 << 16, /* square of a turn below which they are zero: 7.8 mrad */
    KNOT_BITS = 6,
    KNOT_BEAMS = 1 << KNOT_BITS
};

void ale_sensor_velocity(const int32_t robot_velocity[ALE_AXES], ale_pose_t sensor, int32_t out[ALE_AXES])
{
    const int64_t turn = robot_velocity[2];
    const ale_point_t v = {robot_velocity[0] - (int32_t)ale_round_div(turn * sensor.y_um, 1000000),
                           robot_velocity[1] + (int32_t)ale_round_div(turn * sensor.x_um, 1000000)};
    const ale_point_t own = ale_rotate(v, 0u - sensor.theta_bam);
    out[0] = own.x_um;
    out[1] = own.y_um;
    out[2] = robot_velocity[2];
}

/* Displacement over the whole scan, in um and urad, below which straightening changes nothing. */
static bool rests(const ale_scan_t *scan, const int32_t v[ALE_AXES])
{
    const int64_t sweep_us = ale_round_div((int64_t)scan->beams * scan->beam_time_ns, 1000);
    const int64_t sum = ale_abs64(v[0]) + ale_abs64(v[1]) + ale_abs64(v[2]);
    return ale_round_shift(ale_abs64(sweep_us) * sum, ALE_TICK_BITS) < RESTING_UM;
}

/* One beam, its bearing already turned: along the beam the range changes by `along`, across it the point
 * moves by `across`, which turns the bearing by atan(z), z = across / reach, and lengthens the range by
 * sqrt(1 + z^2). */
static void move_beam(int32_t *range_um, uint32_t *bearing_bam, ale_pose_t moved)
{
    const ale_direction_t d = ale_direction(*bearing_bam);
    const int64_t c = d.cos_q30;
    const int64_t s = d.sin_q30;
    const int64_t along_um = ale_round_shift(c * moved.x_um + s * moved.y_um, 30);
    const int64_t across_um = ale_round_shift(c * moved.y_um - s * moved.x_um, 30);
    const int64_t reach_um = ale_max64(*range_um + along_um, NEAREST_UM);
    const int64_t z_q30 =
        ale_clamp64(ale_round_div(across_um * ((int64_t)1 << 30), reach_um), -(1 << 29), 1 << 29);
    const int64_t zz_q30 = ale_round_shift(z_q30 * z_q30, 30);
    const int64_t z3 = ale_round_shift(z_q30 * zz_q30, 30);
    int64_t turn_q30 = z_q30 - z3 / 3;
    int64_t longer_q30 = zz_q30 / 2;
    if (zz_q30 >= HIGHER_TERMS_Q30) {
        const int64_t z5 = ale_round_shift(z3 * zz_q30, 30);
        turn_q30 += z5 / 5 - ale_round_shift(z5 * zz_q30, 30) / 7;
        longer_q30 -= ale_round_shift(zz_q30 * zz_q30, 33);
    }
    *bearing_bam += (uint32_t)(uint64_t)ale_round_shift(turn_q30 * BAM_PER_RAD, 30);
    *range_um = (int32_t)(reach_um + ale_round_shift(reach_um * longer_q30, 30));
}

/* The motion between two knots of the sweep is as good as linear: 64 beams of a URG take 6 ms, of a turn of
 * 450 in 100 ms 14 ms. */
static ale_pose_t between_knots(ale_pose_t a, ale_pose_t b, int32_t step)
{
    const int64_t turn = (int64_t)ale_bam_diff(b.theta_bam, a.theta_bam) * step;
    return (ale_pose_t){a.x_um + (int32_t)ale_round_shift(((int64_t)b.x_um - a.x_um) * step, KNOT_BITS),
                        a.y_um + (int32_t)ale_round_shift(((int64_t)b.y_um - a.y_um) * step, KNOT_BITS),
                        a.theta_bam + (uint32_t)(uint64_t)ale_round_shift(turn, KNOT_BITS)};
}

/* At the time of a beam. Where beams have bearings of their own the time does not go with their number, and
 * each is asked for. */
static ale_pose_t at_beam(const ale_scan_t *scan, const int32_t v[ALE_AXES], int32_t beam)
{
    return ale_motion_sweep(v, ale_scan_beam_offset_us(scan, beam));
}

bool ale_deskew(ale_scan_t *scan, const int32_t sensor_velocity[ALE_AXES], uint32_t bearing_bam[])
{
    if (scan->beam_time_ns == 0 || rests(scan, sensor_velocity)) {
        return false;
    }
    ale_pose_t before = {0, 0, 0};
    ale_pose_t after = at_beam(scan, sensor_velocity, 0);
    for (int32_t k = 0; k < scan->beams; k++) {
        if (k % KNOT_BEAMS == 0 && !scan->own_bearings) {
            before = after;
            after = at_beam(scan, sensor_velocity, k + KNOT_BEAMS);
        }
        const ale_pose_t moved = scan->own_bearings ? at_beam(scan, sensor_velocity, k)
                                                    : between_knots(before, after, k % KNOT_BEAMS);
        bearing_bam[k] = ale_scan_bearing(scan, k) + moved.theta_bam;
        if (scan->flag[k] == ALE_BEAM_VALID) {
            move_beam(&scan->range_um[k], &bearing_bam[k], moved);
        }
    }
    return true;
}
