/* Scans from along the robot's way through its map: have they looked through what another map holds?
 *
 * Two places may look alike, and a map of one of them then lies on the other, wall on wall. What lies beyond
 * does not: the way there has led through something that stands there. A robot that is about to join its map
 * to another one asks this first. Kept evenly: a quarter of a metre or radian apart at first, twice as far
 * whenever there is no more room. */
#ifndef ALE_TRACK_EVIDENCE_WAY_BACK_H
#define ALE_TRACK_EVIDENCE_WAY_BACK_H

#include <stdint.h>

#include "map/local_map.h"
#include "observe/seen.h"

enum { ALE_WAY_BACK = 32, ALE_WAY_BACK_WALLS = 48 /* in view of a scan that are asked for */ };

typedef struct {
    ale_seen_copy_t seen[ALE_WAY_BACK]; /* on the way that is smooth */
    uint8_t order[ALE_WAY_BACK];        /* their places, the oldest first; then those that are free */
    uint32_t count;
    int32_t apart_um; /* or as many urad */
    struct {
        uint8_t supported;
        uint8_t violated;
    } wall[ALE_MAP_MAX_LINES]; /* workspace: so many scans say so */
} ale_way_back_t;

void ale_way_back_clear(ale_way_back_t *way_back);

/* Copies the scan when the robot has gone on, or turned, since the last one. Only scans whose pose is known.
 */
void ale_way_back_keep(ale_way_back_t *way_back, const ale_seen_t *seen);

/* Length of the walls of the selected map that more of these scans have seen through than seen.
 * robot, there: where the robot is, on the way that is smooth and, if it is so, in that map.
 * O(ALE_WAY_BACK * walls); of walls in view each scan is asked for ALE_WAY_BACK_WALLS at most, another part
 * of the map than the last. */
int64_t ale_way_back_denied_um(ale_way_back_t *way_back, const ale_local_map_t *map, ale_pose_t robot,
                               ale_pose_t there);

#endif
