/* Corners of the map: where two walls were seen to meet, met again, and averaged.
 *
 * A corner follows from its two walls, which already hold the pose in the match; as a row of its own it
 * would count them twice. Corners are kept because they name places: for people, and to find a place again.
 * O(ALE_CORNERS_PER_SCAN * corners of the map). */
#ifndef ALE_TRACK_MAP_CORNER_H
#define ALE_TRACK_MAP_CORNER_H

#include <stdbool.h>
#include <stdint.h>

#include "extract/extract.h"
#include "track/motion.h"
#include "track/pipeline.h"

enum { ALE_CORNERS_PER_SCAN = 16, ALE_CORNER_CONFIRMED = 3 };

typedef struct {
    ale_map_corner_t corner[ALE_MAP_MAX_CORNERS];
    uint32_t born[ALE_MAP_MAX_CORNERS]; /* scan that saw it first */
    uint16_t count;
    uint32_t refused;
} ale_map_corners_t;

void ale_map_corners_clear(ale_map_corners_t *corners);

/* Takes the first ALE_CORNERS_PER_SCAN corners of a scan, the sensor being at a pose of the map. grow =
 * false: no new ones. A full map gives up a corner that was seen once. Returns how many were known. */
uint16_t ale_map_corners_update(ale_map_corners_t *corners, const ale_features_t *features, ale_pose_t sensor,
                                uint32_t scan, bool grow);

#endif
