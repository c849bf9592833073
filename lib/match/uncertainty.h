/* How well the pose is known, as it is said to others: pose to the walls around, and those to the origin. */
#ifndef ALE_MATCH_UNCERTAINTY_H
#define ALE_MATCH_UNCERTAINTY_H

#include <stdint.h>

#include "match/information.h"
#include "match/map_uncertainty.h"
#include "match/odometry_scale_error.h"
#include "motion/motion.h"

/* Covariance of the pose in the map's frame, row by row: um^2, um nrad, nrad^2. */
void ale_map_covariance(const ale_motion_t *motion, const ale_map_uncertainty_t *map_uncertainty,
                        const ale_scale_error_t *scale_error, int64_t out[9]);

/* Information of the scan alone, robot's frame, xx xy xt yy yt tt: 1/mm^2, 1/(mm mrad), 1/mrad^2, Q20. */
void ale_scan_information(const ale_information_t *sum, int64_t out[6]);

#endif
