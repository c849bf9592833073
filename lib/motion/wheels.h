/* Odometry from one scan to the next: read at the scans' instants, with the lag removed, the distance scaled
 * as learnt, and the variance that remains.
 *
 * The distance is wrong by a nearly constant factor (wheel_scale.h); the heading error is random and grows
 * with the distance driven. One owner; constant work per scan. */
#ifndef ALE_MOTION_WHEELS_H
#define ALE_MOTION_WHEELS_H

#include <stdbool.h>
#include <stdint.h>

#include "motion/lag.h"
#include "motion/motion.h"
#include "motion/odometry.h"
#include "motion/wheel_scale.h"

/* What is known of the errors of the wheels. */
typedef struct {
    int32_t turn_urad_m;     /* one sigma of the heading for a metre driven */
    int32_t turn_ppm;        /* one sigma of the heading in parts of the turn */
    ale_wheel_scale_t scale; /* of the distance */
} ale_wheel_errors_t;

/* Displacement and velocity between two instants of scans. False: the buffer does not cover them. */
bool ale_wheel_motion(const ale_wheels_t *wheels, const ale_lag_t *lag, const ale_wheel_errors_t *errors,
                      int64_t from_us, int64_t to_us, ale_wheel_motion_t *out);

#endif
