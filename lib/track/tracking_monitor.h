/* Tracking monitor: good, weak or lost, from what the last scans showed.
 *
 * Good: the scan fits the map and, with the prediction, determines every direction. Weak: part of the pose
 * rests on the prediction (a corridor, a hall out of reach). Lost: scan after scan violates the free space of
 * walls or contradicts the last scan, or nothing has determined the pose for so long that it may be anywhere.
 * A new place comes into view little by little: that is no reason. What is good here is published as weak
 * where the scan leaves a direction open (observability.h). Constant time. */
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
    uint16_t misfits;         /* scans in a row that showed walls, but not those of the map */
    uint16_t empty_scans;     /* scans in a row that showed nothing, up to as many as matter */
    bool contradicted;        /* by the last scan, in this one */
    bool contradicted_nearby; /* the first of those misfits, by a scan that was taken close to it */
    bool in_reach; /* what is not found in the map is not there: wheels measured the motion, or the map is
                      empty */
} ale_tracking_monitor_t;

void ale_tracking_init(ale_tracking_monitor_t *monitor);

/* Whether so little of what a scan shows is found in the map that another pose should be tried. */
bool ale_tracking_doubts(const ale_fit_t *fit);

/* Whether so little is found that the last scan must be asked; more is needed once a scan did not fit. */
bool ale_tracking_is_strange(const ale_tracking_monitor_t *monitor, const ale_fit_t *fit);

/* Whether two scans, of whose way from the one to the other nothing was seen, contradict each other. */
bool ale_tracking_denies(const ale_testimony_t *testimony);

/* Whether two scans contradict each other, where wheels have told of the step from the one to the other. */
bool ale_tracking_denies_step(const ale_testimony_t *testimony);

/* Whether two scans, of whose way from the one to the other nothing was seen, confirm much of each other. */
bool ale_tracking_witnesses(const ale_testimony_t *testimony);

/* Decides whether the last scan contradicts this one, before it goes into the map. testimony: what the last
 * scan says of it, NULL where it was not asked. counted: wheels measured the motion between the two. mapped:
 * the map holds walls. */
void ale_tracking_notice(ale_tracking_monitor_t *monitor, const ale_testimony_t *testimony, bool counted,
                         bool mapped);

/* Judges a fitted scan and what it says of the walls that were not matched; returns the new state. proposed:
 * another pose waits for the next scan to confirm it; that this one may be anywhere is no loss until then. */
ale_state_t ale_tracking_judge(ale_tracking_monitor_t *monitor, const ale_fit_t *fit,
                               const ale_visibility_counts_t *visibility, bool proposed);

/* Whether the map explains a scan at a fit: most of what is shown lies on walls, and enough is shown. */
bool ale_tracking_explains(const ale_fit_t *fit);

/* Whether a fit found while lost is accepted: it explains the scan by several walls. */
bool ale_tracking_accepts(const ale_fit_t *fit);

/* Whether a fit confirms that the robot is where it is said to be: nearly all that is shown lies on walls,
 * which determine the pose. Fewer walls will do than where nobody has said anything. */
bool ale_tracking_confirms(const ale_fit_t *fit);

/* The scan at hand contradicts all that is known: lost with it. */
void ale_tracking_lose(ale_tracking_monitor_t *monitor);

/* The robot was found again, or put somewhere: weak until the next scans agree. */
void ale_tracking_found(ale_tracking_monitor_t *monitor);

/* A scan that was dropped: the state by the predicted variance. Lost stays lost. */
ale_state_t ale_tracking_skip(ale_tracking_monitor_t *monitor, const ale_motion_t *predicted);

/* Whether the map should go on from this scan: it shows enough to be followed from, nothing contradicts the
 * pose, but the map does not determine it well enough to be added to. Not so without wheels when the heading
 * is so uncertain that nothing would have been found in the map: that is judged lost. */
bool ale_tracking_may_reanchor(const ale_tracking_monitor_t *monitor, const ale_fit_t *fit);

/* Whether the pose is known well enough to add to the map. */
bool ale_tracking_may_map(const ale_tracking_monitor_t *monitor, const ale_fit_t *fit);

#endif
