/* How well a pose explains a scan, by the map: what the scan shows and the map holds speaks for the pose,
 * walls that the scan looks through speak against it; what only one of the two holds says nothing, since maps
 * are not complete and things stand before walls. Counted in lengths of surface, of which each wall gives a
 * bounded part: beams of one surface err together. What a prediction says is weighed against that. */
#ifndef ALE_MATCH_POSE_EVIDENCE_H
#define ALE_MATCH_POSE_EVIDENCE_H

#include <stdint.h>

#include "match/scan_to_map.h"
#include "observe/posed_scan.h"

enum {
    ALE_EVIDENCE_WALLS = 192,         /* in view, that are asked for in one call at most */
    ALE_EVIDENCE_AGAINST_UM = 2500000 /* of surface that a prediction weighs at most */
};

/* Length of surface that speaks for the pose of a fit, less what speaks against it. fit: associated. from:
 * the scan at that pose. O(observations + near walls). */
int64_t ale_pose_evidence_um(const ale_scene_t *scene, const ale_fit_t *fit, const ale_posed_scan_t *from);

/* How much surface wheels, or velocity, weigh against a pose: the square of the deviation in sigmas, a tenth
 * of a metre at one, up to ALE_EVIDENCE_AGAINST_UM at five, for either may be wrong. Constant work. */
int64_t ale_pose_against_um(const ale_motion_t *predicted, ale_pose_t pose);

#endif
