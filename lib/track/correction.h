/* What the mapper has found out about the past: where the map must move so that loops close.
 *
 * The robot's path, as it was tracked, is bent from keyframe to keyframe: what was first seen in scan s moves
 * by the shift of the last keyframe at or before s. A shift maps points of the map as it was to the map as it
 * is now, p' = R p + t; the robot itself, and what it has seen since, moves by the last one. What was loaded
 * stays where it is: the drive is laid on that. */
#ifndef ALE_TRACK_CORRECTION_H
#define ALE_TRACK_CORRECTION_H

#include <stdint.h>

#include "base/pose.h"
#include "map/local_map.h"
#include "track/pipeline.h"

enum { ALE_CORRECTION_SHIFTS = 2048 };

typedef struct {
    uint32_t scan; /* from this scan on */
    ale_pose_t shift;
} ale_shift_t;

struct ale_correction {
    uint32_t epoch;  /* of the map it was made for: see ale_keyframe_t */
    uint32_t number; /* of those of this map, from 1 */
    uint32_t due;    /* the scan before which it takes effect; later when it comes too late */
    uint32_t count;
    ale_shift_t shift[ALE_CORRECTION_SHIFTS]; /* scans ascending */
};

/* The shift of a scan; none before the first keyframe, nor of ALE_BORN_BEFORE. O(log count). */
ale_pose_t ale_correction_at(const ale_correction_t *correction, uint32_t scan);

/* Moves walls, landmarks and corners by the shifts of the scans that saw them first, and doubts walls that
 * moved unlike their neighbours. `spare` is working memory. O(map * log count). */
void ale_local_map_correct(ale_local_map_t *map, const ale_correction_t *correction, ale_landmarks_t *spare);

#endif
