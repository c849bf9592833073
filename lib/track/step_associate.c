#include "track/step_associate.h"

#include "base/fixed.h"
#include "match/pose_evidence.h"
#include "track/step_filter.h"
#include "track/step_observe.h"

enum {
    ACQUIRE_OFFSET_UM = 600000, /* how far a wall may lie from where the prediction puts it */
    ACQUIRE_ANGLE_URAD = 300000,
    ACQUIRE_SIGMAS = 4,
    ACQUIRE_SEGMENT_UM = 100000,
    REGISTER_UM = 100000, /* how far wheels may be off beyond what they promise */
    REGISTER_URAD = 60000,
    REGISTER_MOST_UM = 1000000,
    REGISTER_MOST_URAD = 450000,
    PREFER_PARTS = 5, /* of what two scans show of each other, by which one pose is preferred */
    CHANCE_PARTS = 10 /* less than this part of what is shown, found in the map, may be found by chance */
};

static const ale_gate_t acquire_gate = {ACQUIRE_OFFSET_UM, ACQUIRE_ANGLE_URAD, ACQUIRE_SIGMAS,
                                        ACQUIRE_SEGMENT_UM};
static const ale_gate_t narrow_gate = {60000, 200000, 4, 50000};
static const ale_gate_t register_gate = {250000, 200000, 6, 100000};

void ale_pipeline_approach(ale_pipeline_t *p, ale_pose_t pose, int32_t reach_um)
{
    ale_local_map_approach(&p->map, (ale_point_t){pose.x_um, pose.y_um}, reach_um);
}

void ale_pipeline_fit(ale_pipeline_t *p, const ale_motion_t *predicted, int32_t reach_um, ale_fit_t *fit)
{
    const ale_scene_t scene = ale_observed_scene(p);
    ale_pipeline_approach(p, predicted->pose, reach_um);
    ale_register_scan(predicted, &scene, &acquire_gate, fit);
}

/* Where the last scan says that this one was taken, and how exactly. */
typedef struct {
    bool found;
    ale_pose_t pose;
    int64_t sigma_um;
    int64_t sigma_urad;
} ale_registered_t;

/* Where the robot would be if it went on as before: as its velocity says or, where that is not known, by as
 * much as from scan to scan before. In a log that holds but some of the scans that says nothing, nor after a
 * time without scans. */
static ale_pose_t going_on(const ale_pipeline_t *p, const ale_prediction_t *prediction)
{
    const ale_ways_t *ways = &prediction->ways;
    const ale_pose_t before = prediction->before.pose;
    const bool by_wheels_alone = ways->counted && !ale_ways_rival_is_known(ways);
    const bool steps = by_wheels_alone && ale_timestamp_filter_is_dense(&p->timestamp_filter) &&
                       !ale_pipeline_is_gap(p, prediction->dt_us);
    const ale_pose_t one_step_on = steps ? ale_pose_compose(before, p->step) : ways->believed.pose;
    return ways->part ? ways->rival.pose : one_step_on;
}

/* Around the prediction, up to where the robot would be if it went on as before. Where the prediction is too
 * far from that, the last scan can at most say that it is wrong: then around where the robot would be. */
typedef struct {
    ale_pose_t centre;
    int32_t reach_um;
    int32_t reach_urad;
} window_t;

static window_t window_of(const ale_pipeline_t *p, const ale_prediction_t *prediction, int64_t sigma_um,
                          int64_t sigma_urad)
{
    const ale_pose_t predicted = prediction->ways.believed.pose;
    const ale_pose_t as_before = going_on(p, prediction);
    const ale_apart_t apart = ale_apart(predicted, as_before);
    const bool far = apart.way_um > REGISTER_MOST_UM || apart.turn_urad > REGISTER_MOST_URAD;
    const int64_t reach_um = REGISTER_UM + ale_max64(5 * sigma_um, far ? 0 : apart.way_um);
    const int64_t reach_urad = REGISTER_URAD + ale_max64(5 * sigma_urad, far ? 0 : apart.turn_urad);
    return (window_t){.centre = far ? as_before : predicted,
                      .reach_um = (int32_t)ale_min64(reach_um, REGISTER_MOST_UM),
                      .reach_urad = (int32_t)ale_min64(reach_urad, REGISTER_MOST_URAD)};
}

