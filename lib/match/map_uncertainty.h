/* Uncertainty of the map around the robot, relative to the map's origin: what makes the published covariance
 * honest.
 *
 * Registration says how well the pose fits the walls around it, not how well those walls lie to the origin.
 * Each wall therefore keeps the uncertainty it was born with: that of the robot then, that of the scan's
 * pose, and a step for systematic errors of the scan. Many scans average noise away, but not what all of them
 * inherit. So the robot has, in each direction, the mean uncertainty of the walls that face that way, and
 * less again when it returns to old walls. In a direction that no wall faces, along a corridor, it keeps what
 * it had. O(observations).
 *
 * It is the covariance of a rigid motion about the map's origin (ale_map_uncertainty_t): a heading error made
 * far out moves what is seen later by its distance from there, not from the origin. */
#ifndef ALE_MATCH_MAP_UNCERTAINTY_H
#define ALE_MATCH_MAP_UNCERTAINTY_H

#include <stdint.h>

#include "map/local_map.h"
#include "match/scan_to_map.h"
#include "motion/motion.h"

/* The uncertainty about a place: covariance of the position there and of the heading. */
ale_map_uncertainty_t ale_map_uncertainty_at(const ale_map_uncertainty_t *map_uncertainty, ale_point_t place);

/* Mean uncertainty of the associated walls at the position of the fit, weighted by length, each for the
 * direction it faces: A^(-1/2) B A^(-1/2) with A the sum of w n n^T and B that of w d n n^T; the heading as
 * the mean of all. `before` counts like 0.1 m of wall in every direction, and is returned where no line found
 * a wall. */
ale_map_uncertainty_t ale_map_uncertainty_here(const ale_local_map_t *map,
                                               const ale_observation_t observation[], uint32_t count,
                                               const ale_fit_t *fit, const ale_map_uncertainty_t *before);

/* The scan leaves a direction of the map frame to the prediction. The error of the prediction along it
 * (velocity or odometry scale) is fully correlated between scans, so the standard deviations of the steps
 * add. *drifted_um: their sum since every direction was last determined (the caller sets it to 0 then), 1 m
 * at the most. Beyond (2 m)^2 in all the uncertainty does not grow. */
void ale_map_uncertainty_drift(ale_map_uncertainty_t *here, int64_t *drifted_um, uint32_t along_bam,
                               const ale_motion_t *before, const ale_motion_t *predicted);

/* Uncertainty of a wall that is born here at a pose with this covariance, and of a pose that is re-anchored
 * here. */
ale_map_uncertainty_t ale_map_uncertainty_inherit(const ale_map_uncertainty_t *here,
                                                  const ale_motion_t *motion);

#endif
