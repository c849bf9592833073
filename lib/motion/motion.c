#include "motion/motion.h"

#include "base/fixed.h"
#include "base/trig.h"
#include "motion/projection.h"
#include "motion/ratio.h"
#include "motion/timestamp_filter.h"

enum {
    FORWARD = 0,
    LEFT = 1,
    TURN = 2,
    FACTOR_LEAST_Q8 = 256,
    FACTOR_MOST_Q8 = 256 * 4,
    SURPRISE_MOST_Q8 = 256 * 9,
    ADAPT_SCANS = 16
};

/* One sigma of the acceleration of a small robot: um/s^2 forward and sideways, urad/s^2. */
static const int64_t acceleration[ALE_AXES] = {1500000, 300000, 5000000};

/* No more is unknown than 3 m, 1.5 rad, and what is fast for a small robot; and nothing is faster. */
static const int64_t most_var[ALE_STATES] = {9000000000000, 9000000000000, 2250000000000,
                                             400000000000,  400000000000,  1600000000000};
static const int64_t most_velocity[ALE_AXES] = {1310720, 655360, 1310720}; /* 10 m/s, 5 m/s, 10 rad/s */

/* Position and turn that are given up when time says nothing: a robot may have driven this far. */
static const int64_t unknown_step[ALE_AXES] = {200000, 200000, 200000};
static const int64_t unknown_velocity[ALE_AXES] = {60000, 20000, 120000};

/* A micro-motion (um, um, urad) as a pose. */
static ale_pose_t pose_of_step(int64_t x_um, int64_t y_um, int64_t turn_urad)
{
    const int64_t turn_bam = ale_round_div(turn_urad * ALE_BAM_PER_RAD, 1000000);
    return (ale_pose_t){(int32_t)x_um, (int32_t)y_um, (uint32_t)(uint64_t)turn_bam};
}

/* Along the chord: the displacement of an arc is v t, turned by half the angle, shortened by a^2/24. */
ale_pose_t ale_motion_sweep(const int32_t velocity[ALE_AXES], int64_t time_us)
{
    int64_t d[ALE_AXES];
    for (int i = 0; i < ALE_AXES; i++) {
        d[i] = ale_round_shift(velocity[i] * time_us, ALE_TICK_BITS);
    }
    const ale_pose_t end = pose_of_step(d[0], d[1], d[2]);
    const int64_t half_mrad = ale_clamp64(d[TURN], -3000000, 3000000) / 2000;
    const int64_t chord_q20 = ((int64_t)1 << 20) - half_mrad * half_mrad * (1 << 20) / 6000000;
    const ale_point_t p = {(int32_t)ale_round_shift(d[0] * chord_q20, 20),
                           (int32_t)ale_round_shift(d[1] * chord_q20, 20)};
    const ale_point_t q = ale_rotate(p, (uint32_t)((int32_t)end.theta_bam / 2));
    return (ale_pose_t){q.x_um, q.y_um, end.theta_bam};
}

void ale_motion_init(ale_motion_t *motion, int64_t stamp_us, ale_pose_t pose, int32_t speed_sigma_mm_s,
                     int32_t turn_sigma_mrad_s)
{
    const int64_t forward = ((int64_t)speed_sigma_mm_s * 1000 * ALE_TICK_US) / 1000000;
    const int64_t turn = ((int64_t)turn_sigma_mrad_s * 1000 * ALE_TICK_US) / 1000000;
    *motion = (ale_motion_t){.stamp_us = stamp_us, .pose = pose};
    for (int i = 0; i < ALE_AXES; i++) {
        motion->cov.m[i][i] = 1;
    }
    motion->cov.m[3][3] = forward * forward + 1;
    motion->cov.m[4][4] = forward * forward / 16 + 1;
    motion->cov.m[5][5] = turn * turn + 1;
}

void ale_process_noise_init(ale_process_noise_t *l)
{
    for (int i = 0; i < ALE_AXES; i++) {
        l->factor_q8[i] = FACTOR_LEAST_Q8;
    }
}

void ale_process_noise_learn(ale_process_noise_t *l, const ale_motion_t *predicted, const ale_motion_t *found)
{
    const ale_pose_t step = ale_pose_between(predicted->pose, found->pose);
    const int64_t correction[ALE_AXES] = {step.x_um, step.y_um,
                                          ale_bam_to_nrad((int32_t)step.theta_bam) / 1000};
    for (int i = 0; i < ALE_AXES; i++) {
        const int64_t expected = predicted->cov.m[i][i] - found->cov.m[i][i];
        if (expected <= 0) {
            continue;
        }
        const int64_t d = ale_clamp64(correction[i], -1000000, 1000000);
        const int64_t surprise_q8 = ale_min64((d * d << 8) / expected, SURPRISE_MOST_Q8);
        const int64_t factor =
            l->factor_q8[i] + (int64_t)l->factor_q8[i] * (surprise_q8 - 256) / ((int64_t)256 * ADAPT_SCANS);
        l->factor_q8[i] = (int32_t)ale_clamp64(factor, FACTOR_LEAST_Q8, FACTOR_MOST_Q8);
    }
}

