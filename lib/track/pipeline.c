#include "track/pipeline.h"

#include <stddef.h>
#include <string.h>

#include "base/fixed.h"
#include "map/map_exchange.h"
#include "match/uncertainty.h"
#include "track/maps.h"
#include "track/pipeline_state.h"
#include "track/step_filter.h"
#include "track/step_observe.h"
#include "track/step_predict.h"
#include "track/step_search.h"
#include "track/step_track.h"

enum { START_SPEED_MM_S = 300, START_TURN_MRAD_S = 500 };

uint32_t ale_pipeline_size(void)
{
    return (uint32_t)sizeof(ale_pipeline_t);
}

int ale_pipeline_init(ale_pipeline_t *pipeline, const ale_pipeline_config_t *config)
{
    if (!ale_pipeline_config_is_valid(config) ||
        ale_extractor_init(&pipeline->extractor, &config->extract) < 0) {
        return -1;
    }
    /* the extractor found its configuration good: all is zeroed now, so that no result hangs on what the
     * memory held */
    memset(pipeline, 0, sizeof *pipeline);
    ale_extractor_init(&pipeline->extractor, &config->extract);
    pipeline->config = *config;
    ale_pipeline_reset(pipeline);
    return 0;
}

void ale_pipeline_set_hook(ale_pipeline_t *pipeline, const ale_stage_hook_t *hook)
{
    pipeline->hook = hook ? *hook : (ale_stage_hook_t){NULL, NULL};
    ale_extractor_set_hook(&pipeline->extractor, hook);
}

int ale_pipeline_set_noise(ale_pipeline_t *pipeline, const ale_noise_t *noise)
{
    if (ale_extractor_set_noise(&pipeline->extractor, noise) < 0) {
        return -1;
    }
    pipeline->config.extract.noise = *noise;
    return 0;
}

/* Forgets what wheels, stamps and scans have told of the motion. */
static void reset_motion(ale_pipeline_t *p)
{
    const ale_pipeline_config_t *c = &p->config;
    ale_wheels_init(&p->wheels, c->max_speed_mm_s, c->max_turn_mrad_s);
    p->is_pending = false;
    ale_wheel_factors_init(&p->factors, c->odometry_distance_factor_ppm, c->odometry_turn_factor_ppm,
                           c->odometry_turn_bias_urad_m);
    ale_lag_init(&p->lag, c->odometry_lag_us);
    p->wheel_errors = (ale_wheel_errors_t){c->odometry_turn_urad_m, c->odometry_turn_ppm, {0}};
    ale_wheel_scale_init(&p->wheel_errors.scale, c->odometry_scale_ppm);
    ale_wheel_monitor_init(&p->wheel_monitor);
    ale_process_noise_init(&p->process_noise[0]);
    ale_process_noise_init(&p->process_noise[1]);
    ale_timestamp_filter_init(&p->timestamp_filter);
    p->scale_error = (ale_scale_error_t){0, 0};
    p->slips = false;
    p->speed_known = false;
    p->step = (ale_pose_t){0, 0, 0};
}

static void place(ale_pipeline_t *p, ale_pose_t pose)
{
    ale_motion_init(&p->motion, 0, pose, START_SPEED_MM_S, START_TURN_MRAD_S);
    p->watched = p->motion;
    ale_smooth_init(&p->smooth, pose);
}

static void reset_map(ale_pipeline_t *p)
{
    ale_local_map_clear(&p->map);
    ale_atlas_init(&p->atlas);
    p->decay.next = 0;
    p->map_uncertainty = (ale_map_uncertainty_t){0};
    p->drifted_um = 0;
    p->loaded = 0;
    p->partial = false;
    p->tile_waits = false;
    p->epoch++;
    p->corrections = 0;
    p->keyframes = 0;
    p->keyframe_scan = 0;
    p->broken = false;
    p->moved = false;
}

