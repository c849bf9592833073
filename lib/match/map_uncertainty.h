/* How far the map itself may be off where the robot is: what makes the covariance of the pose honest.
 *
 * Matching against the map says how well the pose fits the walls around it, not how well those walls lie
 * to the place where the map began. Each wall therefore keeps the drift it was born with: that of the robot
 * then, what the scan left open, and a step for the errors of that scan, which turned and moved the map about
 * the place where it was taken. Many scans average noise away, but not what all of them inherit; so the robot
 * has, in every direction, the mean drift of the walls that face there, and has less again when it comes back
 * to old ones. In a direction that no wall faces, along a corridor, it keeps what it had. O(observations).
 *
 * Drift is said as a motion about the map's origin (ale_map_uncertainty_t): a turn made far out on the way is
 * a turn and a shift together, and goes on to move what is seen later by its distance from there, not from
 * the origin. */
#ifndef ALE_MATCH_MAP_UNCERTAINTY_H
#define ALE_MATCH_MAP_UNCERTAINTY_H

#include <stdint.h>

#include "map/local_map.h"
#include "match/scan_to_map.h"
#include "motion/motion.h"

/* The drift as it is felt at a place of the map: the covariance of the motion about that place, which is that
 * of the place and of the heading there. */
ale_map_uncertainty_t ale_map_uncertainty_at(const ale_map_uncertainty_t *map_uncertainty, ale_point_t place);

/* Mean drift of the walls that the observations were matched to, weighted by length, each for the direction
 * it faces, at the place of the fit: A^(-1/2) B A^(-1/2) with A the sum of w n n^T and B that of w d n n^T;
 * the heading as the mean of all. `before` counts like walls of 0.1 m all around. */
ale_map_uncertainty_t ale_map_uncertainty_here(const ale_local_map_t *map,
                                               const ale_observation_t observation[], uint32_t count,
                                               const ale_fit_t *fit, const ale_map_uncertainty_t *before);

/* The scan leaves one direction of the map's frame to the prediction: what that adds to the variance along it
 * errs alike from scan to scan, in the velocity as in the wheels' scale, and the sigmas of the steps add up.
 * *slid_um: their sum since the robot was last held, 0 then, and 1 m at most; beyond (2 m)^2 in all it does
 * not grow. */
void ale_map_uncertainty_drift(ale_map_uncertainty_t *here, int64_t *drifted_um, uint32_t along_bam,
                               const ale_motion_t *before, const ale_motion_t *predicted);

/* Drift of what is born here, at a pose with this covariance, or is to hold the robot from here on. */
ale_map_uncertainty_t ale_map_uncertainty_inherit(const ale_map_uncertainty_t *here,
                                                  const ale_motion_t *motion);

#endif
