/* Corners of the map: where two walls were seen to meet, met again, and averaged.
 *
 * A corner follows from its two walls, which already hold the pose in the match; as a row of its own it
 * would count them twice. Corners are kept because they name places: for people, and to find a place again.
 * O(corners of the map), and ALE_CORNERS_PER_SCAN times those that lie around the scan's. */
#ifndef ALE_MAP_MAP_CORNER_H
#define ALE_MAP_MAP_CORNER_H

#include <stdbool.h>
#include <stdint.h>

#include "extract/extract.h"
#include "map/line_map.h"
#include "motion/motion.h"

enum {
    ALE_CORNERS_PER_SCAN = 16,
    ALE_CORNERS_AROUND = 128, /* of the map that are compared with a scan's */
    ALE_CORNER_CONFIRMED = 3
};

typedef struct {
    ale_map_corner_t corner[ALE_MAP_MAX_CORNERS];
    uint32_t born[ALE_MAP_MAX_CORNERS]; /* scan that saw it first, or ALE_BORN_BEFORE */
    uint16_t count;
    uint32_t refused;

    uint16_t around[ALE_CORNERS_AROUND]; /* working memory: those around the scan's corners */
    uint16_t around_count;
    uint16_t once; /* where to go on looking for one that was seen once */
} ale_map_corners_t;

void ale_map_corners_clear(ale_map_corners_t *corners);

/* Takes the first ALE_CORNERS_PER_SCAN corners of a scan, the sensor being at a pose of the map. grow =
 * false: no new ones. A full map gives up a corner that was seen once. Returns how many were known. */
uint16_t ale_map_corners_update(ale_map_corners_t *corners, const ale_features_t *features, ale_pose_t sensor,
                                uint32_t scan, bool grow);

#endif
