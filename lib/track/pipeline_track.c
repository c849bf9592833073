/* The robot is about where the prediction puts it: match, judge, map. */
#include <stddef.h>

#include "base/fixed.h"
#include "base/trig.h"
#include "match/observability.h"
#include "track/map_update.h"
#include "track/pipeline_steps.h"

enum {
    ACQUIRE_OFFSET_UM = 600000, /* how far a wall may lie from where the prediction puts it */
    ACQUIRE_ANGLE_URAD = 300000,
    ACQUIRE_SIGMAS = 4,
    ACQUIRE_SEGMENT_UM = 100000,
    LEARN_DETERMINED_UM = 10000, /* scans that know the way well enough to teach the wheels */
    LEARN_LAG_VAR_UM2 = 4000000, /* and a lag that could not have made (2 mm)^2 of it */
    ANCHOR_SIGMA_UM = 1000,      /* of the pose to the walls that are born from it */
    ANCHOR_SIGMA_URAD = 500,
    REGISTER_UM = 100000, /* how far wheels may be off beyond what they promise */
    REGISTER_URAD = 60000,
    REGISTER_MOST_UM = 1000000,
    REGISTER_MOST_URAD = 450000,
    STRAIGHT_URAD = 100000, /* that tales of the way part by, and a scan is not bent by the wrong one */
    SLACK_UM = 60000,
    SLACK_URAD = 30000,
    SLACK_MOST_UM = 200000, /* a way that may be off by more says nothing of what was seen where */
    SLACK_MOST_URAD = 100000,
    EVEN_US = 250000, /* a scan that comes later says nothing of a speed */
    PREFER_PARTS = 5, /* of what two scans show of each other, by which one pose is preferred */
    CHANCE_PARTS = 10 /* less than this part of what is shown, found in the map, may be found by chance */
};

static const ale_gate_t acquire_gate = {ACQUIRE_OFFSET_UM, ACQUIRE_ANGLE_URAD, ACQUIRE_SIGMAS,
                                        ACQUIRE_SEGMENT_UM};
static const ale_gate_t narrow_gate = {60000, 200000, 4, 50000};
static const ale_gate_t register_gate = {250000, 200000, 6, 100000};

ale_scene_t ale_pipeline_scene(ale_pipeline_t *p)
{
    return (ale_scene_t){&p->map, p->observation, p->observation_count, p->velocity};
}

static void approach(ale_pipeline_t *p, ale_pose_t pose, int32_t reach_um)
{
    ale_local_map_approach(&p->map, (ale_point_t){pose.x_um, pose.y_um}, reach_um);
}

void ale_pipeline_match(ale_pipeline_t *p, const ale_motion_t *predicted, int32_t reach_um)
{
    const ale_scene_t scene = ale_pipeline_scene(p);
    approach(p, predicted->pose, reach_um);
    ale_register_scan(predicted, &scene, &acquire_gate, &p->fit);
}

/* What a good scan teaches about the wheels: their lag from turns, their scale from the way. drifted: by the
 * wheels, before this scan. */
static void teach_wheels(ale_pipeline_t *p, const ale_motion_t *before, const ale_wheel_motion_t *counted,
                         const ale_scale_error_t *drifted)
{
    const int64_t dt_us = p->motion.stamp_us - before->stamp_us;
    if (!p->config.use_odometry || dt_us <= 0 || dt_us > ALE_SCAN_PERIOD_MAX_US ||
        !ale_information_determines(&p->fit.information, LEARN_DETERMINED_UM)) {
        return;
    }
    const ale_pose_t way = ale_pose_between(before->pose, p->motion.pose);
    const ale_heading_t heading = {p->motion.stamp_us, p->motion.pose.theta_bam, p->motion.velocity[2]};
    ale_lag_add_heading(&p->lag, &heading);
    ale_lag_update(&p->lag, &p->wheels);
    if (counted && counted->lag_var_um2 < LEARN_LAG_VAR_UM2) {
        const ale_scale_error_t erred = {p->scale_error.x_um - drifted->x_um,
                                         p->scale_error.y_um - drifted->y_um};
        const ale_direction_t ahead = ale_direction(p->motion.pose.theta_bam);
        ale_wheel_scale_learn(&p->scale, way.x_um, counted->counted_um,
                              ale_scale_error_along(&erred, ahead.cos_q30, ahead.sin_q30));
    }
}

