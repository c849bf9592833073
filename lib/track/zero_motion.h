/* How long the robot has stood where it stands.
 *
 * Looks from one place share what no averaging takes away: surfaces that stray, bearings, somebody who
 * stands before a part of a wall. Taken as so many independent ones they would let the map follow the pose
 * and the pose the map, and both would wander off together while the robot stands. The first ALE_REST_WHOLE
 * looks from a place count whole, the n-th after that like the part ALE_REST_WHOLE / n of one: an hour at
 * 10 Hz is 140 looks, and nothing changes for a robot that moves. Constant time. */
#ifndef ALE_TRACK_ZERO_MOTION_H
#define ALE_TRACK_ZERO_MOTION_H

#include <stdbool.h>
#include <stdint.h>

#include "base/pose.h"
#include "base/trig.h"

enum { ALE_REST_WHOLE = 16, ALE_REST_UM = 20000, ALE_REST_BAM = 10 * ALE_BAM_PER_MRAD };

typedef struct {
    ale_pose_t at;  /* where it came to stand */
    uint32_t looks; /* from there; 0: nothing is known */
} ale_rest_t;

void ale_rest_clear(ale_rest_t *rest);

/* One more scan, taken at this pose of the smooth frame. More than ALE_REST_UM or ALE_REST_BAM from where the
 * robot came to stand, it has gone on. */
void ale_rest_look(ale_rest_t *rest, ale_pose_t smooth);

/* Whether looks from there no longer count whole. */
bool ale_rest_is_long(const ale_rest_t *rest);

/* So many times the stated variance has the last look as one among independent ones: 1 or more. */
uint32_t ale_rest_dilution(const ale_rest_t *rest);

#endif
