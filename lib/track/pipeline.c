#include "track/pipeline.h"

#include <stddef.h>
#include <string.h>

#include "base/fixed.h"
#include "base/trig.h"
#include "map/map_exchange.h"
#include "match/uncertainty.h"
#include "track/pipeline_steps.h"

enum {
    START_SPEED_MM_S = 300,
    START_TURN_MRAD_S = 500,
    CLAIM_SCANS = 30,          /* that may still show that the robot is where it is said to be */
    SCAN_SET_BACK_US = 1000000 /* a stamp older than the last by less is a wrong stamp */
};

ale_pipeline_config_t ale_pipeline_default_config(void)
{
    return (ale_pipeline_config_t){
        .extract = ale_extract_default_config(),
        .use_odometry = true,
        .odometry_distance_factor_ppm = ALE_WHEEL_FACTOR_ONE,
        .odometry_turn_factor_ppm = ALE_WHEEL_FACTOR_ONE,
        .odometry_scale_ppm = 50000,
        .odometry_turn_urad_m = 35000,
        .odometry_turn_ppm = 20000,
        .max_speed_mm_s = 3000,
        .max_turn_mrad_s = 6000,
    };
}

uint32_t ale_pipeline_size(void)
{
    return (uint32_t)sizeof(ale_pipeline_t);
}

static bool is_factor(int32_t ppm)
{
    return ppm >= ALE_WHEEL_FACTOR_ONE / 2 && ppm <= 2 * ALE_WHEEL_FACTOR_ONE;
}

static bool is_valid(const ale_pipeline_config_t *c)
{
    return is_factor(c->odometry_distance_factor_ppm) && is_factor(c->odometry_turn_factor_ppm) &&
           ale_abs64(c->odometry_turn_bias_urad_m) <= 1000000 && c->odometry_scale_ppm >= 0 &&
           c->odometry_scale_ppm <= 500000 && c->odometry_turn_urad_m >= 0 &&
           c->odometry_turn_urad_m <= 1000000 && c->odometry_turn_ppm >= 0 &&
           c->odometry_turn_ppm <= 500000 && c->odometry_lag_us >= -100000 && c->odometry_lag_us <= 300000 &&
           c->max_speed_mm_s > 0 && c->max_speed_mm_s <= 50000 && c->max_turn_mrad_s > 0 &&
           c->max_turn_mrad_s <= 50000 && c->blind_count <= ALE_MAX_BLIND_SECTORS;
}

