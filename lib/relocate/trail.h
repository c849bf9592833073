/* What a lost robot has seen on its way: a few scans and where they were taken, seen from where it is now.
 *
 * A place that is proposed late must explain them too: what has been seen before the robot came into the
 * second of two equal rooms tells it from the first. Scans lie half a metre or half a radian apart; the way
 * between them is the wheels', so only as many are kept as it is good for. One owner. */
#ifndef ALE_RELOCATE_TRAIL_H
#define ALE_RELOCATE_TRAIL_H

#include <stdint.h>

#include "map/local_map.h"
#include "observe/observation.h"

enum { ALE_TRAIL_SCANS = 6 };

typedef struct {
    ale_observation_t observation[ALE_MAX_OBSERVATIONS];
    uint32_t count;
    ale_pose_t from; /* where it was taken, in the frame of the robot as it is now */
} ale_trail_scan_t;

typedef struct {
    ale_trail_scan_t scan[ALE_TRAIL_SCANS];
    uint32_t count;
    uint32_t newest;
} ale_trail_t;

void ale_trail_clear(ale_trail_t *trail);

/* The robot has gone a way in its own frame. */
void ale_trail_follow(ale_trail_t *trail, ale_pose_t way);

/* Takes a scan from where the robot is: it replaces the newest one while that is near, else the oldest.
 * `count` observations, ALE_MAX_OBSERVATIONS at most. */
void ale_trail_keep(ale_trail_t *trail, const ale_observation_t observation[], uint32_t count);

/* The newest scan; count > 0. */
const ale_trail_scan_t *ale_trail_newest(const ale_trail_t *trail);

/* Part of the lines of all scans but the newest that lies on walls with the robot at `pose`, 256: all. Scans
 * for which *looks (as for ale_associate) do not suffice are left out; 256 when none is left. The map is
 * focused on the walls that count. */
int32_t ale_trail_explained_q8(const ale_trail_t *trail, const ale_local_map_t *map, ale_pose_t pose,
                               int32_t *work);

#endif