void ale_pipeline_reset(ale_pipeline_t *p)
{
    reset_motion(p);
    reset_map(p);
    place(p, (ale_pose_t){0, 0, 0});
    ale_tracking_init(&p->monitor);
    ale_filter_clear(p);
    ale_relocation_clear(&p->relocation);
    p->claims = 0;
    p->unlooked_um = 0;
    p->claim = ALE_CLAIM_NONE;
    p->next_claim = ALE_CLAIM_NEAR;
    p->joined = false;
    p->waits = 0;
    p->unconfirmed_from = 0;
    p->begun = 0;
    p->moved_map = (ale_moved_map_t){0, 0, {0, 0, 0}};
    p->scans = 0;
    p->determined = true;
    p->proposal.advantage_um = 0;
    p->started = false;
    p->looked = false;
    p->observed.count = 0;
    memset(&p->observed.features, 0, sizeof p->observed.features);
    memset(&p->fit, 0, sizeof p->fit);
}

void ale_pipeline_odometry(ale_pipeline_t *pipeline, const ale_odometry_t *sample)
{
    if (pipeline->config.use_odometry) {
        ale_pipeline_take_odometry(pipeline);
        pipeline->pending =
            (ale_odometry_t){sample->stamp_us, ale_wheel_factors_correct(&pipeline->factors, sample->pose)};
        pipeline->is_pending = true;
    }
}

/* Whether the robot can go this displacement in this time. */
static bool is_possible(const ale_pipeline_t *p, ale_pose_t displacement, int64_t dt_us)
{
    const int64_t dt_ms = ale_clamp64(dt_us / 1000, 0, ALE_SCAN_PERIOD_MAX_US / 1000);
    const int64_t sigma_um =
        3 * (int64_t)ale_isqrt((uint64_t)(p->motion.cov.m[0][0] + p->motion.cov.m[1][1]));
    const int64_t sigma_urad = 3 * (int64_t)ale_isqrt((uint64_t)p->motion.cov.m[2][2]);
    const int64_t reach_um = dt_ms * p->config.max_speed_mm_s + sigma_um;
    const int64_t reach_urad = dt_ms * p->config.max_turn_mrad_s + sigma_urad;
    const int64_t x = displacement.x_um;
    const int64_t y = displacement.y_um;
    return ale_abs64(x) <= reach_um && ale_abs64(y) <= reach_um && x * x + y * y <= reach_um * reach_um &&
           ale_abs64(ale_bam_to_nrad((int32_t)displacement.theta_bam)) / 1000 <= reach_urad;
}

/* The smooth pose goes the displacement of the map pose, unless the robot could not have gone it. */
static void advance_smooth(ale_pipeline_t *p, const ale_prediction_t *prediction)
{
    const ale_pose_t before = prediction->before.pose;
    const bool possible = is_possible(p, ale_pose_between(before, p->motion.pose), prediction->dt_us);
    if (possible && !p->moved) {
        ale_smooth_follow(&p->smooth, p->motion.pose);
    } else {
        ale_smooth_step(&p->smooth, ale_pose_between(before, prediction->ways.believed.pose), p->motion.pose);
    }
    p->broken = p->broken || !possible;
    p->moved = false;
}

static void conclude(ale_pipeline_t *p, const ale_tracked_t *tracked)
{
    p->step = ale_pose_between(p->motion.pose, tracked->fit.motion.pose);
    p->motion = tracked->fit.motion;
    p->fit = tracked->fit;
    p->matched_corners = tracked->matched_corners;
    p->determined = tracked->determined;
    p->speed_known = tracked->speed_known;
    p->slips = tracked->slips;
    p->kept = tracked->kept;
    if (tracked->kept) {
        p->watched = p->motion;
    }
}

static void follow_proposal(ale_pipeline_t *p, ale_pose_t before, ale_pose_t now)
{
    p->proposal.pose = ale_pose_compose(p->proposal.pose, ale_pose_between(before, now));
}

