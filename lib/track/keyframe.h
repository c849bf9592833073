/* A keyframe: a scan worth remembering, handed from the estimate task to the mapper, whole and by value.
 *
 * One is taken when the robot has gone on by half a metre or turned by half a radian, and where maps begin
 * and join. */
#ifndef ALE_TRACK_KEYFRAME_H
#define ALE_TRACK_KEYFRAME_H

#include <stdbool.h>
#include <stdint.h>

#include "base/pose.h"
#include "base/scan.h"
#include "extract/extract.h"
#include "map/atlas.h"
#include "track/pipeline.h"

enum { ALE_KEYFRAME_STEP_UM = 500000, ALE_KEYFRAME_TURN_MRAD = 500 };

struct ale_keyframe {
    uint32_t epoch;       /* grows when the map is begun anew: what was mapped before is then void */
    uint32_t loaded;      /* the number of that map, see ale_pipeline_load_map; 0: begun by this drive */
    uint32_t corrections; /* taken in by the map since then */
    uint32_t scan;
    int64_t stamp_us;
    ale_pose_t smooth; /* relative motion is measured by this: no correction is in it */
    ale_pose_t map;
    uint32_t map_id;     /* of the map that this pose is in; 0: the first, or the loaded one */
    ale_map_join_t join; /* the last join of two maps; all that was in the one moved before this keyframe */
    bool broken; /* put elsewhere, or in another map, since the keyframe before: smooth does not tie them */
    uint32_t tied_from; /* then: the first scan that smooth ties to this one */
    ale_claim_t claim;  /* what that map has begun with */
    bool weak;          /* part of the pose rests on the prediction alone */
    ale_pose_t sensor;
    ale_scan_t taken;
    bool straightened; /* bearing_bam holds, else the scan's own bearings */
    uint32_t bearing_bam[ALE_MAX_BEAMS];
    ale_features_t features;
};

#endif
