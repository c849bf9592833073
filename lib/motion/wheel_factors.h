/* Systematic errors of the wheels, known from a calibration drive and taken off every sample.
 *
 *   distance = distance factor * counted distance                    diameter of the wheels
 *   turn     = turn factor * (counted turn - bias * counted distance)  track width; unequal wheels
 *
 * Odometry arrives as poses, so the path is split into steps, each is corrected, and they are composed
 * again. What remains is random and belongs to the noise of `wheels.h`. Source: J. Borenstein,
 * L. Feng, "Measurement and correction of systematic odometry errors in mobile robots", 1996. One owner;
 * constant work a sample. */
#ifndef ALE_MOTION_WHEEL_FACTORS_H
#define ALE_MOTION_WHEEL_FACTORS_H

#include <stdbool.h>
#include <stdint.h>

#include "base/pose.h"

enum { ALE_WHEEL_FACTOR_ONE = 1000000 };

typedef struct {
    int32_t distance_ppm; /* parts per million: 1000000 leaves the way as it is; 500000..2000000 */
    int32_t turn_ppm;     /* the same for turns */
    int32_t bias_urad_m;  /* turn that is counted for each metre of way and was none; +-1000000 */
    bool begun;
    ale_pose_t counted;   /* the last sample, as counted, */
    ale_pose_t corrected; /* and as handed out */
} ale_wheel_factors_t;

void ale_wheel_factors_init(ale_wheel_factors_t *factors, int32_t distance_ppm, int32_t turn_ppm,
                            int32_t bias_urad_m);

/* The pose of the next sample without the systematic errors: the first one as it is. Factors of one and no
 * bias change nothing. When the corrected way leaves what a pose can hold it begins anew at the pose counted,
 * which is a jump to who reads it. */
ale_pose_t ale_wheel_factors_correct(ale_wheel_factors_t *factors, ale_pose_t counted);

#endif