/* The scan goes into the map. */
static void take_in(ale_pipeline_t *p, bool grow)
{
    if (p->frozen) {
        return;
    }
    const ale_pose_t sensor = ale_pose_compose(p->fit.motion.pose, p->config.sensor);
    const ale_map_update_context_t context = {p->scans, &p->map_uncertainty, &p->scale_error,
                                              ale_zero_motion_dilution(&p->zero_motion), grow};
    ale_map_update(&p->map, p->observation, p->observation_count, &p->fit, &context);
    p->matched_corners = ale_map_corners_update(&p->map.corners, &p->features, sensor, p->scans, grow);
}

void ale_pipeline_first(ale_pipeline_t *p)
{
    ale_pipeline_match(p, &p->motion, p->scan.range_max_um);
    p->fit.motion = p->motion;
    ale_stage_end(&p->hook, ALE_STAGE_MATCH);
    take_in(p, true);
    p->started = p->observation_count > 0;
}

/* Asks the near walls that were not matched whether they are there; those that are not fade. */
static ale_visibility_counts_t look_around(ale_pipeline_t *p)
{
    const ale_pose_t sensor = ale_pose_compose(p->motion.pose, p->config.sensor);
    return ale_map_decay(&p->map_decay, &p->map, &p->scan, ale_pipeline_bearings(p), sensor, p->scans,
                         p->monitor.state == ALE_STATE_GOOD && !p->frozen);
}

/* A pose of the map on the way that is smooth, which no correction of the map bends. */
static ale_pose_t on_smooth_way(const ale_pipeline_t *p, const ale_motion_t *before, ale_pose_t pose)
{
    return ale_pose_compose(p->smooth.pose, ale_pose_between(before->pose, pose));
}

/* The scan at hand as the witness hears of it, if it was taken from a pose of the map. */
static ale_seen_t seen_from(const ale_pipeline_t *p, const ale_motion_t *before, ale_pose_t pose)
{
    const ale_pose_t robot = on_smooth_way(p, before, pose);
    return (ale_seen_t){.scan = &p->scan,
                        .bearing_bam = ale_pipeline_bearings(p),
                        .robot = robot,
                        .sensor = ale_pose_compose(robot, p->config.sensor),
                        .observation = p->observation,
                        .observation_count = p->observation_count};
}

/* What has come since the last scan, and was not there when it looked, is left out: it may go along with the
 * robot. */
static void leave_out_carried(ale_pipeline_t *p, ale_seen_t *now)
{
    const ale_seen_t before = ale_witness_seen(&p->witness);
    const ale_matrix_t *cov = &p->motion.cov;
    const bool known = 2 * ale_max64(ale_matrix_sigma(cov, 0), ale_matrix_sigma(cov, 1)) < SLACK_UM &&
                       2 * ale_matrix_sigma(cov, 2) < SLACK_URAD;
    if (before.observation_count > 0 && known) {
        p->observation_count =
            ale_carried_notice(&p->carried, &before, now, &p->scan, p->observation, p->fit.association);
        now->observation_count = p->observation_count;
    }
}

/* Hears the last scan when the map knows little of this one; a scan that fits is the next to be heard, one
 * that does not leaves the prediction as it is. One that showed nothing (the scanner is covered) could say
 * nothing of the next: the last that did is kept. */