/* Errors of the old frame as seen from the new one: the adjoint of the inverse displacement. */
static void carry_pose_error(ale_pose_t d, int64_t f_q20[ALE_STATES][ALE_STATES])
{
    const int64_t c = ale_round_shift(ale_cos_q30(d.theta_bam), 10);
    const int64_t s = ale_round_shift(ale_sin_q30(d.theta_bam), 10);
    const int64_t x_m_q20 = ale_round_div((int64_t)d.x_um * (1 << 20), 1000000);
    const int64_t y_m_q20 = ale_round_div((int64_t)d.y_um * (1 << 20), 1000000);
    f_q20[0][0] = c;
    f_q20[0][1] = s;
    f_q20[1][0] = -s;
    f_q20[1][1] = c;
    f_q20[0][2] = ale_round_shift(-c * y_m_q20 + s * x_m_q20, 20);
    f_q20[1][2] = ale_round_shift(s * y_m_q20 + c * x_m_q20, 20);
    f_q20[2][2] = (int64_t)1 << 20;
}

/* An acceleration held over the step: dv = a t, and half of it goes into the way. */
static void acceleration_noise(int axis, int64_t dt_us, int64_t *way, int64_t *velocity)
{
    *velocity =
        ale_round_shift(ale_round_div(acceleration[axis] * dt_us, 1000000) * ALE_TICK_US, 0) / 1000000;
    *way = ale_round_shift(*velocity * dt_us, ALE_TICK_BITS + 1);
}

static int64_t scaled_noise(const ale_process_noise_t *l, int axis, int64_t var)
{
    return ale_mul_shift(var, l->factor_q8[axis], 8);
}

static void predict_free(ale_motion_t *m, int64_t dt_us, const ale_process_noise_t *l)
{
    const ale_pose_t d = ale_motion_sweep(m->velocity, dt_us);
    int64_t f_q20[ALE_STATES][ALE_STATES] = {{0}};
    ale_matrix_t cov;
    carry_pose_error(d, f_q20);
    for (int i = 0; i < ALE_AXES; i++) {
        f_q20[i][i + 3] = ale_round_shift(dt_us << 20, ALE_TICK_BITS);
        f_q20[i + 3][i + 3] = (int64_t)1 << 20;
    }
    ale_matrix_congruence(f_q20, &m->cov, &cov);
    for (int i = 0; i < ALE_AXES; i++) {
        int64_t way;
        int64_t velocity;
        acceleration_noise(i, dt_us, &way, &velocity);
        cov.m[i][i] += scaled_noise(l, i, way * way);
        cov.m[i][i + 3] += scaled_noise(l, i, way * velocity);
        cov.m[i + 3][i] += scaled_noise(l, i, way * velocity);
        cov.m[i + 3][i + 3] += scaled_noise(l, i, velocity * velocity);
    }
    m->pose = ale_pose_compose(m->pose, d);
    m->cov = cov;
}

/* Way and velocity of one axis with their covariance. */
typedef struct {
    int64_t way;
    int64_t velocity;
    int64_t ww;
    int64_t wv;
    int64_t vv;
} axis_t;

static void measure_way(axis_t *a, int64_t way, int64_t var)
{
    const int64_t s = a->ww + var;
    const int64_t gain_way = ale_ratio_q30(a->ww, s);
    const int64_t gain_velocity = ale_ratio_q30(a->wv, s);
    const int64_t error = way - a->way;
    a->way += ale_mul_shift(gain_way, error, 30);
    a->velocity += ale_mul_shift(gain_velocity, error, 30);
    a->vv -= ale_mul_shift(gain_velocity, a->wv, 30);
    a->wv -= ale_mul_shift(gain_way, a->wv, 30);
    a->ww -= ale_mul_shift(gain_way, a->ww, 30);
}

static void measure_velocity(axis_t *a, int64_t velocity, int64_t var)
{
    axis_t swapped = {a->velocity, a->way, a->vv, a->wv, a->ww};
    measure_way(&swapped, velocity, var);
    *a = (axis_t){swapped.velocity, swapped.way, swapped.vv, swapped.wv, swapped.ww};
}

