/* The scan history of a lost robot: a few past scans and where they were taken, relative to the present pose.
 *
 * A place that is proposed late must explain them too: what was seen before the robot entered the second of
 * two equal rooms tells it from the first. Kept scans are half a metre or half a radian apart. Their relative
 * poses are odometry, so only as many are kept as odometry is good for. One owner. */
#ifndef ALE_RELOCATE_TRAIL_H
#define ALE_RELOCATE_TRAIL_H

#include <stdint.h>

#include "map/local_map.h"
#include "observe/observation.h"

enum { ALE_TRAIL_SCANS = 6 };

typedef struct {
    ale_observation_t observation[ALE_MAX_OBSERVATIONS];
    uint32_t count;
    ale_pose_t from; /* pose it was taken from, in the present robot frame */
} ale_trail_scan_t;

typedef struct {
    ale_trail_scan_t scan[ALE_TRAIL_SCANS];
    uint32_t count;
    uint32_t newest;
} ale_trail_t;

void ale_trail_clear(ale_trail_t *trail);

/* Moves the history by the robot's displacement, in its own frame. */
void ale_trail_follow(ale_trail_t *trail, ale_pose_t displacement);

/* Takes a scan at the present pose: it replaces the newest one while the one before that is near, else the
 * oldest. count: ALE_MAX_OBSERVATIONS at most. Copies. */
void ale_trail_keep(ale_trail_t *trail, const ale_observation_t observation[], uint32_t count);

/* The newest scan; trail->count > 0, else its content is undefined. */
const ale_trail_scan_t *ale_trail_newest(const ale_trail_t *trail);

/* Part of the lines of all scans but the newest that lies on walls when the robot is at `pose`, 256: all.
 * Considers the walls that the map is focused on. Scans for which *work (see ale_associate) does not suffice
 * are left out; 256 when none is left. */
int32_t ale_trail_explained_q8(const ale_trail_t *trail, const ale_local_map_t *map, ale_pose_t pose,
                               int32_t *work);

#endif
