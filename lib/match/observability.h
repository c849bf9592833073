/* What holds the robot: whether a scan tells the place in every direction, or leaves one to the prediction.
 *
 * The least squares believes what it matched. Along a corridor that is not enough: the last beams of a wall
 * seen at a grazing angle make small surfaces that face the robot and go along with it, and a landmark that
 * was made of such ones says that it stands. Here every match counts as what it is: a surface shows its place
 * across itself, and along itself as well as its direction is known, no better than its own length. The state
 * and the stated covariance follow it; where nothing holds and no wheels count, the robot goes on as it did
 * (ale_motion_keep_along). O(observations). */
#ifndef ALE_MATCH_OBSERVABILITY_H
#define ALE_MATCH_OBSERVABILITY_H

#include <stdbool.h>
#include <stdint.h>

#include "map/local_map.h"
#include "match/scan_to_map.h"

typedef struct {
    bool determined;    /* every direction is told better than 30 mm */
    bool degenerate;    /* one is not told to 200 mm: what was matched there goes along with the robot */
    uint32_t along_bam; /* the one that is told least, map frame */
    /* what the walls alone tell of the place: information, 1/mm^2 in Q20, and that times the shift that one
     * sigma of the wheels' scale has given to them (um), see odometry_scale_error.h */
    int64_t xx_q20;
    int64_t xy_q20;
    int64_t yy_q20;
    int64_t pull_x_q20;
    int64_t pull_y_q20;
} ale_observability_t;

/* What the matches of a fit hold; its heading is taken as known. */
ale_observability_t ale_observability_of(const ale_local_map_t *map, const ale_observation_t observation[],
                                         uint32_t count, const ale_fit_t *fit);

#endif