/* How one axis goes on, from the velocity so far and from the wheels. */
static axis_t fuse_axis(const ale_motion_t *m, int i, int64_t dt_us, const ale_wheel_motion_t *wheels,
                        int64_t wheels_way, const ale_process_noise_t *l)
{
    const int64_t var = m->cov.m[i + 3][i + 3];
    const int64_t dt_q20 = ale_round_shift(dt_us << 20, ALE_TICK_BITS);
    int64_t way;
    int64_t velocity;
    acceleration_noise(i, dt_us, &way, &velocity);
    axis_t a = {.way = ale_round_shift(m->velocity[i] * dt_us, ALE_TICK_BITS), .velocity = m->velocity[i]};
    a.vv = var + velocity * velocity;
    a.wv = ale_mul_shift(var, dt_q20, 20) + way * velocity;
    a.ww = ale_mul_shift(ale_mul_shift(var, dt_q20, 20), dt_q20, 20) + way * way;
    measure_way(&a, wheels_way, scaled_noise(l, i, wheels->displacement_var[i]));
    measure_velocity(&a, wheels->velocity[i], scaled_noise(l, i, wheels->velocity_var[i]));
    return a;
}

/* With wheels the velocity begins anew: its correlation with the last pose is small and is dropped. */
static void predict_with_wheels(ale_motion_t *m, int64_t dt_us, const ale_wheel_motion_t *wheels,
                                const ale_process_noise_t *l)
{
    const ale_pose_t d = wheels->displacement;
    const uint32_t half = (uint32_t)((int32_t)d.theta_bam / 2);
    const ale_point_t chord = ale_rotate((ale_point_t){d.x_um, d.y_um}, 0u - half);
    const int64_t way[ALE_AXES] = {chord.x_um, chord.y_um, ale_bam_to_nrad((int32_t)d.theta_bam) / 1000};
    axis_t a[ALE_AXES];
    for (int i = 0; i < ALE_AXES; i++) {
        a[i] = fuse_axis(m, i, dt_us, wheels, way[i], l);
    }
    const ale_pose_t turn = pose_of_step(0, 0, a[TURN].way);
    const ale_point_t p = ale_rotate((ale_point_t){(int32_t)a[FORWARD].way, (int32_t)a[LEFT].way},
                                     (uint32_t)((int32_t)turn.theta_bam / 2));
    const ale_pose_t step = {p.x_um, p.y_um, turn.theta_bam};
    int64_t f_q20[ALE_STATES][ALE_STATES] = {{0}};
    ale_matrix_t cov;
    carry_pose_error(step, f_q20);
    ale_matrix_congruence(f_q20, &m->cov, &cov);
    for (int i = 0; i < ALE_AXES; i++) {
        cov.m[i][i] += a[i].ww;
        cov.m[i][i + 3] = cov.m[i + 3][i] = a[i].wv;
        cov.m[i + 3][i + 3] = a[i].vv + 1;
        m->velocity[i] = (int32_t)ale_clamp64(a[i].velocity, -most_velocity[i], most_velocity[i]);
    }
    m->pose = ale_pose_compose(m->pose, step);
    m->cov = cov;
}

/* Wheels alone: no velocity goes into the step or comes out of it. */
static void predict_jump(ale_motion_t *m, const ale_wheel_motion_t *wheels, const ale_process_noise_t *l)
{
    const ale_pose_t d = wheels ? wheels->displacement : (ale_pose_t){0, 0, 0};
    int64_t f_q20[ALE_STATES][ALE_STATES] = {{0}};
    ale_matrix_t cov;
    carry_pose_error(d, f_q20);
    ale_matrix_congruence(f_q20, &m->cov, &cov);
    for (int i = 0; i < ALE_AXES; i++) {
        cov.m[i][i] +=
            wheels ? scaled_noise(l, i, wheels->displacement_var[i]) : unknown_step[i] * unknown_step[i];
        cov.m[i + 3][i + 3] = unknown_velocity[i] * unknown_velocity[i];
        m->velocity[i] = 0;
    }
    m->pose = ale_pose_compose(m->pose, d);
    m->cov = cov;
}

/* Keeps the numbers within what the formats are made for: an error that has grown beyond its bound is as
 * good as any, and no longer correlated with the others. */
static void bound(ale_motion_t *m)
{
    for (int i = 0; i < ALE_STATES; i++) {
        if (m->cov.m[i][i] > most_var[i]) {
            for (int j = 0; j < ALE_STATES; j++) {
                m->cov.m[i][j] = m->cov.m[j][i] = 0;
            }
            m->cov.m[i][i] = most_var[i];
        }
    }
    for (int i = 0; i < ALE_AXES; i++) {
        m->velocity[i] = (int32_t)ale_clamp64(m->velocity[i], -most_velocity[i], most_velocity[i]);
    }
}

