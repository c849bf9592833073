/* What the mapper has found out about the past: where the map must move so that loops close.
 *
 * The robot's path, as it was tracked, is bent from keyframe to keyframe: what was first seen in scan s moves
 * by the shift of the last keyframe at or before s. A shift maps points of the map as it was to the map as it
 * is now, p' = R p + t; the robot itself, and what it has seen since, moves by the last one. What was loaded
 * stays where it is: the drive is laid on that.
 *
 * A correction may join two maps (map/atlas.h): all of the one moves by one shift, and is part of the other
 * from then on. */
#ifndef ALE_TRACK_CORRECTION_H
#define ALE_TRACK_CORRECTION_H

#include <stdbool.h>
#include <stdint.h>

#include "base/pose.h"
#include "map/local_map.h"

enum { ALE_CORRECTION_SHIFTS = 2048 };

typedef struct {
    uint32_t scan; /* from this scan on */
    ale_pose_t shift;
} ale_shift_t;

typedef struct ale_correction {
    uint32_t epoch;  /* of the map it was made for: see ale_keyframe_t */
    uint32_t number; /* of those of this map, from 1 */
    uint32_t due;    /* the scan before which it takes effect; later when it comes too late */
    uint32_t count;
    bool joins;             /* the map below has become part of the other */
    uint32_t joined_map_id; /* the robot's, or, if that is the first map, another. Is it no more, because the
                               robot has joined it elsewhere by itself, then this correction is void: it
                               counts as applied, and nothing moves */
    uint32_t into_map_id;   /* which the tracker may have given up */
    ale_shift_t shift[ALE_CORRECTION_SHIFTS]; /* scans ascending */
} ale_correction_t;

/* The shift of a scan; none before the first keyframe, nor of ALE_BORN_BEFORE. O(log count). */
ale_pose_t ale_correction_at(const ale_correction_t *correction, uint32_t scan);

/* Whether a shift has moved what lay at a place before and lies at another after it, or turned it, by more
 * than walls and robot are known. Any places. Constant time. */
bool ale_correction_is_news(ale_point_t before, ale_point_t after, ale_pose_t shift);

/* A map that has moved, to join another one, since a correction was made for it where it was. */
typedef struct {
    uint32_t from_scan; /* its first one, */
    uint32_t to_scan;   /* and that at which it moved */
    ale_pose_t shift;
} ale_moved_map_t;

/* The shift of a scan, as seen from where its map is now. */
ale_pose_t ale_correction_in(const ale_correction_t *correction, uint32_t scan, const ale_moved_map_t *moved);

/* Moves walls, landmarks and corners by the shifts of the scans that saw them first, and doubts walls that
 * moved unlike their neighbours. `spare` is working memory. O(map * log count). */
void ale_local_map_correct(ale_local_map_t *map, const ale_correction_t *correction,
                           const ale_moved_map_t *moved, ale_landmarks_t *spare);

/* How one map becomes part of another. */
typedef struct {
    uint8_t from;
    uint8_t into;
    ale_pose_t shift;                      /* of all that is in `from` */
    ale_map_uncertainty_t map_uncertainty; /* of `into` where they meet: what has moved there shares it */
} ale_local_map_join_t;

/* `spare` is working memory. O(map). */
void ale_local_map_join(ale_local_map_t *map, const ale_local_map_join_t *join, ale_landmarks_t *spare);

#endif
