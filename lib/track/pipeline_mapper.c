/* What passes between the pipeline, the mapper and the loader of tiles, and what puts the robot elsewhere in
 * the map. */
#include <stddef.h>
#include <string.h>

#include "base/fixed.h"
#include "base/trig.h"
#include "map/tile_change.h"
#include "track/correction.h"
#include "track/keyframe.h"
#include "track/maps.h"
#include "track/pipeline.h"
#include "track/pipeline_state.h"
#include "track/scan_observation.h"
#include "track/step_update.h"

enum {
    LOOP_SIGMA_UM = 30000, /* how well a corrected pose lies to the walls that it comes back to */
    LOOP_SIGMA_URAD = 10000
};

static bool has_gone_on(const ale_pipeline_t *p)
{
    const ale_pose_t way = ale_pose_between(p->keyframe_smooth, p->smooth.pose);
    const int64_t x = way.x_um;
    const int64_t y = way.y_um;
    return x * x + y * y > (int64_t)ALE_KEYFRAME_STEP_UM * ALE_KEYFRAME_STEP_UM ||
           ale_abs64((int32_t)way.theta_bam) > (int64_t)ALE_KEYFRAME_TURN_MRAD * ALE_BAM_PER_MRAD;
}

/* Of a log that holds but some of the scans wheels may have told a part of the way alone. */
static ale_claim_t claim_told(const ale_pipeline_t *p)
{
    const bool part = p->claim == ALE_CLAIM_DRIVEN && !ale_timestamp_filter_is_dense(&p->timestamp_filter);
    return part ? ALE_CLAIM_NEAR : p->claim;
}

bool ale_pipeline_keyframe(ale_pipeline_t *p, ale_keyframe_t *out)
{
    const bool waits = p->waits > 0; /* for the next scan to tell where this one was taken */
    if (!p->started || !p->looked || waits || p->monitor.state == ALE_STATE_LOST) {
        return false;
    }
    if (p->keyframes > 0 && !p->broken && !p->joined && !has_gone_on(p)) {
        return false;
    }
    out->epoch = p->epoch;
    out->loaded = p->loaded;
    out->corrections = p->corrections;
    out->scan = p->scans - 1;
    out->stamp_us = p->still.scan.stamp_us;
    out->smooth = p->smooth.pose;
    out->map = p->motion.pose;
    out->map_id = ale_atlas_map_id(&p->atlas);
    out->join = p->atlas.join;
    out->broken = p->broken;
    out->tied_from = out->scan - p->waited;
    out->claim = claim_told(p);
    out->weak = p->monitor.state != ALE_STATE_GOOD;
    out->sensor = p->config.sensor;
    out->taken = p->still.scan;
    out->straightened = p->observed.straightened;
    memcpy(out->bearing_bam, p->observed.bearing_bam, sizeof out->bearing_bam);
    out->features = p->observed.features;
    p->keyframe_smooth = p->smooth.pose;
    p->keyframe_scan = out->scan;
    p->keyframes++;
    p->broken = false;
    p->joined = false;
    return true;
}

static void copy_lines(const ale_seen_t *seen, ale_scan_observation_t *out)
{
    out->line_count = 0;
    for (uint32_t i = 0; i < seen->observation_count; i++) {
        if (seen->observation[i].kind == ALE_OBSERVATION_LINE) {
            out->line[out->line_count++] = seen->observation[i];
        }
    }
}

bool ale_pipeline_scan_observation(const ale_pipeline_t *p, ale_scan_observation_t *out)
{
    ale_seen_t seen;
    const bool tied = p->keyframes > 0 && !p->broken;
    if (!tied || p->frozen || !ale_pipeline_seen(p, &seen)) {
        return false;
    }
    out->epoch = p->epoch;
    out->loaded = p->loaded;
    out->scan = p->scans - 1;
    out->keyframe = p->keyframe_scan;
    out->stamp_us = p->still.scan.stamp_us;
    out->smooth = p->smooth.pose;
    copy_lines(&seen, out);
    out->corner_count = (uint32_t)ale_min64(p->observed.features.corner_count, ALE_CORNERS_PER_SCAN);
    memcpy(out->corner, p->observed.features.corner, out->corner_count * sizeof out->corner[0]);
    ale_seen_copy(&out->seen, &seen);
    return true;
}

static void correct_robot(ale_pipeline_t *p, ale_pose_t shift)
{
    const ale_pose_t before = p->motion.pose;
    p->motion.pose = ale_pose_compose(shift, before);
    p->watched.pose = ale_pose_compose(shift, p->watched.pose);
    ale_smooth_hold(&p->smooth, p->motion.pose);
    ale_lag_turn(&p->lag, shift.theta_bam);
    const ale_point_t was = {before.x_um, before.y_um};
    const ale_point_t is = {p->motion.pose.x_um, p->motion.pose.y_um};
    if (ale_correction_is_news(was, is, shift)) {
        ale_motion_widen(&p->motion, LOOP_SIGMA_UM, LOOP_SIGMA_URAD);
        p->moved = true;
    }
}

bool ale_pipeline_correct(ale_pipeline_t *p, const ale_correction_t *correction)
{
    const bool ours =
        correction->epoch == p->epoch && correction->count > 0 && correction->count <= ALE_CORRECTION_SHIFTS;
    if (!ours || correction->due > p->scans) {
        return !ours;
    }
    p->corrections++;
    if (correction->joins && ale_atlas_find(&p->atlas, correction->joined_map_id) == ALE_NO_MAP) {
        return true; /* it has joined another one by itself */
    }
    const ale_shift_t *last = &correction->shift[correction->count - 1];
    ale_local_map_correct(&p->map, correction, &p->moved_map, &p->spare_landmarks);
    correct_robot(p, ale_correction_in(correction, last->scan, &p->moved_map));
    if (correction->joins) {
        ale_maps_joined(p, correction->joined_map_id, correction->into_map_id);
    }
    return true;
}

bool ale_pipeline_whereabouts(const ale_pipeline_t *p, ale_whereabouts_t *out)
{
    if (p->loaded != ALE_LOADED_TILES || p->scans == 0 || (p->scans - 1) % ALE_WHEREABOUTS_SCANS != 0) {
        return false;
    }
    out->epoch = p->epoch;
    out->scan = p->scans - 1;
    out->pose = p->motion.pose;
    out->reach_um = (int64_t)p->observed.scan.range_max_um + ALE_TILE_MARGIN_UM;
    return true;
}

bool ale_pipeline_change_tiles(ale_pipeline_t *p, const ale_tile_change_t *change)
{
    const bool ours = change->epoch == p->epoch && p->loaded == ALE_LOADED_TILES;
    if (!ours || change->due > p->scans) {
        return !ours;
    }
    p->tile_waits = p->searched;
    if (p->tile_waits) {
        return false;
    }
    ale_tile_change_apply(&p->map, change);
    if (change->last) {
        p->partial = !change->whole;
    }
    return true;
}

void ale_pipeline_relocate(ale_pipeline_t *p, ale_pose_t pose)
{
    p->motion.pose = pose;
    p->watched = p->motion;
    ale_smooth_hold(&p->smooth, pose);
    ale_maps_lose(p, ALE_CLAIM_SAID);
    ale_update_restart(p);
    p->moved = true;
}

void ale_pipeline_freeze_map(ale_pipeline_t *p, bool frozen)
{
    p->frozen = frozen;
}