void ale_motion_jump(ale_motion_t *motion, int64_t stamp_us, const ale_wheel_motion_t *wheels,
                     const ale_process_noise_t *l)
{
    predict_jump(motion, wheels, l);
    motion->stamp_us = stamp_us;
    bound(motion);
}

void ale_motion_predict(ale_motion_t *motion, int64_t stamp_us, const ale_wheel_motion_t *wheels,
                        const ale_process_noise_t *l)
{
    const int64_t dt_us = stamp_us - motion->stamp_us;
    if (dt_us <= 0 || dt_us > ALE_SCAN_PERIOD_MAX_US) {
        ale_motion_jump(motion, stamp_us, wheels, l);
        return;
    }
    if (wheels) {
        predict_with_wheels(motion, dt_us, wheels, l);
    } else {
        predict_free(motion, dt_us, l);
    }
    motion->stamp_us = stamp_us;
    bound(motion);
}

void ale_motion_correct(ale_motion_t *motion, const int64_t delta[ALE_STATES])
{
    motion->pose = ale_pose_compose(motion->pose, pose_of_step(delta[0], delta[1], delta[2]));
    for (int i = 0; i < ALE_AXES; i++) {
        motion->velocity[i] =
            (int32_t)ale_clamp64(motion->velocity[i] + delta[i + 3], -most_velocity[i], most_velocity[i]);
    }
}

static ale_point_t part_along(const ale_projection_t *a, int64_t x, int64_t y)
{
    return (ale_point_t){(int32_t)ale_round_shift(a->xx_q20 * x + a->xy_q20 * y, 20),
                         (int32_t)ale_round_shift(a->xy_q20 * x + a->yy_q20 * y, 20)};
}

/* Restores the variance that the scan has removed along that direction. */
static void restore_variance(const ale_projection_t *a, const ale_matrix_t *predicted, ale_matrix_t *found)
{
    int64_t f_q20[ALE_STATES][ALE_STATES] = {{0}};
    for (int i = 0; i < ALE_STATES; i += ALE_AXES) {
        f_q20[i][i] = a->xx_q20;
        f_q20[i][i + 1] = f_q20[i + 1][i] = a->xy_q20;
        f_q20[i + 1][i + 1] = a->yy_q20;
    }
    ale_matrix_t taken;
    ale_matrix_t back;
    for (int i = 0; i < ALE_STATES; i++) {
        for (int j = 0; j < ALE_STATES; j++) {
            taken.m[i][j] = predicted->m[i][j] - found->m[i][j];
        }
    }
    ale_matrix_congruence(f_q20, &taken, &back);
    for (int i = 0; i < ALE_STATES; i++) {
        for (int j = 0; j < ALE_STATES; j++) {
            found->m[i][j] += back.m[i][j];
        }
    }
}

void ale_motion_keep_along(ale_motion_t *found, const ale_motion_t *predicted, uint32_t along_bam)
{
    const ale_projection_t a = ale_projection(along_bam - predicted->pose.theta_bam);
    restore_variance(&a, &predicted->cov, &found->cov);
    ale_pose_t step = ale_pose_between(predicted->pose, found->pose);
    const ale_point_t way = part_along(&a, step.x_um, step.y_um);
    step.x_um -= way.x_um;
    step.y_um -= way.y_um;
    found->pose = ale_pose_compose(predicted->pose, step);
    const ale_point_t faster =
        part_along(&a, (int64_t)found->velocity[FORWARD] - predicted->velocity[FORWARD],
                   (int64_t)found->velocity[LEFT] - predicted->velocity[LEFT]);
    found->velocity[FORWARD] -= faster.x_um;
    found->velocity[LEFT] -= faster.y_um;
}

void ale_motion_map_covariance(const ale_motion_t *motion, ale_matrix_t *out)
{
    const int64_t c = ale_round_shift(ale_cos_q30(motion->pose.theta_bam), 10);
    const int64_t s = ale_round_shift(ale_sin_q30(motion->pose.theta_bam), 10);
    const int64_t one = (int64_t)1 << 20;
    const int64_t f_q20[ALE_STATES][ALE_STATES] = {{c, -s, 0}, {s, c, 0}, {0, 0, one}};
    ale_matrix_congruence(f_q20, &motion->cov, out);
}

void ale_motion_widen(ale_motion_t *motion, int64_t sigma_um, int64_t sigma_urad)
{
    const int64_t var[ALE_AXES] = {sigma_um * sigma_um, sigma_um * sigma_um, sigma_urad * sigma_urad};
    for (int i = 0; i < ALE_AXES; i++) {
        for (int j = 0; j < ALE_STATES; j++) {
            motion->cov.m[i][j] = motion->cov.m[j][i] = 0;
        }
        motion->cov.m[i][i] = var[i];
    }
}