static void notice(ale_pipeline_t *p, const ale_motion_t *before, const ale_motion_t *predicted, bool counted)
{
    ale_seen_t now = seen_from(p, before, p->motion.pose);
    const ale_matrix_t *cov = &p->motion.cov;
    const int64_t offset_um = SLACK_UM + 2 * ale_max64(ale_matrix_sigma(cov, 0), ale_matrix_sigma(cov, 1));
    const ale_slack_t slack = {
        (int32_t)ale_min64(offset_um, counted ? SLACK_MOST_UM : 2 * SLACK_UM),
        (int32_t)ale_min64(2 * ale_matrix_sigma(cov, 2), counted ? SLACK_MOST_URAD : SLACK_URAD), false};
    const bool doubt = ale_tracking_is_strange(&p->monitor, &p->fit);
    const ale_testimony_t heard = doubt ? ale_witness_hear(&p->witness, &now, slack) : (ale_testimony_t){0};
    ale_tracking_notice(&p->monitor, doubt ? &heard : NULL, counted, p->map.count > 0);
    if (p->monitor.jumped) {
        const ale_scene_t scene = ale_pipeline_scene(p);
        ale_register_reject(predicted, &scene, &p->fit);
        p->motion = *predicted;
        return;
    }
    if (!doubt) {
        leave_out_carried(p, &now);
    }
    ale_overview_keep(&p->overview, &now, p->motion.stamp_us);
    if (p->observation_count > 0) {
        ale_witness_keep(&p->witness, &now);
        p->witnessed = true;
        ale_carried_show(&p->carried, &p->witness.seen.scan);
    }
}

/* Where the scan shows enough, but too little of it is in the map to hold the pose, the map goes on from
 * here: new walls hold the robot as exactly as old ones, and how far they may be off is the drift they are
 * born with. */
static void anchor(ale_pipeline_t *p)
{
    if (ale_tracking_may_reanchor(&p->monitor, &p->fit)) {
        p->map_uncertainty = ale_map_uncertainty_inherit(&p->map_uncertainty, &p->fit.motion);
        ale_motion_widen(&p->fit.motion, ANCHOR_SIGMA_UM, ANCHOR_SIGMA_URAD);
        p->motion = p->fit.motion;
    }
}

/* Where nothing holds the robot, wheels outvote what the fit made of chance matches; without them it goes on
 * as it did: such matches go along with it and would stop it. */
static void keep_speed(ale_pipeline_t *p, const ale_observability_t *observability,
                       const ale_motion_t *before, const ale_motion_t *predicted, bool counted)
{
    const int64_t dt_us = predicted->stamp_us - before->stamp_us;
    const bool even =
        dt_us <= EVEN_US && ale_timestamp_filter_accepts(&p->timestamp_filter, dt_us) && !p->monitor.jumped;
    p->speed_known = observability->determined || (p->speed_known && even);
    if (observability->degenerate && p->speed_known && !counted) {
        ale_motion_keep_along(&p->fit.motion, predicted, observability->along_bam);
        p->motion = p->fit.motion;
    }
}

/* What the scan leaves open is said, and left to the prediction. */
static void observability(ale_pipeline_t *p, const ale_motion_t *before, const ale_motion_t *predicted,
                          bool counted)
{
    const ale_observability_t observability =
        ale_observability_of(&p->map, p->observation, p->observation_count, &p->fit);
    if (counted) {
        ale_scale_error_predict(&p->scale_error, before->pose, predicted->pose,
                                ale_wheel_scale_error_ppm(&p->scale));
    }
    ale_scale_error_update(&p->scale_error, &observability, predicted);
    p->determined = observability.determined;
    if (observability.determined) {
        p->drifted_um = 0;
    } else {
        ale_map_uncertainty_drift(&p->map_uncertainty, &p->drifted_um, observability.along_bam, before,
                                  predicted);
    }
    keep_speed(p, &observability, before, predicted, counted);
}

/* Where the last scan says that this one was taken, and how exactly. */
typedef struct {
    bool found;
    ale_pose_t pose;
    int64_t sigma_um;
    int64_t sigma_urad;
} ale_registered_t;

/* Where the last scan, or a better one shortly before it, says that the robot is, to be fitted from there;
 * where it says nothing, the prediction. */
