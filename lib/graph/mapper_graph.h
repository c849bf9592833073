/* The pose graph of the mapper as it is told to others: keyframes, and the loops between them, in bounded
 * memory. Integers only; plain C. */
#ifndef ALE_GRAPH_MAPPER_GRAPH_H
#define ALE_GRAPH_MAPPER_GRAPH_H

#include <stdbool.h>
#include <stdint.h>

#include "base/pose.h"

/* A quarter of the keyframes that a mapper may hold: enough to draw a kilometre, a keyframe every two metres.
 * Both together fit one message of 16 KiB. */
enum { ALE_GRAPH_KEYFRAMES = 512, ALE_GRAPH_LOOPS = 512 };

typedef enum {
    ALE_LOOP_RECOGNISED, /* the tracker lay on what was seen there before: nothing moved */
    ALE_LOOP_CLOSED,     /* scans matched apart from where they were tracked: the graph was solved with it */
    ALE_LOOP_JOINS       /* ties two maps that nothing tied before */
} ale_loop_kind_t;

typedef struct {
    uint32_t scan;
    uint32_t map_id; /* of the map that its pose is in, after all joins so far */
    ale_pose_t pose; /* of the robot, frame of that map, corrected by all loops so far */
    bool tied;       /* to the keyframe before it in this list, by how the robot moved; false: a map begins */
} ale_graph_keyframe_t;

typedef struct {
    uint16_t from; /* index of a keyframe; */
    uint16_t to;   /* of a later one */
    uint8_t kind;  /* ale_loop_kind_t */
} ale_graph_loop_t;

typedef struct {
    uint32_t epoch;              /* of the map, as in ale_mapper_poses_t; 0: none yet */
    uint32_t keyframes;          /* in the list, scans ascending */
    uint32_t keyframes_left_out; /* held by the mapper, not in the list: neighbours of others that are */
    uint32_t loops;
    uint32_t loops_left_out;
    ale_graph_keyframe_t keyframe[ALE_GRAPH_KEYFRAMES];
    ale_graph_loop_t loop[ALE_GRAPH_LOOPS];
} ale_mapper_graph_t;

#endif
