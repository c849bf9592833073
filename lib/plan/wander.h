/* A robot that is lost moves to where more can be told apart: it stands, looks all around, then drives about.
 *
 *   ale_wander_begin(&wander);                              the pose is known
 *   velocity = ale_wander_step(&wander, &follower, &scan);  every scan while it is lost
 *
 *   standing 3 s -- turning once round -- straight on where there is room, else turning until there is --
 *   standing from 3 min on
 *
 * Nothing but the newest scan is used: grid and pose are not to be trusted. Equal rooms of a building are
 * told apart by the path into the next one (relocate/relocation.h). Steps are scans, ten a second. No error,
 * nothing is kept of what is passed. One owner. */
#ifndef ALE_PLAN_WANDER_H
#define ALE_PLAN_WANDER_H

#include <stdbool.h>
#include <stdint.h>

#include "plan/follower.h"

typedef struct {
    uint32_t steps; /* scans since the pose was known */
    bool turning;   /* to where there is room */
} ale_wander_t;

/* From the beginning. Constant time. */
void ale_wander_begin(ale_wander_t *wander);

/* Whether it still tries: for three minutes. Constant time. */
bool ale_wander_is_active(const ale_wander_t *wander);

/* What to drive after this scan, at most half as fast as the follower may. O(beams). */
ale_velocity_t ale_wander_step(ale_wander_t *wander, const ale_follower_t *follower, const ale_scan_t *scan);

#endif