static ale_registered_t register_scan(ale_pipeline_t *p, const ale_motion_t *before)
{
    const ale_motion_t *predicted = &p->ways.believed;
    const ale_matrix_t *cov = &predicted->cov;
    const ale_apart_t beyond =
        p->ways.part ? ale_apart(predicted->pose, p->ways.rival.pose) : (ale_apart_t){0, 0};
    const int64_t sigma_um = ale_max64(ale_matrix_sigma(cov, 0), ale_matrix_sigma(cov, 1));
    const int64_t sigma_urad = ale_matrix_sigma(cov, 2);
    const int64_t reach_um =
        ale_min64(REGISTER_UM + ale_max64(5 * sigma_um, beyond.way_um), REGISTER_MOST_UM);
    const int64_t reach_urad =
        ale_min64(REGISTER_URAD + ale_max64(5 * sigma_urad, beyond.turn_urad), REGISTER_MOST_URAD);
    /* on the way that is smooth, as the witness is */
    const ale_pose_t guess = on_smooth_way(p, before, predicted->pose);
    const ale_overview_t *overview = &p->overview;
    const bool richer =
        beyond.turn_urad < STRAIGHT_URAD &&
        ale_overview_is_richer(overview, p->witness.observation, p->witness.observation_count);
    const ale_observations_t then =
        richer ? (ale_observations_t){overview->observation, overview->observation_count}
               : (ale_observations_t){p->witness.observation, p->witness.observation_count};
    const ale_pose_t stood = richer ? overview->robot : p->witness.seen.robot;
    ale_pose_t way = ale_pose_between(stood, guess);
    if (!ale_match_scans(&p->scan_match, then, (ale_observations_t){p->observation, p->observation_count},
                         (int32_t)reach_um, (int32_t)reach_urad, &way)) {
        return (ale_registered_t){.pose = predicted->pose};
    }
    const ale_pose_t there = ale_pose_compose(stood, way);
    return (ale_registered_t){
        .found = true,
        .pose = ale_pose_compose(before->pose, ale_pose_between(p->smooth.pose, there)),
        .sigma_um = ale_max64(sigma_um, ale_scan_match_cell_um(reach_um)),
        .sigma_urad = ale_max64(sigma_urad, ale_scan_match_step_urad(reach_urad)),
    };
}

/* Whether the last scan confirms so much more of this one at the registered pose than where the map puts it
 * that what the map says was found by chance. */
static bool is_preferred(const ale_pipeline_t *p, const ale_motion_t *before,
                         const ale_registered_t *registered)
{
    const ale_slack_t slack = {SLACK_UM, 0, false};
    const ale_seen_t from_there = seen_from(p, before, registered->pose);
    const ale_seen_t from_here = seen_from(p, before, p->fit.motion.pose);
    const ale_testimony_t there = ale_witness_hear(&p->witness, &from_there, slack);
    const ale_testimony_t here = ale_witness_hear(&p->witness, &from_here, slack);
    return PREFER_PARTS * (there.confirmed_um - there.denied_um - (here.confirmed_um - here.denied_um)) >
           there.shown_um;
}

/* What the last scan says instead of the prediction. */
static ale_motion_t registered_motion(const ale_motion_t *predicted, const ale_registered_t *registered)
{
    ale_motion_t motion = *predicted;
    motion.pose = registered->pose;
    ale_motion_widen(&motion, registered->sigma_um, registered->sigma_urad);
    return motion;
}

/* The map explains too little of the scan: once more from where the last scan says that the robot is, or,
 * since wide gates may have caught the wrong walls, with narrow ones. If wheels may have slipped, the last
 * scan decides which way is believed; when it says nothing, the map does. What only little speaks for is
 * not believed. */
