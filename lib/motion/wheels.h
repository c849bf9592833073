/* What the wheels say of the way from one scan to the next: odometry at the scan's own instants, with the
 * lag removed, the distance scaled as learnt, and the variance that all this leaves.
 *
 * The distance of wheels is wrong by a nearly constant factor (their diameter); it is learnt on line as
 * the quotient of the way that matching found and the way the wheels counted. Turns err at random with
 * the way driven. One owner; constant work a scan. */
#ifndef ALE_MOTION_WHEELS_H
#define ALE_MOTION_WHEELS_H

#include <stdbool.h>
#include <stdint.h>

#include "motion/lag.h"
#include "motion/motion.h"
#include "motion/odometry.h"

typedef struct {
    int32_t scale_sigma_ppm; /* of the distance, before anything is learnt */
    int32_t turn_urad_m;     /* one sigma of the heading for a metre driven */
    int32_t turn_ppm;        /* one sigma of the heading in parts of the turn */
} ale_wheel_noise_t;

typedef struct {
    ale_wheel_noise_t noise;
    int64_t found_um; /* way found by matching, and way counted, while both were good */
    int64_t counted_um;
    int64_t erred_um; /* of found_um: what one sigma of the factor has made of it */
} ale_wheel_scale_t;

void ale_wheel_scale_init(ale_wheel_scale_t *scale, const ale_wheel_noise_t *noise);

/* A way that matching found, forward, the same way as counted by the wheels, and what one sigma of the factor
 * had to do with the former (odometry_scale_error.h). */
void ale_wheel_scale_learn(ale_wheel_scale_t *scale, int64_t found_um, int64_t counted_um, int64_t erred_um);

/* One sigma of the factor as far as it errs alike from scan to scan, parts per million: what was left of it
 * in the ways it was learnt from, and no less than it swings by slowly. */
int64_t ale_wheel_scale_error_ppm(const ale_wheel_scale_t *scale);

/* The way between two scans. False when the buffer does not cover it. */
bool ale_wheel_motion(const ale_wheels_t *wheels, const ale_lag_t *lag, const ale_wheel_scale_t *scale,
                      int64_t from_us, int64_t to_us, ale_wheel_motion_t *out);

#endif
