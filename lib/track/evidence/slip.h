/* Two tales of how the robot went on: its wheels', and, if they slip, that it goes on as before.
 *
 * A wheel that spins in the air, or under a robot that something holds up, counts what nobody drives, and
 * does so for a while. Where the tales part by more than wheels promise, the wheels are believed until they
 * were off by 0.1 m and rad together and twice as far as the other tale, which is believed then until they
 * were nearer again; or, for this scan, as the map says (step_associate). Wheels that part from the other
 * tale are believed less along the line between the two: wheels that slip by little, but by many of their
 * sigmas, would hold the scan off its walls and make new ones. Pure functions, constant time. */
#ifndef ALE_TRACK_EVIDENCE_SLIP_H
#define ALE_TRACK_EVIDENCE_SLIP_H

#include <stdbool.h>

#include "motion/motion.h"

typedef struct {
    ale_motion_t believed;
    ale_motion_t rival; /* holds when they part */
    bool part;
    bool counted; /* what is believed is by wheels */
} ale_ways_t;

/* How far two poses lie apart. */
typedef struct {
    int64_t way_um;
    int64_t turn_urad;
} ale_apart_t;

ale_apart_t ale_apart(ale_pose_t a, ale_pose_t b);

/* Whether a pose is nearer to the rival than to what is believed; a radian counts as a metre. */
bool ale_ways_rival_is_nearer(const ale_ways_t *ways, ale_pose_t pose);

/* Of the motion by wheels and the one as before, which may be hardly known: then there is no rival. slips:
 * what ale_ways_slip said the last time. Wheels that are believed where they part have their covariance
 * widened towards the rival, which is two sigmas off then, unless it lies further than 0.15 m and rad. */
ale_ways_t ale_ways_of(const ale_motion_t *by_wheels, const ale_motion_t *as_before, bool slips);

/* Whether it is known how fast the robot went before: else there is no rival. */
bool ale_ways_rival_is_known(const ale_ways_t *ways);

/* The rival is right. */
void ale_ways_swap(ale_ways_t *ways);

/* Whether wheels slipped, now that the robot was found at a pose; only where the tales part. */
bool ale_ways_slip(const ale_ways_t *ways, ale_pose_t found, bool slips);

#endif
