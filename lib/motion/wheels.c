#include "motion/wheels.h"

#include "base/fixed.h"
#include "base/trig.h"

enum {
    WINDOW_US = 100000,    /* over which the velocity is taken */
    LOOK_AHEAD_US = 50000, /* its part after the stamp, if samples are there */
    FLOOR_UM = 400,        /* errors that are there however short the way */
    FLOOR_URAD = 700,
    SIDEWAYS_PPM = 10000,
    LONG_UM = 3000000, /* way that no robot goes between two scans */
    TURN_ACCELERATION_URAD_S2 = 4000000,
    ACCELERATION_UM_S2 = 1000000
};

/* (10 m)^2: beyond that wheels say nothing. */
static const int64_t var_most = 100000000000000;

/* No larger than (100 m)^2, far beyond var_most: broken wheels leap farther than sums of squares can hold. */
static int64_t square(int64_t v)
{
    const int64_t most = 100000000;
    const int64_t size = ale_min64(ale_abs64(v), most);
    return size * size;
}

static int64_t part(int64_t v, int64_t ppm)
{
    return ale_abs64(v) * ppm / 1000000;
}

static int64_t turn_urad(ale_pose_t d)
{
    return ale_bam_to_nrad((int32_t)d.theta_bam) / 1000;
}

/* Variance of a displacement counted by the wheels: factor, slip, and heading at random with the way. */
static void way_variance(const ale_wheel_errors_t *errors, ale_pose_t d, int64_t var[ALE_AXES])
{
    const int64_t way_um = ale_abs64(d.x_um) + ale_abs64(d.y_um);
    const int64_t turn = turn_urad(d);
    var[0] = square(part(d.x_um, ale_wheel_scale_sigma_ppm(&errors->scale))) + square(FLOOR_UM);
    var[1] =
        square(part(way_um, SIDEWAYS_PPM)) + square(part(d.x_um, ale_abs64(turn) / 4)) + square(FLOOR_UM);
    var[2] = ale_mul_div(square(errors->turn_urad_m), way_um, 1000000) +
             square(part(turn, errors->turn_ppm)) + square(FLOOR_URAD);
}

/* What a long way adds, as after a while without scans: ways and turns that cancel in the displacement, and
 * the heading, which drifts on it. */
static void add_detour_variance(const ale_wheels_t *wheels, const ale_wheel_errors_t *errors, int64_t from_us,
                                int64_t to_us, ale_pose_t d, int64_t var[ALE_AXES])
{
    int64_t turned_urad;
    const int64_t way_um = ale_wheels_way_um(wheels, from_us, to_us, &turned_urad);
    if (way_um < LONG_UM) {
        return;
    }
    const int64_t detour_um = ale_max64(way_um - ale_abs64(d.x_um) - ale_abs64(d.y_um), 0);
    const int64_t detour_urad = ale_max64(turned_urad - ale_abs64(turn_urad(d)), 0);
    var[2] += ale_mul_div(square(errors->turn_urad_m), detour_um, 1000000) +
              square(part(detour_urad, errors->turn_ppm));
    const int64_t drift_um2 = square(part(way_um, (int64_t)ale_isqrt((uint64_t)var[2]))) / 3;
    var[0] += square(part(detour_um, ale_wheel_scale_sigma_ppm(&errors->scale))) + drift_um2;
    var[1] += square(part(detour_um, SIDEWAYS_PPM)) + drift_um2;
}

/* What an error of the lag makes of a motion: the largest change when it is read one sigma away. Ahead of
 * the newest sample there may be nothing to read. */
static void lag_variance(const ale_wheels_t *wheels, int32_t sigma_us, int64_t from_us, int64_t to_us,
                         ale_pose_t d, int64_t var[ALE_AXES])
{
    var[0] = var[1] = var[2] = 0;
    for (int64_t shift_us = -2 * (int64_t)sigma_us; shift_us <= sigma_us; shift_us += sigma_us) {
        ale_pose_t other;
        int32_t beyond_us;
        if (ale_wheels_motion(wheels, from_us + shift_us, to_us + shift_us, &other, &beyond_us)) {
            var[0] = ale_max64(var[0], square((int64_t)other.x_um - d.x_um));
            var[1] = ale_max64(var[1], square((int64_t)other.y_um - d.y_um));
            var[2] = ale_max64(var[2], square(turn_urad(other) - turn_urad(d)));
        }
    }
}

