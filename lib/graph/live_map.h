/* The map while driving, rebuilt from the observations of all recorded scans. C interface.
 *
 *   ale_live_map_t *live = ale_live_map_create();
 *   ale_live_map_add(live, &observation);              (as they come)
 *   if (ale_live_map_build(live, &poses, map)) ...     (now and then)
 *   ale_live_map_destroy(live);
 *
 * For an ordinary thread of its own: a large map takes a second. Not thread-safe; no function throws. Memory
 * is bounded: scans of keyframes that the mapper has removed are removed, and a full record removes the
 * oldest scan of the keyframe that takes most. */
#ifndef ALE_GRAPH_LIVE_MAP_H
#define ALE_GRAPH_LIVE_MAP_H

#include <stdbool.h>
#include <stdint.h>

#include "graph/mapper.h"
#include "track/scan_observation.h"

/* Bound of the record, with what its lines take while the map is rebuilt. */
enum { ALE_LIVE_MAP_BYTES = 32 * 1024 * 1024 };

/* The same with all that a rebuild needs. */
enum { ALE_LIVE_MAP_HEAP_BYTES = 52 * 1024 * 1024 };

typedef struct ale_live_map ale_live_map_t;

/* The caller destroys it. NULL: out of memory. */
ale_live_map_t *ale_live_map_create(void);
void ale_live_map_destroy(ale_live_map_t *live); /* NULL is allowed */

/* The drive of this epoch begins in this map: its walls count as observed before. Before the first scan of
 * the epoch; removes all others. The map is copied. 0, or -1: out of memory; the record is then empty.
 * O(lines). */
int ale_live_map_set_prior_map(ale_live_map_t *live, uint32_t epoch, const ale_map_t *map);

/* Adds a scan later than the last one; one of a new epoch removes all others. 0, or -1: out of memory; it is
 * left out. O(recorded scans). */
int ale_live_map_add(ale_live_map_t *live, const ale_scan_observation_t *observation);

/* Rebuilds the map that the robot is in, with the keyframes where the mapper now places them, and fills *out;
 * what was seen in other maps waits until they join. A line that was in
 * the last map keeps its id. False: no lines, the mapper is at another epoch, or out of memory; *out may then
 * hold anything. Work: see rebuild_map. */
bool ale_live_map_build(ale_live_map_t *live, const ale_mapper_poses_t *poses, ale_map_t *out);

/* The epoch of the record; 0: empty. */
uint32_t ale_live_map_epoch(const ale_live_map_t *live);

/* Bytes recorded now, ALE_LIVE_MAP_BYTES at most. O(recorded scans). */
uint32_t ale_live_map_bytes(const ale_live_map_t *live);

#endif
