/* What one scan has shown, by value: handed from the estimate task to the part of the mapper that draws the
 * map anew.
 *
 * It says where its scan was taken by the smooth pose, relative to the keyframe that it belongs to: when that
 * is corrected, it moves with it. */
#ifndef ALE_TRACK_SCAN_OBSERVATION_H
#define ALE_TRACK_SCAN_OBSERVATION_H

#include <stdint.h>

#include "base/pose.h"
#include "extract/extract.h"
#include "map/map_corner.h"
#include "observe/observation.h"
#include "observe/seen.h"
#include "track/pipeline.h"

struct ale_scan_observation {
    uint32_t epoch;  /* of the map */
    uint32_t loaded; /* the number of that map, see ale_pipeline_load_map; 0: begun by this drive */
    uint32_t scan;
    uint32_t keyframe; /* the scan of the last one at or before this scan */
    int64_t stamp_us;
    ale_pose_t smooth;
    uint32_t line_count;
    ale_observation_t line[ALE_MAX_OBSERVATIONS]; /* robot's frame */
    uint32_t corner_count;
    ale_corner_t corner[ALE_CORNERS_PER_SCAN]; /* sensor's frame */
    ale_seen_copy_t seen;                      /* at its map pose */
};

#endif