/* Samples that had to be extrapolated miss what the robot began in the meantime. */
static void add_extrapolation_variance(int32_t beyond_us, int64_t var[ALE_AXES])
{
    const int64_t t_ms = beyond_us / 1000;
    var[0] += square(ACCELERATION_UM_S2 / 1000 * t_ms * t_ms / 2000);
    var[2] += square(TURN_ACCELERATION_URAD_S2 / 1000 * t_ms * t_ms / 2000);
}

/* The velocity at `t_us` from a window that ends at most LOOK_AHEAD after it. */
static bool velocity_at(const ale_wheels_t *wheels, const ale_lag_t *lag, const ale_wheel_errors_t *errors,
                        int64_t t_us, ale_wheel_motion_t *out)
{
    ale_pose_t d;
    int32_t beyond_us;
    int64_t var[ALE_AXES];
    int64_t lag_var[ALE_AXES];
    int64_t ahead_us = LOOK_AHEAD_US;
    bool found = ale_wheels_motion(wheels, t_us + ahead_us - WINDOW_US, t_us + ahead_us, &d, &beyond_us);
    if (!found || beyond_us > 0) {
        ahead_us = ale_clamp64(ahead_us - beyond_us, 0, LOOK_AHEAD_US);
        ahead_us = found ? ahead_us : 0;
        found = ale_wheels_motion(wheels, t_us + ahead_us - WINDOW_US, t_us + ahead_us, &d, &beyond_us);
    }
    if (!found) {
        return false;
    }
    const uint32_t to_end = (uint32_t)((int32_t)d.theta_bam / 2);
    const ale_point_t p = ale_rotate((ale_point_t){ale_wheel_scale_apply(&errors->scale, d.x_um),
                                                   ale_wheel_scale_apply(&errors->scale, d.y_um)},
                                     0u - to_end);
    const int64_t way[ALE_AXES] = {p.x_um, p.y_um, turn_urad(d)};
    way_variance(errors, d, var);
    lag_variance(wheels, lag->sigma_us, t_us + ahead_us - WINDOW_US, t_us + ahead_us, d, lag_var);
    add_extrapolation_variance(beyond_us, var);
    /* middle of the window before t; samples farther apart than the window tell but their mean velocity */
    const int64_t apart_us = ale_max64(ale_wheels_gap_us(wheels, t_us) - WINDOW_US, 0);
    const int64_t behind_us = WINDOW_US / 2 - ahead_us + beyond_us + apart_us / 2;
    const int64_t change[ALE_AXES] = {ACCELERATION_UM_S2, ACCELERATION_UM_S2 / 5, TURN_ACCELERATION_URAD_S2};
    for (int i = 0; i < ALE_AXES; i++) {
        out->velocity[i] = (int32_t)ale_round_div(way[i] * ALE_TICK_US, WINDOW_US);
        out->velocity_var[i] =
            ale_mul_div(ale_min64(var[i] + lag_var[i], var_most), ALE_TICK_US * ALE_TICK_US,
                        (int64_t)WINDOW_US * WINDOW_US) +
            ale_min64(square(change[i] / 1000 * behind_us / 1000 * ALE_TICK_US / 1000000), var_most);
    }
    return true;
}

bool ale_wheel_motion(const ale_wheels_t *wheels, const ale_lag_t *lag, const ale_wheel_errors_t *errors,
                      int64_t from_us, int64_t to_us, ale_wheel_motion_t *out)
{
    ale_pose_t d;
    int32_t beyond_us;
    int64_t lag_var[ALE_AXES];
    const int64_t from = from_us - lag->lag_us;
    const int64_t to = to_us - lag->lag_us;
    if (!ale_wheels_motion(wheels, from, to, &d, &beyond_us)) {
        return false;
    }
    out->displacement = (ale_pose_t){ale_wheel_scale_apply(&errors->scale, d.x_um),
                                     ale_wheel_scale_apply(&errors->scale, d.y_um), d.theta_bam};
    way_variance(errors, d, out->displacement_var);
    add_detour_variance(wheels, errors, from, to, d, out->displacement_var);
    add_extrapolation_variance(beyond_us, out->displacement_var);
    lag_variance(wheels, lag->sigma_us, from, to, d, lag_var);
    for (int i = 0; i < ALE_AXES; i++) {
        out->displacement_var[i] = ale_min64(out->displacement_var[i] + lag_var[i], var_most);
    }
    out->counted_um = d.x_um;
    out->lag_var_um2 = lag_var[0];
    return velocity_at(wheels, lag, errors, to, out);
}
