#include "track/pipeline.h"

#include <stddef.h>
#include <string.h>

#include "base/fixed.h"
#include "base/trig.h"
#include "track/deskew.h"
#include "track/map_exchange.h"
#include "track/map_update.h"
#include "track/pipeline_state.h"
#include "track/uncertainty.h"

enum {
    ACQUIRE_OFFSET_UM = 600000, /* how far a wall may lie from where the prediction puts it */
    ACQUIRE_ANGLE_URAD = 300000,
    ACQUIRE_SIGMAS = 4,
    ACQUIRE_PIECE_UM = 100000,
    START_SPEED_MM_S = 300,
    START_TURN_MRAD_S = 500,
    LEARN_DETERMINED_UM = 10000, /* scans that know the way well enough to teach the wheels */
    LEARN_LAG_VAR_UM2 = 4000000, /* and a lag that could not have made (2 mm)^2 of it */
    WHOLE_MAP_UM = 2000000000,   /* a reach beyond any map */
    ANCHOR_SIGMA_UM = 1000,      /* of the pose to the walls that are born from it */
    ANCHOR_SIGMA_URAD = 500,
    SEARCH_SIGMA_UM = 100000,
    SEARCH_SIGMA_URAD = 50000,
    CLAIM_SCANS = 30, /* that may still show that the robot is where it is said to be */
    SCAN_PERIOD_MAX_US = 2000000,
    REGISTER_UM = 100000, /* how far wheels may be off beyond what they promise */
    REGISTER_URAD = 60000,
    REGISTER_MOST_UM = 1000000,
    REGISTER_MOST_URAD = 450000,
    SLACK_UM = 60000,
    SLACK_URAD = 30000,
    SLACK_MOST_UM = 200000, /* a way that may be off by more says nothing of what was seen where */
    SLACK_MOST_URAD = 100000,
    REJECT_PARTS = 10, /* less than this part of what is shown, found in the map, is found by chance */
    SCAN_SET_BACK_US = 1000000 /* a stamp older than the last by less is a wrong stamp */
};

static const ale_gate_t narrow_gate = {60000, 200000, 4, 50000};
static const ale_gate_t register_gate = {250000, 200000, 6, 100000};

