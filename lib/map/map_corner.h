/* Corners of the map: where two walls meet, associated from scan to scan and averaged.
 *
 * A corner follows from its two walls, which already determine the pose; as a row of the registration it
 * would count them twice. Corners are kept because they name places, for people and for loop closing.
 * O(corners of the map), and ALE_CORNERS_PER_SCAN times those around the scan's corners. */
#ifndef ALE_MAP_MAP_CORNER_H
#define ALE_MAP_MAP_CORNER_H

#include <stdbool.h>
#include <stdint.h>

#include "extract/extract.h"
#include "map/line_map.h"
#include "map/tile_grid.h"
#include "motion/motion.h"

enum {
    ALE_CORNERS_PER_SCAN = 16,
    ALE_CORNERS_AROUND = 128, /* of the map, that are compared with those of a scan */
    ALE_CORNER_CONFIRMED = 3
};

typedef struct {
    ale_map_corner_t corner[ALE_MAP_MAX_CORNERS];
    uint32_t born[ALE_MAP_MAX_CORNERS]; /* scan that saw it first, or ALE_BORN_BEFORE */
    uint8_t map[ALE_MAP_MAX_CORNERS];   /* that it belongs to: see atlas.h */
    uint8_t selected;                   /* the map whose corners are found */
    uint16_t count;
    uint32_t refused;

    uint16_t around[ALE_CORNERS_AROUND]; /* working memory: those around the scan's corners */
    uint16_t around_count;
    uint16_t once; /* where the search for a corner that was seen once continues */
} ale_map_corners_t;

void ale_map_corners_clear(ale_map_corners_t *corners);

/* Removes those of a map. O(corners). */
void ale_map_corners_give_up(ale_map_corners_t *corners, uint8_t map);

/* Of a map, removes those outside a box. O(corners). */
void ale_map_corners_keep_within(ale_map_corners_t *corners, uint8_t map, const ale_box_t *box);

/* Updates by the first ALE_CORNERS_PER_SCAN corners of a scan; sensor: its pose in the map. grow false: no
 * new corners. A full map replaces corners that were seen once, else the new one is refused. Returns how many
 * were known. */
uint16_t ale_map_corners_update(ale_map_corners_t *corners, const ale_features_t *features, ale_pose_t sensor,
                                uint32_t scan, bool grow);

#endif
