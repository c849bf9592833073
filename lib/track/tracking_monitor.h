/* Good, weak or lost: how far the pose can be trusted, from what the last scans showed.
 *
 * Good: the scan fits the map and, with the prediction, determines every direction. Weak: part of the pose
 * rests on the prediction (a corridor, a hall out of reach). Lost: scan after scan looks through walls that
 * should be there, or all at once shows nothing of the map any more, or nothing has held the pose for so long
 * that it may be anywhere. A new place comes into view little by little: that is not a reason. A scan that is
 * good here is called weak to others when it leaves a direction open (observability.h). Constant time.
 */
#ifndef ALE_TRACK_TRACKING_MONITOR_H
#define ALE_TRACK_TRACKING_MONITOR_H

#include <stdbool.h>
#include <stdint.h>

#include "map/map_decay.h"
#include "match/scan_to_map.h"
#include "track/estimate.h"
#include "track/evidence/witness.h"

typedef struct {
    ale_state_t state;
    uint16_t misfits;  /* scans in a row that showed walls, but not those of the map */
    uint16_t unseeing; /* scans in a row that showed nothing, up to as many as matter */
    bool jumped;       /* in this scan */
    bool beside;       /* the first of those scans was denied by one that was taken beside it */
    bool in_reach;     /* what is not found in the map is not there: wheels told the way, or it is empty */
} ale_tracking_monitor_t;

void ale_tracking_init(ale_tracking_monitor_t *monitor);

/* Whether so little of what a scan shows is found in the map that another pose should be tried, */
bool ale_tracking_doubts(const ale_fit_t *fit);
/* and that the last scan should be heard: more is asked for once a scan did not fit. */
bool ale_tracking_is_strange(const ale_tracking_monitor_t *monitor, const ale_fit_t *fit);

/* Notices whether the scene has changed all at once; before the scan goes into the map. heard: what the last
 * scan says of this one, NULL when it was not strange. counted: wheels told the way between the two. mapped:
 * the map holds walls. */
void ale_tracking_notice(ale_tracking_monitor_t *monitor, const ale_testimony_t *heard, bool counted,
                         bool mapped);

/* Judges a fitted scan and what it says of the walls that were not matched; returns the new state. */
ale_state_t ale_tracking_judge(ale_tracking_monitor_t *monitor, const ale_fit_t *fit,
                               const ale_visibility_counts_t *visibility);

/* Whether a fit found while lost may be believed: most of what is shown lies on walls, and enough is shown.
 */
bool ale_tracking_accepts(const ale_fit_t *fit);

/* Whether a fit confirms that the robot is where it is said to be: nearly all that is shown lies on walls,
 * which determine the pose. Fewer walls will do than where nobody has said anything. */
bool ale_tracking_confirms(const ale_fit_t *fit);

/* The robot was found again, or put somewhere: weak until the next scans agree. */
void ale_tracking_found(ale_tracking_monitor_t *monitor);

/* A scan that was dropped, or showed nothing. */
ale_state_t ale_tracking_skip(ale_tracking_monitor_t *monitor, const ale_motion_t *predicted);

/* Whether the map should go on from this scan: it shows enough to be followed from, nothing speaks against
 * the pose, but the map does not hold it well enough to be added to. Not so without wheels when the heading
 * is so uncertain that nothing would have been found in the map: that is judged lost. */
bool ale_tracking_may_reanchor(const ale_tracking_monitor_t *monitor, const ale_fit_t *fit);

/* Whether the pose is known well enough to add to the map. */
bool ale_tracking_may_map(const ale_tracking_monitor_t *monitor, const ale_fit_t *fit);

#endif