ale_pipeline_config_t ale_pipeline_default_config(void)
{
    return (ale_pipeline_config_t){
        .extract = ale_extract_default_config(),
        .use_odometry = true,
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

static bool is_valid(const ale_pipeline_config_t *c)
{
    return c->odometry_scale_ppm >= 0 && c->odometry_scale_ppm <= 500000 && c->odometry_turn_urad_m >= 0 &&
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
    ale_lag_init(&pipeline->lag, c->odometry_lag_us);
    ale_wheel_scale_init(&pipeline->scale, &noise);
    ale_liveliness_init(&pipeline->liveliness[0]);
    ale_liveliness_init(&pipeline->liveliness[1]);
    ale_pace_init(&pipeline->pace);
    ale_tracker_init(&pipeline->tracker);
    ale_local_map_clear(&pipeline->map);
    ale_motion_init(&pipeline->motion, 0, (ale_pose_t){0, 0, 0}, START_SPEED_MM_S, START_TURN_MRAD_S);
    pipeline->smooth = (ale_pose_t){0, 0, 0};
    pipeline->scans = 0;
    pipeline->drift = (ale_drift_t){0, 0};
    pipeline->fade.next = 0;
    ale_relocation_clear(&pipeline->relocation);
    ale_witness_clear(&pipeline->witness);
    pipeline->started = false;
    pipeline->looked = false;
    pipeline->epoch++;
    pipeline->corrections = 0;
    pipeline->keyframes = 0;
    pipeline->broken = false;
    pipeline->moved = false;
    pipeline->claims = 0;
    pipeline->view_count = 0;
    memset(&pipeline->features, 0, sizeof pipeline->features);
    memset(&pipeline->fit, 0, sizeof pipeline->fit);
}

void ale_pipeline_odometry(ale_pipeline_t *pipeline, const ale_odometry_t *sample)
{
    if (pipeline->config.use_odometry) {
        ale_wheels_add(&pipeline->wheels, sample);
    }
}

/* The way from the last scan to this instant, by wheels where there are some. */
static bool predict(ale_pipeline_t *p, int64_t stamp_us, ale_wheel_motion_t *wheels)
{
    const bool known = ale_wheel_motion(&p->wheels, &p->lag, &p->scale, p->motion.stamp_us, stamp_us, wheels);
    if (ale_pace_believes(&p->pace, stamp_us - p->motion.stamp_us)) {
        ale_motion_predict(&p->motion, stamp_us, known ? wheels : NULL, &p->liveliness[known]);
    } else {
        ale_motion_jump(&p->motion, stamp_us, known ? wheels : NULL, &p->liveliness[known]);
    }
    return known;
}

/* When a scan was taken: scans come in their order, whatever their stamps say of it. A clock that was set
 * back is followed. */
static int64_t instant_of(ale_pipeline_t *p, int64_t stamp_us)
{
    const int64_t instant_us = ale_pace_instant(&p->pace, stamp_us);
    const int64_t last_us = p->motion.stamp_us;
    return instant_us <= last_us && instant_us > last_us - SCAN_SET_BACK_US ? last_us + 1 : instant_us;
}

/* The noise model with the beams' own noise as the extractor found it in this scan. */
static ale_noise_t measured_noise(const ale_pipeline_t *p)
{
    ale_noise_t noise = p->config.extract.noise;
    const ale_scan_noise_t *found = &p->extractor.noise;
    noise.own_um = (int32_t)ale_isqrt((uint64_t)ale_mul_shift(found->own_mm2_q36, 1000000, 36));
    noise.own_ppm = (int32_t)ale_isqrt((uint64_t)ale_mul_shift(found->own_relative_q36, 1000000000000, 36));
    return noise;
}

static const uint32_t *bearings(const ale_pipeline_t *p)
{
    return p->straightened ? p->bearing_bam : NULL;
}

/* Straightens the scan with a velocity, extracts, and turns lines and what is left into views. */
static void look(ale_pipeline_t *p, const ale_scan_t *raw, const int32_t velocity[ALE_AXES])
{
    int32_t sensor_velocity[ALE_AXES];
    p->scan = *raw;
    p->looked = true;
    ale_scan_mask(&p->scan, p->config.blind, p->config.blind_count);
    ale_sensor_velocity(velocity, p->config.sensor, sensor_velocity);
    p->straightened = ale_deskew(&p->scan, sensor_velocity, p->bearing_bam);
    const uint32_t *bearing_bam = bearings(p);
    ale_stage_end(&p->hook, ALE_STAGE_DESKEW);
    ale_extract_scan(&p->extractor, &p->scan, bearing_bam, &p->features);
    const ale_noise_t noise = measured_noise(p);
    p->view_count = ale_views_of(&p->features, &p->scan, p->config.sensor, noise.surface_um / 2, p->view);
    p->view_count +=
        ale_pieces_of(&p->features, &p->scan, bearing_bam, p->config.sensor, &noise, &p->view[p->view_count]);
}

static void match(ale_pipeline_t *p, const ale_motion_t *predicted, int32_t reach_um)
{
    const ale_gate_t gate = {ACQUIRE_OFFSET_UM, ACQUIRE_ANGLE_URAD, ACQUIRE_SIGMAS, ACQUIRE_PIECE_UM};
    const ale_scene_t scene = {&p->map, p->view, p->view_count};
    const ale_point_t centre = {predicted->pose.x_um, predicted->pose.y_um};
    ale_local_map_approach(&p->map, centre, reach_um);
    ale_refine(predicted, &scene, &gate, &p->fit);
}

/* The smooth pose goes the way the map pose went, unless the robot could not have gone it. */
static void advance_smooth(ale_pipeline_t *p, ale_pose_t from, ale_pose_t predicted, int64_t dt_us)
{
    const ale_pose_t way = ale_pose_between(from, p->motion.pose);
    const int64_t dt_ms = ale_clamp64(dt_us / 1000, 0, SCAN_PERIOD_MAX_US / 1000);
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
    p->smooth = ale_pose_compose(p->smooth, along ? way : ale_pose_between(from, predicted));
}

/* What a good scan teaches about the wheels: their lag from turns, their scale from the way. */
static void teach_wheels(ale_pipeline_t *p, const ale_motion_t *before, const ale_wheel_motion_t *counted)
{
    const int64_t dt_us = p->motion.stamp_us - before->stamp_us;
    if (!p->config.use_odometry || dt_us <= 0 || dt_us > SCAN_PERIOD_MAX_US ||
        !ale_information_determines(&p->fit.information, LEARN_DETERMINED_UM)) {
        return;
    }
    const ale_pose_t way = ale_pose_between(before->pose, p->motion.pose);
    const ale_heading_t heading = {p->motion.stamp_us, p->motion.pose.theta_bam, p->motion.velocity[2]};
    ale_lag_add_heading(&p->lag, &heading);
    ale_lag_update(&p->lag, &p->wheels);
    if (counted && counted->lag_var_um2 < LEARN_LAG_VAR_UM2) {
        ale_wheel_scale_learn(&p->scale, way.x_um, counted->counted_um);
    }
}

/* The scan goes into the map. */
static void take_in(ale_pipeline_t *p, bool grow)
{
    if (p->frozen) {
        return;
    }
    const ale_pose_t sensor = ale_pose_compose(p->fit.motion.pose, p->config.sensor);
    ale_map_update(&p->map, p->view, p->view_count, &p->fit, p->drift, p->scans, grow);
    p->matched_corners = ale_map_corners_update(&p->map.corners, &p->features, sensor, p->scans, grow);
}

static void begin(ale_pipeline_t *p, const ale_scan_t *scan)
{
    ale_motion_init(&p->motion, ale_pace_instant(&p->pace, scan->stamp_us), p->motion.pose, START_SPEED_MM_S,
                    START_TURN_MRAD_S);
    look(p, scan, p->motion.velocity);
    p->fit.motion = p->motion;
    match(p, &p->motion, p->scan.range_max_um);
    p->fit.motion = p->motion;
    ale_stage_end(&p->hook, ALE_STAGE_MATCH);
    take_in(p, true);
    p->started = p->view_count > 0;
}

/* Asks the near walls that were not matched whether they are there; those that are not fade. */
static ale_sights_t look_around(ale_pipeline_t *p)
{
    const ale_pose_t sensor = ale_pose_compose(p->motion.pose, p->config.sensor);
    return ale_fade(&p->fade, &p->map, &p->scan, bearings(p), sensor, p->scans,
                    p->tracker.state == ALE_STATE_GOOD && !p->frozen);
}

static int64_t sigma_of(const ale_matrix_t *cov, int axis)
{
    return (int64_t)ale_isqrt((uint64_t)ale_max64(cov->m[axis][axis], 0));
}

/* The scan at hand as the witness hears of it: on the way that is smooth, which no correction of the map
 * bends. */
static ale_seen_t seen(const ale_pipeline_t *p, const ale_motion_t *before)
{
    const ale_pose_t robot = ale_pose_compose(p->smooth, ale_pose_between(before->pose, p->motion.pose));
    return (ale_seen_t){.scan = &p->scan,
                        .bearing_bam = bearings(p),
                        .robot = robot,
                        .sensor = ale_pose_compose(robot, p->config.sensor),
                        .view = p->view,
                        .view_count = p->view_count};
}

/* Hears the last scan when the map knows little of this one; a scan that fits is the next to be heard, one
 * that does not leaves the prediction as it is. */
static void notice(ale_pipeline_t *p, const ale_motion_t *before, const ale_motion_t *predicted, bool counted)
{
    const ale_seen_t now = seen(p, before);
    const ale_matrix_t *cov = &p->motion.cov;
    const int64_t offset_um = SLACK_UM + 2 * ale_max64(sigma_of(cov, 0), sigma_of(cov, 1));
    const ale_slack_t slack = {
        (int32_t)ale_min64(offset_um, counted ? SLACK_MOST_UM : 2 * SLACK_UM),
        (int32_t)ale_min64(2 * sigma_of(cov, 2), counted ? SLACK_MOST_URAD : SLACK_URAD)};
    const bool doubt = ale_tracker_is_strange(&p->tracker, &p->fit);
    const ale_testimony_t heard = doubt ? ale_witness_hear(&p->witness, &now, slack) : (ale_testimony_t){0};
    ale_tracker_notice(&p->tracker, doubt ? &heard : NULL, counted);
    if (p->tracker.jumped) {
        const ale_scene_t scene = {&p->map, p->view, p->view_count};
        ale_refine_reject(predicted, &scene, &p->fit);
        p->motion = *predicted;
    } else {
        ale_witness_keep(&p->witness, &now);
    }
}

/* Where the scan shows enough, but too little of it is in the map to hold the pose, the map goes on from
 * here: new walls hold the robot as exactly as old ones, and how far they may be off is the drift they are
 * born with. */
static void anchor(ale_pipeline_t *p)
{
    if (ale_tracker_may_anchor(&p->tracker, &p->fit)) {
        p->drift = ale_drift_of_new_wall(p->drift, &p->fit.motion.cov);
        ale_motion_widen(&p->fit.motion, ANCHOR_SIGMA_UM, ANCHOR_SIGMA_URAD);
        p->motion = p->fit.motion;
    }
}

/* The map explains too little of the scan. Wide gates may have caught the wrong walls: once more with narrow
 * ones; then from where the last scan says that the robot is. What only little speaks for is not believed. */
static void match_again(ale_pipeline_t *p, const ale_motion_t *before, const ale_motion_t *predicted)
{
    const ale_scene_t scene = {&p->map, p->view, p->view_count};
    const ale_matrix_t *cov = &predicted->cov;
    const int64_t reach_um = REGISTER_UM + 5 * ale_max64(sigma_of(cov, 0), sigma_of(cov, 1));
    const int64_t reach_urad = REGISTER_URAD + 5 * sigma_of(cov, 2);
    /* on the way that is smooth, as the witness is */
    const ale_pose_t guess = ale_pose_compose(p->smooth, ale_pose_between(before->pose, predicted->pose));
    ale_pose_t way = ale_pose_between(p->witness.robot, guess);
    ale_refine_again(predicted, predicted->pose, &scene, &narrow_gate, &p->fit);
    if (ale_tracker_doubts(&p->fit) &&
        ale_register(&p->registration, (ale_views_t){p->witness.view, p->witness.view_count},
                     (ale_views_t){p->view, p->view_count}, (int32_t)ale_min64(reach_um, REGISTER_MOST_UM),
                     (int32_t)ale_min64(reach_urad, REGISTER_MOST_URAD), &way)) {
        const ale_pose_t there = ale_pose_compose(p->witness.robot, way);
        const ale_pose_t from = ale_pose_compose(before->pose, ale_pose_between(p->smooth, there));
        ale_refine_again(predicted, from, &scene, &register_gate, &p->fit);
    }
    if (p->fit.matched_um * REJECT_PARTS < p->fit.shown_um) {
        ale_refine_reject(predicted, &scene, &p->fit);
    }
}

/* Tracks: matches where the prediction puts the robot, judges the result, and takes it into the map. */
static void track(ale_pipeline_t *p, const ale_motion_t *before, const ale_motion_t *predicted,
                  const ale_wheel_motion_t *wheels)
{
    match(p, predicted, p->scan.range_max_um);
    if (ale_tracker_doubts(&p->fit)) {
        match_again(p, before, predicted);
    }
    p->motion = p->fit.motion;
    notice(p, before, predicted, wheels != NULL);
    p->drift = ale_drift_here(&p->map, p->view, p->view_count, &p->fit, p->drift);
    if (!p->tracker.jumped) {
        ale_liveliness_learn(&p->liveliness[wheels != NULL], predicted, &p->motion);
        teach_wheels(p, before, wheels);
    }
    ale_stage_end(&p->hook, ALE_STAGE_MATCH);
    anchor(p);
    take_in(p, ale_tracker_may_map(&p->tracker, &p->fit));
    ale_local_map_approach(&p->map, (ale_point_t){p->motion.pose.x_um, p->motion.pose.y_um},
                           p->scan.range_max_um);
    const ale_sights_t sights = look_around(p);
    ale_tracker_judge(&p->tracker, &p->fit, &sights);
}

/* Fits the scan to the map at about this pose. */
static void try_at(ale_pipeline_t *p, ale_pose_t pose)
{
    ale_motion_t there = p->motion;
    there.pose = pose;
    ale_motion_widen(&there, SEARCH_SIGMA_UM, SEARCH_SIGMA_URAD);
    match(p, &there, WHOLE_MAP_UM);
}

static void settle(ale_pipeline_t *p)
{
    p->motion = p->fit.motion;
    p->claims = 0;
    ale_relocation_clear(&p->relocation);
    ale_tracker_found(&p->tracker);
}

/* Where the robot is said to be is looked at first, for a few scans. */
static bool is_where_claimed(ale_pipeline_t *p)
{
    if (p->claims == 0) {
        return false;
    }
    p->claims--;
    try_at(p, p->motion.pose);
    return ale_tracker_expected(&p->fit);
}

/* Lost: looks for the place that fits, with bounded work a scan, and leaves the map alone. */
static void search(ale_pipeline_t *p, ale_pose_t way)
{
    p->broken = true;
    if (is_where_claimed(p)) {
        settle(p);
        ale_stage_end(&p->hook, ALE_STAGE_MATCH);
        return;
    }
    const ale_point_t anywhere = {0, 0};
    ale_local_map_approach(&p->map, anywhere, WHOLE_MAP_UM);
    const ale_scene_t scene = {&p->map, p->view, p->view_count};
    const ale_eye_t eye = {&p->scan, bearings(p), p->config.sensor};
    if (ale_relocate(&p->relocation, &scene, &eye, &p->motion, way, &p->fit) &&
        ale_tracker_believes(&p->fit)) {
        settle(p);
    }
    ale_stage_end(&p->hook, ALE_STAGE_MATCH);
}

static void follow(ale_pipeline_t *p, const ale_scan_t *scan)
{
    const ale_motion_t before = p->motion;
    const int64_t instant_us = instant_of(p, scan->stamp_us);
    ale_wheel_motion_t wheels;
    const bool counted = predict(p, instant_us, &wheels);
    const ale_motion_t predicted = p->motion;
    look(p, scan, predicted.velocity);
    if (p->tracker.state == ALE_STATE_LOST) {
        search(p, ale_pose_between(before.pose, predicted.pose));
    } else {
        track(p, &before, &predicted, counted ? &wheels : NULL);
    }
    advance_smooth(p, before.pose, predicted.pose, instant_us - before.stamp_us);
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
    out->smooth = p->smooth;
    out->map = p->motion.pose;
    ale_map_covariance(&p->motion, p->drift, out->cov);
    if (!predicted) {
        ale_scan_information(&p->fit.information, out->information);
        out->matched_lines = p->fit.matched;
        out->matched_corners = p->matched_corners;
    }
    out->velocity_x_um_s = per_second(p->motion.velocity[0]);
    out->velocity_y_um_s = per_second(p->motion.velocity[1]);
    out->velocity_theta_urad_s = per_second(p->motion.velocity[2]);
    out->lag_us = p->lag.lag_us;
    out->state = (uint8_t)p->tracker.state;
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
        predict(pipeline, stamp_us, &wheels);
        pipeline->smooth =
            ale_pose_compose(pipeline->smooth, ale_pose_between(before, pipeline->motion.pose));
        ale_tracker_skip(&pipeline->tracker, &pipeline->motion);
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
    ale_map_hand_out(&pipeline->map, out);
}

void ale_pipeline_load_map(ale_pipeline_t *pipeline, const ale_map_t *map, ale_pose_t pose, bool known)
{
    ale_pipeline_reset(pipeline);
    ale_map_take_in(&pipeline->map, map);
    ale_motion_init(&pipeline->motion, 0, pose, START_SPEED_MM_S, START_TURN_MRAD_S);
    pipeline->smooth = pose;
    pipeline->tracker.state = ALE_STATE_LOST;
    pipeline->claims = known ? CLAIM_SCANS : 0;
    pipeline->started = pipeline->map.count > 0;
}
