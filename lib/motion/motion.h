/* The state of the robot, pose and velocity with covariance, and its prediction to the next scan.
 *
 * Covariances refer to an error in the robot's own frame (x forward, y left, heading), velocities
 * count per tick of 2^17 us, so that all six entries have the size of micrometres and microradians.
 * Between scans the velocity wanders like a robot that accelerates; wheels, when there are any,
 * measure the displacement and the velocity. Constant work. Source: paper (29) with the rotation
 * [cos -sin; sin cos], the displacement being the new pose in the frame of the old one. */
#ifndef ALE_MOTION_MOTION_H
#define ALE_MOTION_MOTION_H

#include <stdbool.h>
#include <stdint.h>

#include "base/pose.h"
#include "motion/matrix.h"

enum { ALE_TICK_BITS = 17, ALE_AXES = 3 };
#define ALE_TICK_US ((int64_t)1 << ALE_TICK_BITS)

typedef struct {
    int64_t stamp_us;
    ale_pose_t pose;
    int32_t velocity[ALE_AXES]; /* um, um, urad per tick; robot's frame */
    ale_matrix_t cov;           /* of pose (um, um, urad) and velocity */
} ale_motion_t;

/* Odometry between two scans: displacement in the frame of the first, velocity at the second, and their
 * variances (um^2, um^2, urad^2; per tick squared). */
typedef struct {
    ale_pose_t displacement;
    int64_t displacement_var[ALE_AXES];
    int32_t velocity[ALE_AXES];
    int64_t velocity_var[ALE_AXES];
    int64_t counted_um;  /* forward displacement before it was scaled */
    int64_t lag_var_um2; /* part of its variance that comes from the lag */
} ale_wheel_motion_t;

/* Adaptive process noise: factors on the variances of the motion model, learnt on line. */
typedef struct {
    int32_t factor_q8[ALE_AXES]; /* 256: as the model says */
} ale_process_noise_t;

void ale_process_noise_init(ale_process_noise_t *l);

/* Learns from one scan. A correction d of an axis has the variance before - after when both covariances are
 * right; where d^2 is larger on average, the factor grows. Constant work. */
void ale_process_noise_learn(ale_process_noise_t *l, const ale_motion_t *predicted,
                             const ale_motion_t *found);

/* A state at a pose known without error (the origin of the map), with the velocity zero within these sigmas.
 */
void ale_motion_init(ale_motion_t *motion, int64_t stamp_us, ale_pose_t pose, int32_t speed_sigma_mm_s,
                     int32_t turn_sigma_mrad_s);

/* Predicts to stamp_us by the velocity alone, or fused with odometry (wheels NULL: none). A step of no time,
 * back in time, or of more than ALE_SCAN_PERIOD_MAX_US is taken as ale_motion_jump takes it. */
void ale_motion_predict(ale_motion_t *motion, int64_t stamp_us, const ale_wheel_motion_t *wheels,
                        const ale_process_noise_t *l);

/* Predicts to stamp_us where the time between is not known: by the displacement alone, or staying within 0.2
 * m and 0.2 rad (wheels NULL); the velocity becomes unknown. */
void ale_motion_jump(ale_motion_t *motion, int64_t stamp_us, const ale_wheel_motion_t *wheels,
                     const ale_process_noise_t *l);

/* Applies an error in the robot's frame to the state: pose, then velocity. */
void ale_motion_correct(ale_motion_t *motion, const int64_t delta[ALE_STATES]);

/* Takes back the correction of position and velocity along an unobservable direction (map frame): there the
 * prediction and its variance stand (Schmidt's gain, the rows along that direction zero). The two headings
 * are nearly equal. */
void ale_motion_keep_along(ale_motion_t *found, const ale_motion_t *predicted, uint32_t along_bam);

/* The covariance of the pose in the map's frame; that of the velocity is left out. */
void ale_motion_map_covariance(const ale_motion_t *motion, ale_matrix_t *out);

/* Replaces the covariance of the pose by these sigmas; that of the velocity stays. */
void ale_motion_widen(ale_motion_t *motion, int64_t sigma_um, int64_t sigma_urad);

/* Displacement at a constant velocity over a time, in the frame of its beginning. |time_us| up to 2 s. */
ale_pose_t ale_motion_sweep(const int32_t velocity[ALE_AXES], int64_t time_us);

#endif
