/* Odometry from one scan to the next: read at the scans' instants, with the lag removed, the distance scaled
 * as learnt, and the variance that remains.
 *
 * The distance is wrong by a nearly constant factor (the wheels' diameter); it is learnt on line as the
 * quotient of the displacement by registration and that by odometry. The heading error is random and grows
 * with the distance driven. One owner; constant work per scan. */
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
    int64_t found_um; /* forward distance by registration, and by odometry, while both were good */
    int64_t counted_um;
    int64_t erred_um; /* part of found_um that one sigma of the factor has made */
} ale_wheel_scale_t;

void ale_wheel_scale_init(ale_wheel_scale_t *scale, const ale_wheel_noise_t *noise);

/* Learns from one scan: forward displacement by registration and by odometry, and the part of the former that
 * one sigma of the factor has made (match/odometry_scale_error.h). Displacements that differ by a third are
 * ignored. */
void ale_wheel_scale_learn(ale_wheel_scale_t *scale, int64_t found_um, int64_t counted_um, int64_t erred_um);

/* One sigma of the part of the factor's error that is the same in every scan, parts per million. */
int64_t ale_wheel_scale_error_ppm(const ale_wheel_scale_t *scale);

/* Displacement and velocity between two instants of scans. False: the buffer does not cover them. */
bool ale_wheel_motion(const ale_wheels_t *wheels, const ale_lag_t *lag, const ale_wheel_scale_t *scale,
                      int64_t from_us, int64_t to_us, ale_wheel_motion_t *out);

#endif
