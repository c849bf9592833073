/* The map grows and sharpens: the paper's "the transformation is applied and added to the reference".
 *
 * An observation that found its wall sharpens and lengthens it, weighted by the covariances of observation
 * and pose; one that found none begins a new wall, but only from a well known pose and where no wall is near
 * that it might be. So old walls hold the map where it is: drift does not smear it. O(observations * near
 * walls). */
#ifndef ALE_TRACK_MAP_UPDATE_H
#define ALE_TRACK_MAP_UPDATE_H

#include <stdbool.h>
#include <stdint.h>

#include "map/local_map.h"
#include "match/map_uncertainty.h"
#include "match/odometry_scale_error.h"
#include "match/scan_to_map.h"

/* How a scan goes into the map. */
typedef struct {
    uint32_t scan;                        /* its number */
    const ale_map_uncertainty_t *here;    /* of the map at this place */
    const ale_scale_error_t *scale_error; /* of the robot: what the wheels have made of its place */
    uint32_t dilution; /* factor on the stated variances of what is known, from zero_motion.h; 1 or more */
    bool grow;         /* false: no new walls */
} ale_map_update_context_t;

/* Takes the observations of a scan, matched at fit->motion, into the map. */
void ale_map_update(ale_local_map_t *map, const ale_observation_t observation[], uint32_t count,
                    const ale_fit_t *fit, const ale_map_update_context_t *context);

#endif
