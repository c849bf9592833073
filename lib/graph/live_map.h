/* The map of a robot under way, drawn anew from what its scans have shown; as C sees it.
 *
 *   ale_live_map_t *live = ale_live_map_create();
 *   ale_live_map_take(live, &sighting);               (as they come)
 *   if (ale_live_map_draw(live, &poses, map)) ...     (now and then)
 *   ale_live_map_destroy(live);
 *
 * For an ordinary thread of its own: a drawing of a large map takes a second. Not thread-safe. Memory is
 * bounded: what the mapper has thinned out is forgotten, and a full record gives up the oldest scan of the
 * keyframe of which it holds most. */
#ifndef ALE_GRAPH_LIVE_MAP_H
#define ALE_GRAPH_LIVE_MAP_H

#include <stdbool.h>
#include <stdint.h>

#include "graph/mapper.h"
#include "track/scan_observation.h"

/* What is recorded at most, with what a drawing makes of its lines. */
enum { ALE_LIVE_MAP_BYTES = 32 * 1024 * 1024 };

/* The same with all that a drawing needs. */
enum { ALE_LIVE_MAP_HEAP_BYTES = 52 * 1024 * 1024 };

typedef struct ale_live_map ale_live_map_t;

/* NULL: out of memory. */
ale_live_map_t *ale_live_map_create(void);
void ale_live_map_destroy(ale_live_map_t *live);

/* Sightings of this epoch, of which none was taken yet, are of a drive that begins in this map: what it holds
 * counts as seen before. Forgets what was there. 0, or -1: out of memory; it is as if nothing were known. */
int ale_live_map_know(ale_live_map_t *live, uint32_t epoch, const ale_map_t *map);

/* Of a later scan than the last one; one of a map begun anew forgets what was there. 0, or -1: out of memory,
 * and it is left out. */
int ale_live_map_take(ale_live_map_t *live, const ale_scan_observation_t *sighting);

/* Draws the map as the mapper now places the keyframes, and fills *out; a line that was in the last drawing
 * keeps its id. False: there is nothing to draw, or memory ran out; *out may hold anything. */
bool ale_live_map_draw(ale_live_map_t *live, const ale_mapper_poses_t *poses, ale_map_t *out);

/* The epoch of what it draws; 0: nothing yet. */
uint32_t ale_live_map_epoch(const ale_live_map_t *live);

/* What is recorded now: ALE_LIVE_MAP_BYTES at most. O(sightings). */
uint32_t ale_live_map_bytes(const ale_live_map_t *live);

#endif
