/* What the pipeline remembers from scan to scan. For lib/track and its tests only.
 *
 * Each part is written by one step of a scan, in the order in which a scan goes through them; what a step
 * finds it hands to the next one by value. Workspaces hold nothing from scan to scan. */
#ifndef ALE_TRACK_PIPELINE_STATE_H
#define ALE_TRACK_PIPELINE_STATE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/stage.h"
#include "extract/workspace.h"
#include "map/atlas.h"
#include "map/local_map.h"
#include "map/map_decay.h"
#include "match/map_uncertainty.h"
#include "match/odometry_scale_error.h"
#include "match/pose_vote.h"
#include "match/scan_to_map.h"
#include "match/scan_to_scan.h"
#include "motion/lag.h"
#include "motion/motion.h"
#include "motion/odometry.h"
#include "motion/smooth_pose.h"
#include "motion/timestamp_filter.h"
#include "motion/wheel_factors.h"
#include "motion/wheel_monitor.h"
#include "motion/wheels.h"
#include "observe/observation.h"
#include "observe/short_segment.h"
#include "relocate/relocation.h"
#include "track/correction.h"
#include "track/evidence/carried.h"
#include "track/evidence/elders.h"
#include "track/evidence/slip.h"
#include "track/evidence/way_back.h"
#include "track/evidence/witness.h"
#include "track/evidence/zero_motion.h"
#include "track/pipeline_config.h"
#include "track/tracking_monitor.h"

/* What the scan at hand shows. */
typedef struct {
    ale_scan_t scan;            /* straightened; the robot's own body and what goes along with it blanked */
    int32_t velocity[ALE_AXES]; /* that it was straightened with */
    bool straightened;          /* bearing_bam holds */
    uint32_t bearing_bam[ALE_MAX_BEAMS];
    ale_features_t features;
    ale_observation_t observation[ALE_MAX_OBSERVATIONS];
    uint32_t count;
} ale_observed_t;

/* Bearings of the scan, NULL when they are regular. */
static inline const uint32_t *ale_observed_bearings(const ale_observed_t *observed)
{
    return observed->straightened ? observed->bearing_bam : NULL;
}

/* What of it stands still, as far as is known: that goes into the map and to the mapper. */
typedef struct {
    ale_scan_t scan;
    ale_observation_t observation[ALE_MAX_OBSERVATIONS];
    uint32_t count;
} ale_static_scene_t;

/* Another pose of a scan, that explains it better than the one that is followed: believed when the next scan
 * confirms it. */
typedef struct {
    ale_pose_t pose;      /* where the prediction has led it since, */
    ale_pose_t found;     /* and where it was found: the prediction may be wrong on and on */
    int64_t advantage_um; /* of surface that it explains more, in scans that confirm each other; 0: none */
} ale_proposal_t;

struct ale_pipeline {
    ale_pipeline_config_t config;
    ale_stage_hook_t hook;

    /* ale_pipeline_odometry */
    ale_wheel_factors_t factors;
    ale_odometry_t pending; /* last; the wheels take it when it is known whether a scan was told with it */
    ale_wheels_t wheels;

    /* predict */
    ale_timestamp_filter_t timestamp_filter;

    /* observe */
    ale_extractor_t extractor;
    ale_segment_workspace_t segments;
    ale_observed_t observed;

    /* associate, solve: workspaces */
    ale_scan_match_t scan_match;
    ale_fit_t other; /* of the same scan, from another pose */
    ale_pose_vote_t vote;
    bool searched;  /* the scan at hand, elsewhere than it was tracked: once a scan */
    ale_fit_t best; /* of the places of the vote */
    ale_proposal_t proposal;
    ale_proposal_t proposed; /* by the scan before, where the prediction has led it */

    /* monitor */
    ale_tracking_monitor_t monitor;
    uint8_t waits; /* scans in a row, to this one, that wait for the next one to tell where they were taken */
    uint8_t waited;            /* to the one before */
    int64_t back_us;           /* the stamp of the first of those: the time unwatched ended there */
    bool denied_to_stand;      /* by one of those, or this one */
    bool driven;               /* wheels have told of a way through the time unwatched before this scan */
    uint32_t unconfirmed_from; /* the scan from which on nothing but the prediction tells where the robot is;
                                  0 where walls of before have confirmed it */

    /* filter: what moves, and what is kept to tell */
    ale_static_scene_t still;
    ale_carried_t carried;
    ale_elders_t elders;
    ale_way_back_t way_back; /* through the robot's map, unless that is the first */
    ale_zero_motion_t zero_motion;
    ale_witness_t witness;

    /* search */
    ale_relocation_t relocation;
    ale_claim_t next_claim; /* what the next map begins with */
    ale_claim_t claim;      /* what the robot's map has begun with, */
    uint16_t claims;        /* and so many scans show it first of all */
    int64_t surplus_um;     /* of its walls, by which it lies enough on the place recognised */
    int64_t unlooked_um;    /* gone and turned since the robot last looked around */

    /* update */
    ale_local_map_t map;
    ale_atlas_t atlas;         /* whose walls those are */
    uint32_t begun;            /* the scan that began the robot's map, */
    ale_moved_map_t moved_map; /* and the last map that moved to join another one */
    ale_map_decay_t decay;
    ale_map_uncertainty_t map_uncertainty; /* around the robot */
    ale_scale_error_t scale_error;
    int64_t drifted_um; /* since a scan last determined every direction */
    ale_lag_t lag;
    ale_wheel_errors_t wheel_errors;
    ale_wheel_monitor_t wheel_monitor;
    ale_process_noise_t process_noise[2]; /* without wheels, with wheels */

    /* conclude: what a scan came to */
    ale_motion_t motion;
    ale_motion_t watched; /* where and when a scan has last told where the robot is */
    ale_pose_t step;      /* from the scan before the last one to the last one */
    ale_smooth_t smooth;
    ale_fit_t fit; /* of the last scan that was fitted */
    uint16_t matched_corners;
    bool determined;  /* every direction, by the last scan */
    bool speed_known; /* a scan determined it, and the robot has gone on evenly since */
    bool slips;       /* the last time that wheels could have slipped they did */
    bool kept;        /* the last scan that was tracked is the one that the next is compared with */
    bool looked;      /* the last answer had a scan */
    bool is_pending;  /* odometry that the wheels have not taken yet */
    bool started;     /* the first scan has set the origin */
    uint32_t scans;

    /* commands, and what passes to the mapper: pipeline_mapper.c */
    bool frozen;     /* pure localisation: the map stays as it is */
    bool partial;    /* not all of the map is in work: nowhere is the only place that looks like this */
    bool tile_waits; /* a piece of one, that the last scan has left no time for */
    uint32_t loaded; /* number of the map when it was begun by somebody else, else 0 */
    uint32_t epoch;
    uint32_t corrections;
    uint32_t keyframes;
    uint32_t keyframe_scan;
    ale_pose_t keyframe_smooth;
    bool broken; /* since the last keyframe: see ale_keyframe_t */
    bool joined; /* since the last keyframe, two maps have */
    bool moved;  /* the map pose was put elsewhere: how it settles there is no displacement of the robot */
    ale_landmarks_t spare_landmarks;
};

typedef struct ale_pipeline ale_pipeline_t;

#endif