/* Where the last scan says that the robot is, to be fitted from there; where it says nothing, the
 * prediction. */
static ale_registered_t register_to_scan(ale_pipeline_t *p, const ale_prediction_t *prediction)
{
    const ale_motion_t *predicted = &prediction->ways.believed;
    const ale_pose_t before = prediction->before.pose;
    const int64_t sigma_um =
        ale_max64(ale_matrix_sigma(&predicted->cov, 0), ale_matrix_sigma(&predicted->cov, 1));
    const int64_t sigma_urad = ale_matrix_sigma(&predicted->cov, 2);
    const window_t window = window_of(p, prediction, sigma_um, sigma_urad);
    const ale_seen_t last = ale_witness_seen(&p->witness);
    const ale_observations_t then = {last.observation, last.observation_count};
    const ale_observations_t now = {p->observed.observation, p->observed.count};
    ale_pose_t displacement =
        ale_pose_between(last.robot, ale_pipeline_smooth_pose(p, before, window.centre));
    if (!ale_match_scans(&p->scan_match, then, now, window.reach_um, window.reach_urad, &displacement)) {
        return (ale_registered_t){.pose = predicted->pose};
    }
    const ale_pose_t smooth = ale_pose_compose(last.robot, displacement);
    return (ale_registered_t){
        .found = true,
        .pose = ale_pose_compose(before, ale_pose_between(p->smooth.pose, smooth)),
        .sigma_um = ale_max64(sigma_um, ale_scan_match_cell_um(window.reach_um)),
        .sigma_urad = ale_max64(sigma_urad, ale_scan_match_step_urad(window.reach_urad)),
    };
}

ale_testimony_t ale_step_testimony(const ale_pipeline_t *p, ale_pose_t before, ale_pose_t pose)
{
    const ale_slack_t slack = {ALE_WITNESS_SLACK_UM, 0, false};
    const ale_seen_t seen = ale_pipeline_seen_from(p, before, pose);
    return ale_witness_hear(&p->witness, &seen, slack);
}

/* Whether the last scan confirms so much more of this one at the registered pose than where the map puts it
 * that what the map says was found by chance. */
static bool is_preferred(const ale_pipeline_t *p, ale_pose_t before, ale_pose_t registered, ale_pose_t fitted)
{
    const ale_testimony_t there = ale_step_testimony(p, before, registered);
    const ale_testimony_t here = ale_step_testimony(p, before, fitted);
    return PREFER_PARTS * (there.confirmed_um - there.denied_um - (here.confirmed_um - here.denied_um)) >
           there.shown_um;
}

/* Whether so little of the scan is found in the map that it may be found by chance. */
static bool is_by_chance(const ale_fit_t *fit)
{
    return fit->matched_um * CHANCE_PARTS < fit->shown_um;
}

/* Whether the last scan says so of the other tale of the way, where the map says nothing. */
static bool is_rival_preferred(const ale_pipeline_t *p, const ale_prediction_t *prediction,
                               const ale_ways_t *ways, const ale_fit_t *fit)
{
    return is_by_chance(fit) &&
           is_preferred(p, prediction->before.pose, ways->rival.pose, ways->believed.pose);
}

/* What the last scan says instead of the prediction. */
static ale_motion_t registered_motion(const ale_motion_t *predicted, const ale_registered_t *registered)
{
    ale_motion_t motion = *predicted;
    motion.pose = registered->pose;
    ale_motion_widen(&motion, registered->sigma_um, registered->sigma_urad);
    return motion;
}

/* Of all fits of a scan. */
static int32_t most_work(const ale_pipeline_t *p)
{
    return ALE_SCAN_WORK - ALE_BEAM_WORK * p->observed.scan.beams;
}

/* From where, with which prediction, a scan is fitted a second time. */
typedef enum { FROM_SELECTED, FROM_ALTERNATIVE, FROM_LAST_SCAN } second_start_t;

static second_start_t second_start(const ale_pipeline_t *p, const ale_prediction_t *prediction,
                                   const ale_registered_t *registered, const ale_fit_t *fit)
{
    const ale_ways_t *ways = &prediction->ways;
    if (ways->part && (!registered->found || ale_ways_rival_is_nearer(ways, registered->pose))) {
        return FROM_ALTERNATIVE;
    }
    const bool preferred = registered->found && ale_tracking_is_strange(&p->monitor, fit) &&
                           is_preferred(p, prediction->before.pose, registered->pose, fit->motion.pose);
    return preferred ? FROM_LAST_SCAN : FROM_SELECTED;
}

