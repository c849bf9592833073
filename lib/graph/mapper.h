/* The mapper behind the real-time loop: keyframes in, corrections of the map out. C interface.
 *
 *   ale_mapper_t *mapper = ale_mapper_create(ALE_MAPPER_KEYFRAMES);
 *   ale_mapper_add(mapper, &keyframe);
 *   if (ale_mapper_correction(mapper, &correction)) ... hand it to ale_pipeline_correct ...
 *   ale_mapper_destroy(mapper);
 *
 * For an ordinary thread: it allocates and takes milliseconds. Not thread-safe. The same keyframes give the
 * same corrections on every machine: no clock, no vector instructions, trigonometry from lib/base. No
 * function throws. */
#ifndef ALE_GRAPH_MAPPER_H
#define ALE_GRAPH_MAPPER_H

#include <stdbool.h>
#include <stdint.h>

#include "graph/mapper_graph.h"
#include "map/tile_change.h"
#include "track/correction.h"
#include "track/keyframe.h"

/* A correction that follows from the keyframe of scan k is due before scan k + this: half a second of the
 * URG-04LX, many times what the mapper takes. */
enum { ALE_CORRECTION_DELAY_SCANS = 5 };

/* Capacity for a kilometre of new ground. Each keyframe has its own shift in a correction. */
enum { ALE_MAPPER_KEYFRAMES = ALE_CORRECTION_SHIFTS };

/* Heap of a mapper of this capacity, working memory included: 2048 full scans of a URG-04LX are 45 MB, a
 * prior map with its views is less than 2 MB. */
enum { ALE_MAPPER_HEAP_BYTES = 60 * 1024 * 1024 };

typedef struct ale_mapper ale_mapper_t;

typedef struct {
    uint32_t keyframes;    /* held */
    uint32_t thinned;      /* removed for later ones */
    uint32_t candidates;   /* places matched for a loop */
    uint32_t recognised;   /* of these, where the tracker was right */
    uint32_t unclear;      /* too little overlap, or another place fits nearly as well */
    uint32_t unconfirmed;  /* too few other keyframes agreed */
    uint32_t contradicted; /* rejected: the graph disagreed */
    uint32_t loops;        /* accepted */
    uint32_t refused;      /* keyframes lost because memory ran out */
    uint32_t maps;         /* among the keyframes held that have not joined another */
    uint32_t joins;        /* of maps, by the tracker or here */
} ale_mapper_statistics_t;

/* A keyframe as the graph now places it. */
typedef struct {
    uint32_t scan;
    ale_pose_t smooth; /* of the keyframe, odometry frame */
    ale_pose_t pose;   /* map frame, corrected by all loops so far */
    uint32_t map_id;   /* of that map, after all joins so far; nothing ties the frames of two maps */
} ale_mapper_pose_t;

/* All keyframes of a map that are held. */
typedef struct {
    uint32_t epoch; /* of the map; 0: none yet */
    uint32_t count;
    ale_mapper_pose_t pose[ALE_MAPPER_KEYFRAMES]; /* scans ascending */
} ale_mapper_poses_t;

/* Holds at most this many keyframes, clamped to 64..ALE_CORRECTION_SHIFTS. When it is full a new keyframe
 * replaces the most redundant one: that with most others near it. The caller destroys it. NULL: out of
 * memory. */
ale_mapper_t *ale_mapper_create(uint32_t keyframes);
void ale_mapper_destroy(ale_mapper_t *mapper); /* NULL is allowed */

/* The drive of this epoch begins in this map: keyframes are matched with its walls, which stay where they
 * are. Before the first keyframe of the epoch; removes all others. The map is copied. 0, or -1: out of
 * memory; then the mapper works without a prior map. O(lines). */
int ale_mapper_set_prior_map(ale_mapper_t *mapper, uint32_t epoch, const ale_map_t *map);

/* The same for a drive through a map of tiles: a piece of what comes and goes. It counts for keyframes from
 * the scan on that it is due at. Pieces of an epoch in order; copied. 0, or -1: out of memory; the piece is
 * left out. O(1) here, and O(walls of the piece * walls) when its scan has come. */
int ale_mapper_change_tiles(ale_mapper_t *mapper, const ale_tile_change_t *change);

/* Adds a keyframe and searches for loops. One of a new epoch starts a new graph; one of the same epoch must
 * be of a later scan. 0, or -1: out of memory; it is counted in `refused`, and the graph starts anew with the
 * next keyframe. Work: three loop searches and 40 iterations of the graph at most;
 * while there are several maps, two places of another one searched besides (MapJoiner::drive). */
int ale_mapper_add(ale_mapper_t *mapper, const ale_keyframe_t *keyframe);

/* Adds the lines of a scan after the last keyframe, sensor's frame; `sensor` is the sensor's pose on the
 * robot. ale_mapper_refine uses them for the building-direction constraint. Scans beyond sixteen after a
 * keyframe, and those for which memory runs out, are ignored. O(lines). */
void ale_mapper_add_walls(ale_mapper_t *mapper, const ale_pose_t *smooth, const ale_pose_t *sensor,
                          const ale_features_t *features);

/* Refines the whole graph after the drive, as accurately as scans allow: a bounded piece of the work a call.
 * Poses move with the last one. False: nothing is left to do until a keyframe is added, or out of memory; the
 * poses are then as before. */
bool ale_mapper_refine(ale_mapper_t *mapper);

/* Fills *out with the moves of the keyframes since the last correction; each correction must be applied, in
 * order. One that joins two maps moves nothing else; until a keyframe tells that it is applied, no other
 * follows. False: no keyframe has moved by more than 5 mm or 1 mrad, or out of memory; *out may
 * then hold anything. O(keyframes). */
bool ale_mapper_correction(ale_mapper_t *mapper, ale_correction_t *out);

/* Counts since the epoch began; `refused` since the mapper was created.
 * O(keyframes * changes of the map). */
ale_mapper_statistics_t ale_mapper_statistics(const ale_mapper_t *mapper);

/* Keyframe k of those held, in order of their scans; k < statistics.keyframes. O(1). */
ale_mapper_pose_t ale_mapper_pose(const ale_mapper_t *mapper, uint32_t k);
/* Fills *out with all of them. O(keyframes). */
void ale_mapper_poses(const ale_mapper_t *mapper, ale_mapper_poses_t *out);

/* Fills *out with the graph as others are told it: where not all of it fits, a part that says so. False: out
 * of memory; *out may then hold anything. O(keyframes + loops log loops). */
bool ale_mapper_graph(const ale_mapper_t *mapper, ale_mapper_graph_t *out);

#endif
