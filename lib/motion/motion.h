/* Motion of the robot: pose and velocity with their covariance, and how they go on to the next scan.
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

/* What the wheels say of the way to the next scan: displacement in the frame of the last one, velocity
 * at its end, and their variances (um^2, um^2, urad^2; per tick squared). */
typedef struct {
    ale_pose_t displacement;
    int64_t displacement_var[ALE_AXES];
    int32_t velocity[ALE_AXES];
    int64_t velocity_var[ALE_AXES];
    int64_t counted_um;  /* forward way as counted, before it was scaled */
    int64_t lag_var_um2; /* part of its variance that comes from the lag */
} ale_wheel_motion_t;

/* How much livelier the motion is than the model says: factors on its variances, learnt on line. */
typedef struct {
    int32_t factor_q8[ALE_AXES]; /* 256: as the model says */
} ale_process_noise_t;

void ale_process_noise_init(ale_process_noise_t *l);

/* Learns from one scan: a correction d of an axis has the variance before - after when prediction and scan
 * keep what they promise; when d^2 is larger on average, the prediction promised too much. */
void ale_process_noise_learn(ale_process_noise_t *l, const ale_motion_t *predicted,
                             const ale_motion_t *found);

/* At rest at a pose known without error (the origin of the map), speed unknown within what is stated. */
void ale_motion_init(ale_motion_t *motion, int64_t stamp_us, ale_pose_t pose, int32_t speed_sigma_mm_s,
                     int32_t turn_sigma_mrad_s);

/* Goes on to stamp_us: by the velocity alone, or with the wheels (NULL: none). A step of no time, back in
 * time, or of more than two seconds says nothing about velocity: without wheels the robot then is where
 * it was, within what it can have driven. */
void ale_motion_predict(ale_motion_t *motion, int64_t stamp_us, const ale_wheel_motion_t *wheels,
                        const ale_process_noise_t *l);

/* Goes on to stamp_us when the time between says nothing, as predict does for a step of no time. */
void ale_motion_jump(ale_motion_t *motion, int64_t stamp_us, const ale_wheel_motion_t *wheels,
                     const ale_process_noise_t *l);

/* Applies an error in the robot's frame to the state: pose, then velocity. */
void ale_motion_correct(ale_motion_t *motion, const int64_t delta[ALE_STATES]);

/* Of what a scan found from a prediction, takes back place and speed along a direction (map frame) that it
 * says nothing of: there the robot goes on as predicted, with the variance of that (Schmidt's gain, the rows
 * along that direction zero). The two headings differ by what one scan may turn a prediction. */
void ale_motion_keep_along(ale_motion_t *found, const ale_motion_t *predicted, uint32_t along_bam);

/* The covariance of the pose in the map's frame; that of the velocity is left out. */
void ale_motion_map_covariance(const ale_motion_t *motion, ale_matrix_t *out);

/* Forgets how well the pose is known: sigma in both directions and of the heading; keeps the velocity's. */
void ale_motion_widen(ale_motion_t *motion, int64_t sigma_um, int64_t sigma_urad);

/* Motion of a constant velocity over a time, in the frame of its beginning. |time| up to 2 s. */
ale_pose_t ale_motion_sweep(const int32_t velocity[ALE_AXES], int64_t time_us);

#endif
