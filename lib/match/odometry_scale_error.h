/* What one sigma of the wheels' scale has made of the pose.
 *
 * The scale errs alike in every scan. Taken for noise it would average out; it does not where a scan says
 * little along the way, and walls that are seen for the first time lie where the robot by then is. So what
 * one sigma of it does is carried as a shift of the place, with its sign (Schmidt's consider state): it grows
 * with the way, a scan takes from it as much as its walls weigh beside the prediction, down to what these
 * walls themselves were born with, and what it makes of the ways found is left in the scale that is learnt
 * from them. No pose hangs on it. Constant work. */
#ifndef ALE_MATCH_ODOMETRY_SCALE_ERROR_H
#define ALE_MATCH_ODOMETRY_SCALE_ERROR_H

#include "base/fixed.h"
#include "match/observability.h"
#include "motion/motion.h"

/* A shift of the place, map frame. Of either sign: it and its negative are the same. */
typedef struct {
    int64_t x_um;
    int64_t y_um;
} ale_scale_error_t;

/* The robot has gone from one place to another, as the wheels say, whose scale errs by so much. */
void ale_scale_error_predict(ale_scale_error_t *map_uncertainty, ale_pose_t from, ale_pose_t to,
                             int64_t error_ppm);

/* The scan that was predicted so was fitted to walls. */
void ale_scale_error_update(ale_scale_error_t *map_uncertainty, const ale_observability_t *observability,
                            const ale_motion_t *predicted);

/* Part of the shift along a unit vector of the map's frame, um; within +-2 m. */
static inline int64_t ale_scale_error_along(const ale_scale_error_t *map_uncertainty, int64_t x_q30,
                                            int64_t y_q30)
{
    return ale_round_shift(map_uncertainty->x_um * x_q30 + map_uncertainty->y_um * y_q30, 30);
}

#endif
