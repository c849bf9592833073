/* How well the pose is known, as it is said to others: pose to the walls around, and those to the origin. */
#ifndef ALE_TRACK_UNCERTAINTY_H
#define ALE_TRACK_UNCERTAINTY_H

#include <stdint.h>

#include "track/drift.h"
#include "track/information.h"
#include "track/motion.h"

/* Covariance of the pose in the map's frame, row by row: um^2, um nrad, nrad^2. The drift of the heading is
 * taken as gathered evenly on the way from the origin: at a vector p from there it has moved the place by
 * half of itself times p, turned a quarter, and its variance by a third of p^2 (a random walk of the heading,
 * integrated). */
void ale_map_covariance(const ale_motion_t *motion, const ale_drift_here_t *drift, int64_t out[9]);

/* Information of the scan alone, robot's frame, xx xy xt yy yt tt: 1/mm^2, 1/(mm mrad), 1/mrad^2, Q20. */
void ale_scan_information(const ale_information_t *sum, int64_t out[6]);

#endif
