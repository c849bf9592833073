/* Map decay: walls whose free space is violated again and again are removed, sooner the less often they were
 * seen. A bounded number of near walls is asked each scan, in turn. */
#ifndef ALE_MAP_MAP_DECAY_H
#define ALE_MAP_MAP_DECAY_H

#include <stdbool.h>
#include <stdint.h>

#include "map/local_map.h"
#include "observe/posed_scan.h"

enum { ALE_DECAY_WALLS = 24 };

typedef struct {
    uint32_t next; /* position in the near list, where the next scan continues */
} ale_map_decay_t;

/* Of the walls asked that this scan was not associated with: how many it supports, and how many it violates.
 */
typedef struct {
    uint16_t supported;
    uint16_t violated;
} ale_visibility_counts_t;

/* Asks the next ALE_DECAY_WALLS near walls whose last_scan is not `scan`, by a scan whose sensor pose is in
 * the map frame. forget: count violations, remove a wall that has too many (one per call), and trim ends that
 * are seen through. Constant work. */
ale_visibility_counts_t ale_map_decay(ale_map_decay_t *decay, ale_local_map_t *map,
                                      const ale_posed_scan_t *from, uint32_t scan, bool forget);

#endif
