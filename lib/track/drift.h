/* How far the map itself may be off where the robot is: what makes the covariance of the pose honest.
 *
 * Matching against the map says how well the pose fits the walls around it, not how well those walls lie
 * to the place where the map began. Each wall therefore keeps the drift it was born with: that of the
 * walls by which the robot knew its pose then, and a step for the errors of that scan. Many scans average
 * noise away, but not what all of them inherit; so the robot has the mean drift of the walls it sees, and
 * has less again when it comes back to old ones. O(views). */
#ifndef ALE_TRACK_DRIFT_H
#define ALE_TRACK_DRIFT_H

#include <stdint.h>

#include "track/local_map.h"
#include "track/refine.h"

/* Mean drift of the walls that the views were matched to, weighted by length; `before` when there are none.
 */
ale_drift_t ale_drift_here(const ale_local_map_t *map, const ale_view_t view[], uint32_t count,
                           const ale_fit_t *fit, ale_drift_t before);

/* Drift of a wall that is born here, at a pose with this covariance. */
ale_drift_t ale_drift_of_new_wall(ale_drift_t here, const ale_matrix_t *cov);

#endif
