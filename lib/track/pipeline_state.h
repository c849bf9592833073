/* Working memory of the pipeline. For lib/track and its tests only. */
#ifndef ALE_TRACK_PIPELINE_STATE_H
#define ALE_TRACK_PIPELINE_STATE_H

#include "extract/workspace.h"
#include "map/local_map.h"
#include "map/map_decay.h"
#include "match/map_uncertainty.h"
#include "match/odometry_scale_error.h"
#include "match/scan_to_map.h"
#include "match/scan_to_scan.h"
#include "motion/lag.h"
#include "motion/motion.h"
#include "motion/odometry.h"
#include "motion/smooth_pose.h"
#include "motion/timestamp_filter.h"
#include "motion/wheel_factors.h"
#include "motion/wheels.h"
#include "observe/observation.h"
#include "observe/short_segment.h"
#include "relocate/relocation.h"
#include "track/carried.h"
#include "track/elders.h"
#include "track/overview.h"
#include "track/pipeline.h"
#include "track/slip.h"
#include "track/tracking_monitor.h"
#include "track/witness.h"
#include "track/zero_motion.h"

struct ale_pipeline {
    ale_pipeline_config_t config;
    ale_stage_hook_t hook;
    ale_extractor_t extractor;

    ale_wheel_factors_t factors;
    ale_wheels_t wheels;
    ale_lag_t lag;
    ale_wheel_scale_t scale;
    ale_process_noise_t process_noise[2]; /* without wheels, with wheels */

    ale_timestamp_filter_t timestamp_filter;
    ale_motion_t motion;
    ale_tracking_monitor_t monitor;
    ale_smooth_t smooth;
    uint32_t scans;
    ale_local_map_t map;
    ale_map_uncertainty_t map_uncertainty; /* of the map around the robot */
    ale_scale_error_t scale_error;
    int64_t drifted_um; /* since a scan last held the robot in every direction */
    bool determined;    /* by the last one */
    bool speed_known;   /* its speed is known: one has, and it has gone on evenly since */
    ale_map_decay_t map_decay;
    ale_relocation_t relocation;
    ale_witness_t witness;
    bool witnessed; /* by the scan at hand: it is the one that is kept */
    ale_carried_t carried;
    ale_elders_t elders;
    ale_zero_motion_t zero_motion;
    ale_scan_match_t scan_match;
    ale_overview_t overview; /* on the way that is smooth */

    /* the scan at hand */
    ale_scan_t scan;
    uint32_t bearing_bam[ALE_MAX_BEAMS];
    ale_segment_workspace_t segments;
    ale_features_t features;
    ale_observation_t observation[ALE_MAX_OBSERVATIONS];
    ale_fit_t fit;
    ale_fit_t other; /* of the same scan, from another pose */
    uint32_t observation_count;
    uint16_t matched_corners;
    int32_t velocity[ALE_AXES]; /* that it was straightened with */
    bool straightened;          /* bearing_bam holds */

    bool started;    /* the first scan has set the origin */
    bool looked;     /* the last answer had a scan */
    bool frozen;     /* pure localisation: the map stays as it is */
    uint32_t loaded; /* number of the map when it was begun by somebody else, else 0 */

    /* between the pipeline and the mapper: see pipeline_mapper.c */
    uint32_t epoch;
    uint32_t corrections;
    uint32_t keyframes;
    uint32_t keyframe_scan;
    ale_pose_t keyframe_smooth;
    bool broken; /* since the last keyframe: see ale_keyframe_t */
    bool moved;  /* the map pose was put elsewhere: how it settles there is no way of the robot */
    ale_landmarks_t spare_landmarks;
    ale_ways_t ways; /* to the scan at hand */
    bool slips;      /* the last time that wheels could have slipped they did */
    uint16_t claims; /* scans that may still show that the robot is where it is said to be */
};

#endif