/* Fits once more: from where the last scan says that the robot is or, since wide gates may have caught the
 * wrong walls, with narrow ones. If wheels may have slipped, the map decides which hypothesis is selected or,
 * where it holds nothing of the scan, the last scan. */
static void associate_again(ale_pipeline_t *p, const ale_prediction_t *prediction, ale_ways_t *ways,
                            ale_fit_t *fit)
{
    const ale_scene_t scene = ale_observed_scene(p);
    const ale_registered_t registered = register_to_scan(p, prediction);
    const second_start_t start = second_start(p, prediction, &registered, fit);
    const int64_t found_um = fit->matched_um;
    if (start == FROM_LAST_SCAN) {
        ways->believed = registered_motion(&ways->believed, &registered);
        fit->matched_um = 0; /* found by chance: the next fit takes its place, whatever it finds */
    }
    const bool turns = start == FROM_ALTERNATIVE;
    const ale_motion_t *prior = turns ? &ways->rival : &ways->believed;
    const ale_gate_t *unguided = turns ? &acquire_gate : &narrow_gate;
    const ale_second_fit_t second = {.predicted = prior,
                                     .is_new_prior = start != FROM_SELECTED,
                                     .start = registered.found ? registered.pose : prior->pose,
                                     .gate = registered.found ? &register_gate : unguided,
                                     .most_work = most_work(p)};
    ale_register_again(&scene, &second, &p->other, fit);
    if (turns && (fit->matched_um > found_um || is_rival_preferred(p, prediction, ways, fit))) {
        ale_ways_swap(ways);
    }
}

/* By how much more surface the other tale of the way must explain the scan: what either tale says against the
 * other is weighed. Wheels that are not believed say nothing. */
static int64_t rival_needs_um(const ale_ways_t *ways)
{
    const int64_t against_rival_um = ale_pose_against_um(&ways->believed, ways->rival.pose);
    const int64_t against_wheels_um =
        ways->counted ? ale_pose_against_um(&ways->rival, ways->believed.pose) : 0;
    return ale_max64(against_rival_um - against_wheels_um, 0);
}

/* Fits from the other tale of the way where it may explain enough, and believes it if it does: a scan that is
 * put beside the walls that tell how far it has come does not find them, and says nothing of it. */
static void hear_rival(ale_pipeline_t *p, ale_ways_t *ways, ale_fit_t *fit)
{
    if (!ways->part) {
        return;
    }
    const int64_t needs_um = rival_needs_um(ways);
    const int64_t unexplained_um = fit->shown_um - fit->matched_um;
    if (unexplained_um <= needs_um) {
        return;
    }
    const ale_scene_t scene = ale_observed_scene(p);
    const ale_second_fit_t second = {.predicted = &ways->rival,
                                     .is_new_prior = true,
                                     .start = ways->rival.pose,
                                     .gate = &acquire_gate,
                                     .most_work = most_work(p),
                                     .least_more_um = needs_um + 1};
    if (ale_register_again(&scene, &second, &p->other, fit)) {
        ale_ways_swap(ways);
    }
}

ale_ways_t ale_step_associate(ale_pipeline_t *p, const ale_prediction_t *prediction, ale_fit_t *fit)
{
    const ale_scene_t scene = ale_observed_scene(p);
    ale_ways_t ways = prediction->ways;
    ale_pipeline_approach(p, ways.believed.pose, p->observed.scan.range_max_um);
    ale_register_pose(&ways.believed, &scene, &acquire_gate, fit);
    ale_register_associate(&scene, fit);
    if (ale_tracking_doubts(fit)) {
        associate_again(p, prediction, &ways, fit);
        if (is_by_chance(fit)) {
            ale_register_reject(&ways.believed, &scene, fit);
        }
    } else {
        hear_rival(p, &ways, fit);
    }
    return ways;
}

void ale_step_solve(ale_pipeline_t *p, ale_fit_t *fit)
{
    const ale_scene_t scene = ale_observed_scene(p);
    ale_register_weigh(&scene, fit);
}
