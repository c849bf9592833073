/* The effect of one sigma of the odometry scale on the pose.
 *
 * The scale error is the same in every scan; treated as noise it would average out. It does not where a scan
 * says little along the path, and walls that are seen there for the first time inherit the shift of the
 * robot. So the shift that one sigma makes is carried as a vector with its sign (Schmidt's consider state):
 * it grows with the displacement; a scan reduces it by the weight of its walls against the prediction, down
 * to the shift those walls were born with; what it contributes to the displacements found is subtracted from
 * the confidence of the learnt scale. It never moves the pose. Constant work. */
#ifndef ALE_MATCH_ODOMETRY_SCALE_ERROR_H
#define ALE_MATCH_ODOMETRY_SCALE_ERROR_H

#include "base/fixed.h"
#include "match/observability.h"
#include "motion/motion.h"

/* A shift of the position, map frame; it and its negative are the same. Each within +-1 m. */
typedef struct {
    int64_t x_um;
    int64_t y_um;
} ale_scale_error_t;

/* Predicts over a displacement by odometry whose scale has this standard deviation. */
void ale_scale_error_predict(ale_scale_error_t *scale_error, ale_pose_t from, ale_pose_t to,
                             int64_t error_ppm);

/* Updates by the walls that the scan so predicted was registered to. */
void ale_scale_error_update(ale_scale_error_t *scale_error, const ale_observability_t *observability,
                            const ale_motion_t *predicted);

/* Component of the shift along a unit vector of the map frame, um. */
static inline int64_t ale_scale_error_along(const ale_scale_error_t *scale_error, int64_t x_q30,
                                            int64_t y_q30)
{
    return ale_round_shift(scale_error->x_um * x_q30 + scale_error->y_um * y_q30, 30);
}

#endif
