/* Observability: whether a scan determines the position in every direction, or leaves one to the prediction.
 *
 * The least squares believes whatever was associated. Along a corridor that is wrong: the last beams of a
 * wall at grazing incidence make short segments that face the robot and move with it, and a landmark made of
 * them claims that the robot stands still. Here each association counts as what it is: a surface determines
 * the position across itself, and along itself only as well as its direction is known, no better than its own
 * length. The tracking state and the published covariance follow it; in a degenerate direction without
 * odometry the robot keeps its velocity (ale_motion_keep_along). O(observations). */
#ifndef ALE_MATCH_OBSERVABILITY_H
#define ALE_MATCH_OBSERVABILITY_H

#include <stdbool.h>
#include <stdint.h>

#include "map/local_map.h"
#include "match/scan_to_map.h"

typedef struct {
    bool determined; /* every direction to better than ALE_DETERMINED_UM */
    bool degenerate; /* one direction to no better than 200 mm: what was associated there moves with the robot
                      */
    uint32_t along_bam; /* the least determined direction, map frame */
    /* information of the position by the walls alone, 1/mm^2 in Q20, and its product with the shift (um) that
     * one sigma of the odometry scale has given to them, see odometry_scale_error.h */
    int64_t xx_q20;
    int64_t xy_q20;
    int64_t yy_q20;
    int64_t bias_x_q20;
    int64_t bias_y_q20;
} ale_observability_t;

/* Observability of a fit that is weighed; the heading is taken as known. count: as in the scene of the fit.
 */
ale_observability_t ale_observability_of(const ale_local_map_t *map, const ale_observation_t observation[],
                                         uint32_t count, const ale_fit_t *fit);

#endif