static void observe(ale_pipeline_t *p, const ale_scan_t *scan, const int32_t velocity[ALE_AXES])
{
    ale_step_observe(p, scan, velocity);
    ale_filter_begin(p);
    p->searched = false;
    p->waited = p->waits;
    if (p->waited == 1) {
        p->back_us = p->motion.stamp_us;
    }
    p->waits = 0;
    p->proposed = p->proposal;
    p->proposal.advantage_um = 0;
    p->looked = true;
}

static void begin(ale_pipeline_t *p, const ale_scan_t *scan)
{
    ale_motion_init(&p->motion, ale_pipeline_instant(p, scan->stamp_us), p->motion.pose, START_SPEED_MM_S,
                    START_TURN_MRAD_S);
    observe(p, scan, p->motion.velocity);
    const ale_tracked_t tracked = ale_step_track_first(p);
    conclude(p, &tracked);
    p->started = p->observed.count > 0;
    p->watched = p->motion;
}

/* A robot that knows nothing of where it is goes by the prediction, until a scan shows enough to begin a map
 * with. */
static void track(ale_pipeline_t *p, const ale_prediction_t *prediction)
{
    if (p->monitor.state != ALE_STATE_LOST) {
        const ale_tracked_t tracked = ale_step_track(p, prediction);
        conclude(p, &tracked);
    } else {
        p->motion = prediction->ways.believed;
        p->kept = false;
    }
    if (p->monitor.state == ALE_STATE_LOST && ale_maps_may_begin(p)) {
        ale_maps_begin(p);
        const ale_tracked_t tracked = ale_step_track_first(p);
        conclude(p, &tracked);
    }
}

static void follow(ale_pipeline_t *p, const ale_scan_t *scan)
{
    const ale_prediction_t prediction = ale_step_predict(p, scan->stamp_us);
    follow_proposal(p, prediction.before.pose, prediction.next);
    observe(p, scan, prediction.ways.believed.velocity);
    track(p, &prediction);
    if (!ale_maps_is_home(p)) {
        ale_step_search(p, &prediction);
    }
    advance_smooth(p, &prediction);
    if (p->kept) {
        /* seen from there, however the map pose settles after a correction */
        ale_filter_set_pose(p, p->smooth.pose);
    }
    ale_stage_end(&p->hook, ALE_STAGE_MAP);
}

static int32_t per_second(int32_t per_tick)
{
    return (int32_t)ale_round_shift((int64_t)per_tick * 1000000, ALE_TICK_BITS);
}

static void answer(ale_pipeline_t *p, int64_t stamp_us, bool predicted, uint32_t version, ale_estimate_t *out)
{
    memset(out, 0, sizeof *out);
    out->stamp_us = stamp_us;
    out->scan = p->scans++;
    out->epoch = p->epoch;
    out->corrections = p->corrections;
    out->smooth = p->smooth.pose;
    out->map = p->motion.pose;
    ale_map_covariance(&p->motion, &p->map_uncertainty, &p->scale_error, out->cov);
    if (!predicted) {
        ale_scan_information(&p->fit.information, out->information);
        out->matched_lines = p->fit.matched;
        out->matched_corners = p->matched_corners;
    }
    out->velocity_x_um_s = per_second(p->motion.velocity[0]);
    out->velocity_y_um_s = per_second(p->motion.velocity[1]);
    out->velocity_theta_urad_s = per_second(p->motion.velocity[2]);
    out->lag_us = p->lag.lag_us;
    out->state =
        (uint8_t)(p->determined || p->monitor.state == ALE_STATE_LOST ? p->monitor.state : ALE_STATE_WEAK);
    out->state = ale_maps_is_home(p) ? out->state : ALE_STATE_LOST;
    out->predicted = predicted;
    out->map_changed = p->map.version != version;
    out->map_id = ale_atlas_map_id(&p->atlas);
    out->maps = (uint8_t)ale_atlas_maps(&p->atlas);
    out->wheel_fault = (uint8_t)p->wheel_monitor.fault;
    out->wheel_faults = p->wheel_monitor.faults;
}