int ale_pipeline_init(ale_pipeline_t *pipeline, const ale_pipeline_config_t *config)
{
    if (!is_valid(config) || ale_extractor_init(&pipeline->extractor, &config->extract) < 0) {
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

void ale_pipeline_reset(ale_pipeline_t *pipeline)
{
    const ale_pipeline_config_t *c = &pipeline->config;
    const ale_wheel_noise_t noise = {c->odometry_scale_ppm, c->odometry_turn_urad_m, c->odometry_turn_ppm};
    ale_wheels_init(&pipeline->wheels, c->max_speed_mm_s, c->max_turn_mrad_s);
    ale_wheel_factors_init(&pipeline->factors, c->odometry_distance_factor_ppm, c->odometry_turn_factor_ppm,
                           c->odometry_turn_bias_urad_m);
    ale_lag_init(&pipeline->lag, c->odometry_lag_us);
    ale_wheel_scale_init(&pipeline->scale, &noise);
    ale_process_noise_init(&pipeline->process_noise[0]);
    ale_process_noise_init(&pipeline->process_noise[1]);
    ale_timestamp_filter_init(&pipeline->timestamp_filter);
    ale_tracking_init(&pipeline->monitor);
    ale_local_map_clear(&pipeline->map);
    ale_motion_init(&pipeline->motion, 0, (ale_pose_t){0, 0, 0}, START_SPEED_MM_S, START_TURN_MRAD_S);
    ale_smooth_init(&pipeline->smooth, (ale_pose_t){0, 0, 0});
    pipeline->scans = 0;
    pipeline->map_uncertainty = (ale_map_uncertainty_t){0};
    pipeline->scale_error = (ale_scale_error_t){0, 0};
    pipeline->drifted_um = 0;
    pipeline->determined = true;
    pipeline->speed_known = false;
    pipeline->map_decay.next = 0;
    ale_relocation_clear(&pipeline->relocation);
    ale_witness_clear(&pipeline->witness);
    ale_overview_clear(&pipeline->overview);
    ale_carried_clear(&pipeline->carried);
    ale_elders_clear(&pipeline->elders);
    ale_zero_motion_clear(&pipeline->zero_motion);
    pipeline->started = false;
    pipeline->looked = false;
    pipeline->loaded = 0;
    pipeline->epoch++;
    pipeline->corrections = 0;
    pipeline->keyframes = 0;
    pipeline->keyframe_scan = 0;
    pipeline->broken = false;
    pipeline->moved = false;
    pipeline->claims = 0;
    pipeline->slips = false;
    pipeline->observation_count = 0;
    memset(&pipeline->features, 0, sizeof pipeline->features);
    memset(&pipeline->fit, 0, sizeof pipeline->fit);
}

void ale_pipeline_odometry(ale_pipeline_t *pipeline, const ale_odometry_t *sample)
{
    if (pipeline->config.use_odometry) {
        const ale_odometry_t corrected = {sample->stamp_us,
                                          ale_wheel_factors_correct(&pipeline->factors, sample->pose)};
        ale_wheels_add(&pipeline->wheels, &corrected);
    }
}

void ale_pipeline_predict_motion(const ale_pipeline_t *p, ale_motion_t *motion, int64_t stamp_us,
                                 const ale_wheel_motion_t *wheels)
{
    const ale_process_noise_t *l = &p->process_noise[wheels != NULL];
    if (ale_timestamp_filter_accepts(&p->timestamp_filter, stamp_us - motion->stamp_us)) {
        ale_motion_predict(motion, stamp_us, wheels, l);
    } else {
        ale_motion_jump(motion, stamp_us, wheels, l);
    }
}

/* The way from the last scan to this instant, by wheels where there are some. */
static bool predict(ale_pipeline_t *p, int64_t stamp_us, ale_wheel_motion_t *wheels)
{
    const bool known = ale_wheel_motion(&p->wheels, &p->lag, &p->scale, p->motion.stamp_us, stamp_us, wheels);
    ale_pipeline_predict_motion(p, &p->motion, stamp_us, known ? wheels : NULL);
    return known;
}

/* When a scan was taken: scans come in their order, whatever their stamps say of it. A clock that was set
 * back is followed. */
static int64_t instant_of(ale_pipeline_t *p, int64_t stamp_us)
{
    const int64_t instant_us = ale_timestamp_filter_instant(&p->timestamp_filter, stamp_us);
    const int64_t last_us = p->motion.stamp_us;
    return instant_us <= last_us && instant_us > last_us - SCAN_SET_BACK_US ? last_us + 1 : instant_us;
}

/* The smooth pose goes the way the map pose went, unless the robot could not have gone it. */
static void advance_smooth(ale_pipeline_t *p, ale_pose_t from, ale_pose_t predicted, int64_t dt_us)
{
    const ale_pose_t way = ale_pose_between(from, p->motion.pose);
    const int64_t dt_ms = ale_clamp64(dt_us / 1000, 0, ALE_SCAN_PERIOD_MAX_US / 1000);
    const int64_t sigma_um =
        3 * (int64_t)ale_isqrt((uint64_t)(p->motion.cov.m[0][0] + p->motion.cov.m[1][1]));
    const int64_t sigma_urad = 3 * (int64_t)ale_isqrt((uint64_t)p->motion.cov.m[2][2]);
    const int64_t reach_um = dt_ms * p->config.max_speed_mm_s + sigma_um;
    const int64_t reach_urad = dt_ms * p->config.max_turn_mrad_s + sigma_urad;
    const int64_t turn_urad = ale_abs64(ale_bam_to_nrad((int32_t)way.theta_bam)) / 1000;
    const bool possible =
        ale_abs64(way.x_um) <= reach_um && ale_abs64(way.y_um) <= reach_um &&
        (int64_t)way.x_um * way.x_um + (int64_t)way.y_um * way.y_um <= reach_um * reach_um &&
        turn_urad <= reach_urad;
    const bool along = possible && !p->moved;
    p->broken = p->broken || !possible;
    p->moved = false;
    if (along) {
        ale_smooth_follow(&p->smooth, p->motion.pose);
    } else {
        ale_smooth_step(&p->smooth, ale_pose_between(from, predicted), p->motion.pose);
    }
}

static void begin(ale_pipeline_t *p, const ale_scan_t *scan)
{
    ale_motion_init(&p->motion, ale_timestamp_filter_instant(&p->timestamp_filter, scan->stamp_us),
                    p->motion.pose, START_SPEED_MM_S, START_TURN_MRAD_S);
    ale_pipeline_preprocess(p, scan, p->motion.velocity);
    ale_pipeline_first(p);
}

/* Believes the wheels, or, as long as they slip, that the robot goes on as before. */
static void choose_way(ale_pipeline_t *p, const ale_motion_t *before, bool counted)
{
    if (!counted) {
        p->ways = (ale_ways_t){.believed = p->motion, .rival = p->motion};
        return;
    }
    ale_motion_t as_before = *before;
    ale_pipeline_predict_motion(p, &as_before, p->motion.stamp_us, NULL);
    p->ways = ale_ways_of(&p->motion, &as_before, p->slips && p->monitor.state != ALE_STATE_LOST);
    p->motion = p->ways.believed;
}

static void follow(ale_pipeline_t *p, const ale_scan_t *scan)
{
    const ale_motion_t before = p->motion;
    const int64_t instant_us = instant_of(p, scan->stamp_us);
    ale_wheel_motion_t wheels;
    const bool counted = predict(p, instant_us, &wheels);
    choose_way(p, &before, counted);
    const ale_motion_t predicted = p->motion;
    ale_pipeline_preprocess(p, scan, predicted.velocity);
    if (p->monitor.state == ALE_STATE_LOST) {
        p->speed_known = false;
        ale_pipeline_search(p, ale_pose_between(before.pose, predicted.pose), p->ways.counted);
    } else {
        ale_pipeline_track(p, &before, &wheels);
    }
    const int64_t dt_us = instant_us - before.stamp_us;
    /* a time that cannot be believed forbids no way */
    advance_smooth(p, before.pose, predicted.pose,
                   ale_timestamp_filter_accepts(&p->timestamp_filter, dt_us) ? dt_us
                                                                             : p->timestamp_filter.usual_us);
    ale_pipeline_set_record_pose(p);
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
    out->predicted = predicted;
    out->map_changed = p->map.version != version;
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
    if (pipeline->started) {
        const ale_pose_t before = pipeline->motion.pose;
        if (predict(pipeline, stamp_us, &wheels)) {
            ale_scale_error_predict(&pipeline->scale_error, before, pipeline->motion.pose,
                                    ale_wheel_scale_error_ppm(&pipeline->scale));
        }
        ale_smooth_follow(&pipeline->smooth, pipeline->motion.pose);
        ale_tracking_skip(&pipeline->monitor, &pipeline->motion);
    } else {
        pipeline->motion.stamp_us = stamp_us;
    }
    answer(pipeline, stamp_us, true, pipeline->map.version, out);
}

const ale_features_t *ale_pipeline_features(const ale_pipeline_t *pipeline)
{
    return &pipeline->features;
}

void ale_pipeline_copy_map(const ale_pipeline_t *pipeline, ale_map_t *out)
{
    ale_map_export(&pipeline->map, out);
}

void ale_pipeline_load_map(ale_pipeline_t *pipeline, const ale_map_t *map, uint32_t number, ale_pose_t pose,
                           bool known)
{
    ale_pipeline_reset(pipeline);
    ale_map_import(&pipeline->map, map);
    pipeline->loaded = number;
    ale_motion_init(&pipeline->motion, 0, pose, START_SPEED_MM_S, START_TURN_MRAD_S);
    ale_smooth_init(&pipeline->smooth, pose);
    pipeline->monitor.state = ALE_STATE_LOST;
    pipeline->claims = known ? CLAIM_SCANS : 0;
    pipeline->started = pipeline->map.count > 0;
}
