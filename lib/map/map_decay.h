/* Fading: walls that scans look through leave the map, sooner the less often they were seen.
 * A bounded number of near walls is asked each scan, in turn. */
#ifndef ALE_MAP_MAP_DECAY_H
#define ALE_MAP_MAP_DECAY_H

#include <stdbool.h>
#include <stdint.h>

#include "map/local_map.h"
#include "observe/posed_scan.h"

enum { ALE_DECAY_WALLS = 24 };

typedef struct {
    uint32_t next; /* place in the near list to go on at */
} ale_map_decay_t;

/* How many of the walls asked that were not matched in this scan are there, and are seen through. */
typedef struct {
    uint16_t supported;
    uint16_t violated;
} ale_visibility_counts_t;

/* Asks the next near walls whose last_scan is not `scan`. forget: count misses, remove what has faded, and
 * shorten walls whose ends are seen through. */
ale_visibility_counts_t ale_map_decay(ale_map_decay_t *decay, ale_local_map_t *map,
                                      const ale_posed_scan_t *from, uint32_t scan, bool forget);

#endif
