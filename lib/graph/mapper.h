/* The mapper behind the real-time loop, as C sees it: keyframes in, corrections of the map out.
 *
 *   ale_mapper_t *mapper = ale_mapper_create(ALE_MAPPER_KEYFRAMES);
 *   ale_mapper_add(mapper, &keyframe);
 *   if (ale_mapper_correction(mapper, &correction)) ... hand it to ale_pipeline_correct ...
 *   ale_mapper_destroy(mapper);
 *
 * For an ordinary thread: allocates, and takes milliseconds. Not thread-safe. The same keyframes give the
 * same corrections on every machine: no clock, no vector instructions, trigonometry from lib/base. */
#ifndef ALE_GRAPH_MAPPER_H
#define ALE_GRAPH_MAPPER_H

#include <stdbool.h>
#include <stdint.h>

#include "track/correction.h"
#include "track/keyframe.h"

/* A correction that follows from the keyframe of scan k is due before scan k + this: half a second of the
 * URG-04LX, many times what the mapper takes. */
enum { ALE_CORRECTION_DELAY_SCANS = 5 };

/* How many keyframes a mapper is to hold: a kilometre of new ground. Each has its own shift in a correction.
 */
enum { ALE_MAPPER_KEYFRAMES = ALE_CORRECTION_SHIFTS };

/* What a mapper with so many takes, working memory included: 2048 scans of a URG-04LX, whole, are 45 MB, and
 * a known map less than 1 MB. */
enum { ALE_MAPPER_HEAP_BYTES = 60 * 1024 * 1024 };

typedef struct ale_mapper ale_mapper_t;

typedef struct {
    uint32_t keyframes;    /* held */
    uint32_t thinned;      /* gave their place to later ones */
    uint32_t candidates;   /* places looked at again */
    uint32_t known;        /* where the tracker was right */
    uint32_t unclear;      /* too little overlap, or another place fits nearly as well */
    uint32_t unconfirmed;  /* no other keyframe agreed */
    uint32_t contradicted; /* taken back: the graph disagreed */
    uint32_t loops;        /* believed */
    uint32_t refused;      /* keyframes lost because memory ran out */
} ale_mapper_statistics_t;

/* A keyframe as the graph now places it. */
typedef struct {
    uint32_t scan;
    ale_pose_t smooth; /* as it was handed in */
    ale_pose_t pose;   /* map frame, corrected by all loops so far */
} ale_mapper_pose_t;

/* All keyframes of a map that are held. */
typedef struct {
    uint32_t epoch; /* of the map; 0: none yet */
    uint32_t count;
    ale_mapper_pose_t pose[ALE_MAPPER_KEYFRAMES]; /* scans ascending */
} ale_mapper_poses_t;

/* Holds at most so many keyframes, 64..ALE_CORRECTION_SHIFTS (others are taken as the nearest of these). When
 * it is full a new keyframe takes the place of the most redundant one: that with most others near it. NULL:
 * out of memory. */
ale_mapper_t *ale_mapper_create(uint32_t keyframes);
void ale_mapper_destroy(ale_mapper_t *mapper);

/* Keyframes of this epoch, of which none was added yet, come from a drive that begins in this map: they are
 * laid on its walls, which stay where they are. 0, or -1: out of memory; it is as if nothing were known. */
int ale_mapper_know(ale_mapper_t *mapper, uint32_t epoch, const ale_map_t *map);

/* Takes a keyframe and looks for loops. A keyframe of a new epoch begins the graph anew; one of the same
 * epoch must be of a later scan. 0, or -1: out of memory; it is counted, and the graph begins anew with
 * the next keyframe. */
int ale_mapper_add(ale_mapper_t *mapper, const ale_keyframe_t *keyframe);

/* What a scan that is no keyframe saw, of the same map as the last one: lines of the sensor's frame, which
 * lies so on the robot. The directions of the walls in sixteen scans after each keyframe are a compass
 * for ale_mapper_refine, which goes without those that memory has no room for. */
void ale_mapper_see_walls(ale_mapper_t *mapper, const ale_pose_t *smooth, const ale_pose_t *sensor,
                          const ale_features_t *features);

/* Draws the whole graph tight, as far as the scans allow: a bounded piece of the work a call. Poses move with
 * the last one. False: nothing is left to do until a keyframe is added. For when the drive is over, or the
 * thread has nothing else to do. On a lack of memory the poses stay as they are. */
bool ale_mapper_refine(ale_mapper_t *mapper);

/* Fills *out with what has moved since the last one that was handed out. Each must be applied, in order. */
bool ale_mapper_correction(ale_mapper_t *mapper, ale_correction_t *out);

ale_mapper_statistics_t ale_mapper_statistics(const ale_mapper_t *mapper);

/* The keyframes of this epoch that are held, in order: k < statistics.keyframes. */
ale_mapper_pose_t ale_mapper_pose(const ale_mapper_t *mapper, uint32_t k);
void ale_mapper_poses(const ale_mapper_t *mapper, ale_mapper_poses_t *out);

#endif
