#include "motion/deskew.h"

#include "base/fixed.h"
#include "base/trig.h"

enum {
    NEAREST_UM = 10000,
    RESTING_UM = 20,
    HIGHER_TERMS_Q30 = 1 << 16, /* square of a turn below which they are zero: 7.8 mrad */
    KNOT_NS = 7000000,          /* apart at most, unless 8 beams take longer: 64 beams of a URG */
    LEAST_KNOT_BITS = 3,
    MOST_KNOT_BITS = 6,
    KNOTS = (ALE_MAX_BEAMS >> LEAST_KNOT_BITS) + 2,
    Q8_BITS = 8
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
    *bearing_bam += (uint32_t)(uint64_t)ale_round_shift(turn_q30 * ALE_BAM_PER_RAD, 30);
    *range_um = (int32_t)(reach_um + ale_round_shift(reach_um * longer_q30, 30));
}

/* Where the sensor was at every 2^bits-th place of the even sweep: so little apart the motion is as good as
 * linear. */
typedef struct {
    ale_pose_t knot[KNOTS];
    unsigned bits;
} sweep_t;

static void place_knots(sweep_t *s, const ale_scan_t *scan, const int32_t v[ALE_AXES])
{
    s->bits = MOST_KNOT_BITS;
    while (s->bits > LEAST_KNOT_BITS && ale_abs64(scan->beam_time_ns) << s->bits > KNOT_NS) {
        s->bits--;
    }
    for (int64_t k = 0; k <= (scan->beams >> s->bits) + 1; k++) {
        const int64_t from_stamp = (k << s->bits) - scan->stamp_beam;
        s->knot[k] = ale_motion_sweep(v, ale_round_div(from_stamp * scan->beam_time_ns, 1000));
    }
}

/* At the time of a place: 0..beams. */
static ale_pose_t at_place(const sweep_t *s, int64_t place_q8)
{
    const unsigned bits = s->bits + Q8_BITS;
    const ale_pose_t a = s->knot[place_q8 >> bits];
    const ale_pose_t b = s->knot[(place_q8 >> bits) + 1];
    const int64_t part = place_q8 & ((1 << bits) - 1);
    const int64_t turn = ale_bam_diff(b.theta_bam, a.theta_bam) * part;
    return (ale_pose_t){a.x_um + (int32_t)ale_round_shift(((int64_t)b.x_um - a.x_um) * part, bits),
                        a.y_um + (int32_t)ale_round_shift(((int64_t)b.y_um - a.y_um) * part, bits),
                        a.theta_bam + (uint32_t)(uint64_t)ale_round_shift(turn, bits)};
}

bool ale_deskew(ale_scan_t *scan, const int32_t sensor_velocity[ALE_AXES], uint32_t bearing_bam[])
{
    if (scan->beam_time_ns == 0 || rests(scan, sensor_velocity)) {
        return false;
    }
    sweep_t sweep;
    place_knots(&sweep, scan, sensor_velocity);
    for (int32_t k = 0; k < scan->beams; k++) {
        const ale_pose_t moved = at_place(&sweep, ale_scan_place_q8(scan, k));
        bearing_bam[k] = ale_scan_bearing(scan, k) + moved.theta_bam;
        if (scan->flag[k] == ALE_BEAM_VALID) {
            move_beam(&scan->range_um[k], &bearing_bam[k], moved);
        }
    }
    return true;
}