void ale_pipeline_scan(ale_pipeline_t *pipeline, const ale_scan_t *scan, ale_estimate_t *out)
{
    const uint32_t version = pipeline->map.version;
    if (pipeline->started) {
        follow(pipeline, scan);
    } else {
        begin(pipeline, scan);
    }
    answer(pipeline, scan->stamp_us, false, version, out);
}

void ale_pipeline_dropped(ale_pipeline_t *pipeline, int64_t stamp_us, ale_estimate_t *out)
{
    ale_wheel_motion_t wheels;
    pipeline->looked = false;
    pipeline->searched = false;
    ale_pipeline_take_odometry(pipeline);
    if (pipeline->started) {
        const ale_pose_t before = pipeline->motion.pose;
        const bool counted = ale_pipeline_predict_by_wheels(pipeline, &pipeline->motion, stamp_us, &wheels);
        follow_proposal(pipeline, before, pipeline->motion.pose);
        if (counted) {
            ale_scale_error_predict(&pipeline->scale_error, before, pipeline->motion.pose,
                                    ale_wheel_scale_error_ppm(&pipeline->wheel_errors.scale));
        }
        if (!ale_maps_is_home(pipeline)) {
            ale_relocation_follow(&pipeline->relocation, ale_pose_between(before, pipeline->motion.pose),
                                  counted);
        }
        ale_smooth_follow(&pipeline->smooth, pipeline->motion.pose);
        ale_tracking_skip(&pipeline->monitor, &pipeline->motion);
    } else {
        pipeline->motion.stamp_us = stamp_us;
    }
    answer(pipeline, stamp_us, true, pipeline->map.version, out);
}

/* Whether the scan at hand was taken where the pose says: not while lost, nor while scans are denied by one
 * that was taken beside them, which is called weak until it is called lost. */
static bool is_placed(const ale_pipeline_t *p)
{
    return p->monitor.state != ALE_STATE_LOST && !(p->monitor.contradicted && p->monitor.contradicted_nearby);
}

bool ale_pipeline_seen(const ale_pipeline_t *p, ale_seen_t *out)
{
    if (!p->looked || !is_placed(p)) {
        return false;
    }
    *out = (ale_seen_t){.posed = {&p->still.scan, ale_observed_bearings(&p->observed),
                                  ale_pose_compose(p->motion.pose, p->config.sensor)},
                        .robot = p->motion.pose,
                        .observation = p->still.observation,
                        .observation_count = p->still.count};
    return true;
}

const ale_features_t *ale_pipeline_features(const ale_pipeline_t *pipeline)
{
    return &pipeline->observed.features;
}

void ale_pipeline_copy_map(const ale_pipeline_t *pipeline, ale_map_t *out)
{
    ale_map_export(&pipeline->map, &pipeline->atlas, out);
}

void ale_pipeline_load_map(ale_pipeline_t *pipeline, const ale_map_t *map, uint32_t number, ale_pose_t pose,
                           bool known)
{
    ale_pipeline_reset(pipeline);
    ale_map_import(&pipeline->map, map);
    pipeline->loaded = number;
    place(pipeline, pose);
    ale_maps_lose(pipeline, known ? ALE_CLAIM_SAID : ALE_CLAIM_NONE);
    pipeline->started = pipeline->map.count > 0;
}

void ale_pipeline_load_tiles(ale_pipeline_t *pipeline, ale_pose_t pose, bool known)
{
    ale_pipeline_reset(pipeline);
    pipeline->loaded = ALE_LOADED_TILES;
    pipeline->partial = true;
    place(pipeline, pose);
    ale_maps_lose(pipeline, known ? ALE_CLAIM_SAID : ALE_CLAIM_NONE);
    pipeline->started = true;
}