static void match_again(ale_pipeline_t *p, const ale_motion_t *before)
{
    const ale_scene_t scene = ale_pipeline_scene(p);
    const int64_t found_um = p->fit.matched_um;
    ale_ways_t *ways = &p->ways;
    const ale_registered_t registered = register_scan(p, before);
    const bool turns = ways->part && (!registered.found || ale_ways_rival_is_nearer(ways, registered.pose));
    const bool preferred = !turns && registered.found && ale_tracking_is_strange(&p->monitor, &p->fit) &&
                           is_preferred(p, before, &registered);
    if (preferred) {
        ways->believed = registered_motion(&ways->believed, &registered);
        p->fit.matched_um = 0; /* found by chance: the next fit takes its place, whatever it finds */
    }
    const ale_motion_t *prior = turns ? &ways->rival : &ways->believed;
    const ale_gate_t *unguided = turns ? &acquire_gate : &narrow_gate;
    const int32_t most_work = ALE_SCAN_WORK - ALE_BEAM_WORK * p->scan.beams;
    ale_register_again(prior, turns || preferred, registered.found ? registered.pose : prior->pose, &scene,
                       registered.found ? &register_gate : unguided, most_work, &p->other, &p->fit);
    if (turns && p->fit.matched_um > found_um) {
        ale_ways_swap(ways);
    }
    if (p->fit.matched_um * CHANCE_PARTS < p->fit.shown_um) {
        ale_register_reject(&ways->believed, &scene, &p->fit);
    }
}

/* What has come while the robot stood begins no wall. */
static void leave_out_newcomers(ale_pipeline_t *p, const ale_motion_t *before)
{
    const ale_seen_t now = seen_from(p, before, p->motion.pose);
    ale_zero_motion_update(&p->zero_motion, now.robot);
    p->observation_count =
        ale_elders_drop_newcomers(&p->elders, &p->map, &now, ale_zero_motion_is_long(&p->zero_motion),
                                  p->observation, p->fit.association);
    if (p->monitor.state == ALE_STATE_GOOD && !p->monitor.jumped) {
        ale_elders_keep(&p->elders, &now);
    }
}

void ale_pipeline_set_record_pose(ale_pipeline_t *p)
{
    if (p->witnessed) {
        const ale_pose_t robot = p->smooth.pose;
        ale_overview_stand(&p->overview, p->motion.stamp_us, robot);
        ale_witness_stand(&p->witness, robot, ale_pose_compose(robot, p->config.sensor));
    }
}

void ale_pipeline_track(ale_pipeline_t *p, const ale_motion_t *before, const ale_wheel_motion_t *wheels)
{
    const ale_scene_t scene = ale_pipeline_scene(p);
    const ale_motion_t *predicted = &p->ways.believed;
    p->witnessed = false;
    approach(p, predicted->pose, p->scan.range_max_um);
    ale_register_pose(predicted, &scene, &acquire_gate, &p->fit);
    ale_register_associate(&scene, &p->fit);
    if (ale_tracking_doubts(&p->fit)) {
        match_again(p, before);
    }
    ale_register_weigh(&scene, &p->fit);
    const bool counted = p->ways.counted;
    p->motion = p->fit.motion;
    notice(p, before, predicted, counted);
    p->map_uncertainty =
        ale_map_uncertainty_here(&p->map, p->observation, p->observation_count, &p->fit, &p->map_uncertainty);
    const ale_scale_error_t drifted = p->scale_error;
    observability(p, before, predicted, counted);
    if (!p->monitor.jumped) {
        ale_process_noise_learn(&p->process_noise[counted], predicted, &p->motion);
        teach_wheels(p, before, counted ? wheels : NULL, &drifted);
        p->slips = p->ways.part ? ale_ways_slip(&p->ways, p->motion.pose, p->slips) : p->slips;
    }
    ale_stage_end(&p->hook, ALE_STAGE_MATCH);
    anchor(p);
    leave_out_newcomers(p, before);
    take_in(p, ale_tracking_may_map(&p->monitor, &p->fit));
    approach(p, p->motion.pose, p->scan.range_max_um);
    const ale_visibility_counts_t visibility = look_around(p);
    ale_tracking_judge(&p->monitor, &p->fit, &visibility);
}
