/* How long the robot has stood where it stands.
 *
 * Looks from one place share what no averaging takes away: surfaces that stray, bearings, somebody who
 * stands before a part of a wall. Taken as so many independent ones they would let the map follow the pose
 * and the pose the map, and both would wander off together while the robot stands. The first
 * ALE_ZERO_MOTION_WHOLE scans from a place count whole, the n-th after that like the part
 * ALE_ZERO_MOTION_WHOLE / n of one: an hour at 10 Hz is 140 scans, and nothing changes for a robot that
 * moves. Constant time. */
#ifndef ALE_TRACK_EVIDENCE_ZERO_MOTION_H
#define ALE_TRACK_EVIDENCE_ZERO_MOTION_H

#include <stdbool.h>
#include <stdint.h>

#include "base/pose.h"
#include "base/trig.h"

enum { ALE_ZERO_MOTION_WHOLE = 16, ALE_ZERO_MOTION_UM = 20000, ALE_ZERO_MOTION_BAM = 10 * ALE_BAM_PER_MRAD };

typedef struct {
    ale_pose_t at;  /* where it came to stand */
    uint32_t scans; /* from there; 0: nothing is known */
} ale_zero_motion_t;

void ale_zero_motion_clear(ale_zero_motion_t *zero_motion);

/* One more scan, taken at this pose of the smooth frame. More than ALE_ZERO_MOTION_UM or ALE_ZERO_MOTION_BAM
 * from where the robot came to stand, it has gone on. */
void ale_zero_motion_update(ale_zero_motion_t *zero_motion, ale_pose_t smooth);

/* Whether scans from there no longer count whole. */
bool ale_zero_motion_is_long(const ale_zero_motion_t *zero_motion);

/* So many times the stated variance has the last look as one among independent ones: 1 or more. */
uint32_t ale_zero_motion_dilution(const ale_zero_motion_t *zero_motion);

#endif
