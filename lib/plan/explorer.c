#include "plan/explorer.h"

#include "base/fixed.h"
#include "base/trig.h"
#include "motion/deskew.h"
#include "plan/safe_speed.h"

/* Counted in scans, ten a second. */
enum { PLAN_EVERY = 5, STALL_STEPS = 80, STUCK_STEPS = 10, BACKING_STEPS = 15 };
enum { SURE_NO_WAY = 10 }; /* plans: walls of the map that are gone have been seen through by then */
enum { SURE_PLANS = 4, COMFORT_CM = 15, UM_PER_CM = 10000 };
#define LOOKAHEAD_UM 700000
#define TIGHT_AHEAD_UM 400000
#define PROGRESS_UM 100000
#define HOME_UM 20000
#define HOME_NEAR_UM 400000
enum { HOME_NEAR_CELLS = HOME_NEAR_UM / ALE_GRID_CELL_UM };
#define HOME_TURN_BAM (INT64_C(3) * ALE_BAM_PER_DEGREE)
#define LONGEST_AHEAD_US 500000
#define SLOWEST_UM_S 5000
#define SLOWEST_URAD_S 50000

static const ale_velocity_t standing = {0, 0};

ale_explorer_config_t ale_explorer_default_config(void)
{
    const ale_explorer_config_t config = {
        .follower = {.shape = ale_robot_shape_default(), .speed_um_s = 400000, .turn_urad_s = 800000},
        .clearance_um = 50000};
    return config;
}

static int32_t centimetres(int64_t um)
{
    return (int32_t)((um + UM_PER_CM - 1) / UM_PER_CM);
}

void ale_explorer_init(ale_explorer_t *explorer, const ale_explorer_config_t *config)
{
    explorer->config = *config;
    explorer->state = ALE_EXPLORER_OFF;
}

bool ale_explorer_is_active(const ale_explorer_t *explorer)
{
    switch (explorer->state) {
    case ALE_EXPLORER_OFF:
    case ALE_EXPLORER_FINISHED:
    case ALE_EXPLORER_ARRIVED:
    case ALE_EXPLORER_GIVEN_UP:
        return false;
    case ALE_EXPLORER_EXPLORING:
    case ALE_EXPLORER_RETURNING:
    case ALE_EXPLORER_TURNING:
    case ALE_EXPLORER_BLOCKED:
    case ALE_EXPLORER_GOING:
        break;
    }
    return true;
}

static bool is_going(const ale_explorer_t *explorer)
{
    return explorer->state == ALE_EXPLORER_GOING;
}

void ale_explorer_request(ale_explorer_t *explorer, bool on)
{
    if (!on) {
        explorer->state = ALE_EXPLORER_OFF;
    } else if (!ale_explorer_is_active(explorer) || is_going(explorer)) {
        explorer->state = ALE_EXPLORER_EXPLORING;
        explorer->begun = false;
        explorer->walls.count = 0;
        ale_wander_begin(&explorer->wander);
    }
}

void ale_explorer_go(ale_explorer_t *explorer, ale_point_t place, const ale_map_t *map)
{
    ale_plan_walls_t *walls = &explorer->walls;
    walls->count = map ? map->line_count : 0;
    for (uint16_t k = 0; k < walls->count; k++) {
        walls->start[k] = map->line[k].start;
        walls->end[k] = map->line[k].end;
        walls->map_id[k] = map->line[k].map_id;
    }
    explorer->state = ALE_EXPLORER_GOING;
    explorer->begun = false;
    explorer->home = (ale_pose_t){place.x_um, place.y_um, 0};
    explorer->steps_without_progress = 0;
}

static void give_up(ale_explorer_t *explorer, ale_given_up_t why)
{
    explorer->state = ALE_EXPLORER_GIVEN_UP;
    explorer->why = why;
    explorer->steps_without_progress = 0;
    explorer->route.count = 0;
}

/* Those of other maps have nothing to do with where the robot is. */
static void draw_walls(ale_explorer_t *explorer)
{
    const ale_plan_walls_t *walls = &explorer->walls;
    for (uint16_t k = 0; k < walls->count; k++) {
        if (walls->map_id[k] == explorer->map_id) {
            ale_grid_add_wall(&explorer->grid, walls->start[k], walls->end[k]);
        }
    }
}

static void note_progress(ale_explorer_t *explorer)
{
    explorer->progress_at = (ale_point_t){explorer->pose.x_um, explorer->pose.y_um};
    explorer->steps_without_progress = 0;
}

static ale_point_t half_way(ale_point_t a, ale_point_t b)
{
    return (ale_point_t){(int32_t)(((int64_t)a.x_um + b.x_um) / 2),
                         (int32_t)(((int64_t)a.y_um + b.y_um) / 2)};
}

static void begin(ale_explorer_t *explorer, const ale_estimate_t *estimate)
{
    const ale_pose_t pose = estimate->map;
    const ale_robot_shape_t *shape = &explorer->config.follower.shape;
    const int32_t radius_um = shape->width_um / 2;
    const int32_t body_cm =
        centimetres((int64_t)radius_um + shape->margin_um + explorer->config.clearance_um);
    const ale_planner_config_t planner = {.body_cm = body_cm,
                                          .tight_cm = centimetres((int64_t)radius_um + shape->margin_um),
                                          .squeeze_cm = centimetres(radius_um),
                                          .comfort_cm = body_cm + COMFORT_CM,
                                          .see_cm = centimetres(radius_um)};
    explorer->map_id = estimate->map_id;
    if (is_going(explorer)) {
        ale_grid_init(&explorer->grid, half_way((ale_point_t){pose.x_um, pose.y_um},
                                                (ale_point_t){explorer->home.x_um, explorer->home.y_um}));
        draw_walls(explorer);
    } else {
        ale_grid_init(&explorer->grid, (ale_point_t){pose.x_um, pose.y_um});
        explorer->state = ALE_EXPLORER_EXPLORING;
        explorer->home = pose;
    }
    ale_planner_init(&explorer->planner, &planner);
    ale_kept_scans_clear(&explorer->kept);
    explorer->epoch = estimate->epoch;
    explorer->home_scan = estimate->scan;
    explorer->pose = pose;
    explorer->route.count = 0;
    explorer->goal = ALE_GRID_NONE;
    explorer->steps_since_plan = PLAN_EVERY;
    explorer->plans_without_goal = 0;
    explorer->steps_stuck = 0;
    explorer->steps_back = 0;
    explorer->begun = true;
    note_progress(explorer);
}

/* What was seen completely may have gaps now that its parts lie where they belong. */
static void draw_again(ale_explorer_t *explorer)
{
    const ale_follower_t *follower = &explorer->config.follower;
    draw_walls(explorer);
    ale_kept_scans_draw(&explorer->kept, follower->sensor, follower->shape.width_um / 2, &explorer->grid,
                        &explorer->straightened);
    explorer->state = is_going(explorer) ? ALE_EXPLORER_GOING : ALE_EXPLORER_EXPLORING;
    explorer->goal = ALE_GRID_NONE;
    explorer->route.count = 0;
    explorer->plans_without_goal = 0;
    explorer->steps_since_plan = PLAN_EVERY;
}

/* A building that lies to one side of the start: the square moves to where what has been seen is. */
static void make_room(ale_explorer_t *explorer)
{
    ale_point_t middle;
    if (!is_going(explorer) && ale_grid_is_cramped(&explorer->grid, &middle)) {
        const ale_point_t corner = explorer->grid.corner;
        ale_grid_init(&explorer->grid, middle);
        ale_planner_move(&explorer->planner, &explorer->grid, corner);
        draw_again(explorer);
    }
}

static void velocity_per_tick(const ale_estimate_t *estimate, int32_t out[ALE_AXES])
{
    out[0] = (int32_t)ale_round_div(estimate->velocity_x_um_s * ALE_TICK_US, 1000000);
    out[1] = (int32_t)ale_round_div(estimate->velocity_y_um_s * ALE_TICK_US, 1000000);
    out[2] = (int32_t)ale_round_div(estimate->velocity_theta_urad_s * ALE_TICK_US, 1000000);
}

static void add_scan(ale_explorer_t *explorer, const ale_scan_t *scan, const ale_estimate_t *estimate)
{
    const ale_follower_t *follower = &explorer->config.follower;
    int32_t robot_velocity[ALE_AXES];
    int32_t sensor_velocity[ALE_AXES];
    velocity_per_tick(estimate, robot_velocity);
    ale_sensor_velocity(robot_velocity, follower->sensor, sensor_velocity);
    ale_straight_scan_t *straight = &explorer->straightened;
    straight->scan = *scan;
    if (!ale_deskew(&straight->scan, sensor_velocity, straight->bearing_bam)) {
        for (int32_t k = 0; k < scan->beams; k++) {
            straight->bearing_bam[k] = ale_scan_bearing(scan, k);
        }
    }
    const ale_pose_t sensor = ale_pose_compose(estimate->map, follower->sensor);
    ale_grid_add_scan(&explorer->grid, &straight->scan, straight->bearing_bam, sensor);
    ale_kept_scans_offer(&explorer->kept, estimate->scan, &straight->scan, straight->bearing_bam,
                         estimate->map);
    ale_grid_add_disc(&explorer->grid, (ale_point_t){estimate->map.x_um, estimate->map.y_um},
                      follower->shape.width_um / 2);
}

static void predict_pose(ale_explorer_t *explorer, const ale_estimate_t *estimate, int64_t now_us)
{
    int32_t velocity[ALE_AXES];
    velocity_per_tick(estimate, velocity);
    const int64_t ahead_us = ale_clamp64(now_us - estimate->stamp_us, 0, LONGEST_AHEAD_US);
    explorer->pose = ale_pose_compose(estimate->map, ale_motion_sweep(velocity, ahead_us));
}

/* Where the path ahead stays closed although the map says it is open, a step back shows more of it. */
static ale_velocity_t back_off(ale_explorer_t *explorer, ale_velocity_t wanted, const ale_scan_t *scan)
{
    const ale_follower_t *follower = &explorer->config.follower;
    const bool stands = wanted.speed_um_s < SLOWEST_UM_S && ale_abs64(wanted.turn_urad_s) < SLOWEST_URAD_S;
    explorer->steps_stuck = stands ? explorer->steps_stuck + 1 : 0;
    if (explorer->steps_stuck > STUCK_STEPS) {
        explorer->steps_stuck = 0;
        explorer->steps_back = BACKING_STEPS;
    }
    if (explorer->steps_back == 0) {
        return wanted;
    }
    explorer->steps_back--;
    const int32_t back_um_s =
        ale_safe_speed_um_s(scan, &follower->sensor, &follower->shape, -follower->shape.blind_um_s, 0);
    return (ale_velocity_t){back_um_s, 0};
}

static int64_t distance_um(ale_point_t a, ale_point_t b)
{
    const int64_t dx = (int64_t)a.x_um - b.x_um;
    const int64_t dy = (int64_t)a.y_um - b.y_um;
    return ale_isqrt((uint64_t)(dx * dx + dy * dy));
}

/* Noise may close a path for a moment: that nothing is left must be found several times. */
static void plan_exploring(ale_explorer_t *explorer, ale_point_t robot)
{
    if (ale_planner_explore(&explorer->planner, &explorer->grid, robot, explorer->goal, &explorer->route)) {
        explorer->goal = explorer->route.goal;
        explorer->plans_without_goal = 0;
        return;
    }
    explorer->goal = ALE_GRID_NONE;
    explorer->plans_without_goal++;
    if (explorer->plans_without_goal >= SURE_PLANS) {
        explorer->state = ALE_EXPLORER_RETURNING;
        note_progress(explorer);
    }
}

static ale_given_up_t reason_for_no_way(const ale_explorer_t *explorer)
{
    const ale_point_t place = {explorer->home.x_um, explorer->home.y_um};
    if (ale_grid_cell(&explorer->grid, place) == ALE_GRID_NONE) {
        return ALE_GIVEN_UP_FAR;
    }
    return ale_planner_has_room(&explorer->planner, &explorer->grid, place) ? ALE_GIVEN_UP_CLOSED
                                                                            : ALE_GIVEN_UP_TAKEN;
}

/* As with exploring: several times, one scan after the other. */
static void plan_going(ale_explorer_t *explorer, ale_point_t robot)
{
    const ale_point_t place = {explorer->home.x_um, explorer->home.y_um};
    if (ale_planner_venture(&explorer->planner, &explorer->grid, robot, place, &explorer->route)) {
        explorer->plans_without_goal = 0;
        return;
    }
    explorer->plans_without_goal++;
    explorer->steps_since_plan = PLAN_EVERY;
    if (explorer->plans_without_goal >= SURE_NO_WAY) {
        give_up(explorer, reason_for_no_way(explorer));
    }
}

static void plan(ale_explorer_t *explorer)
{
    const ale_point_t robot = {explorer->pose.x_um, explorer->pose.y_um};
    explorer->steps_since_plan = 0;
    ale_planner_update(&explorer->planner, &explorer->grid);
    if (is_going(explorer)) {
        plan_going(explorer, robot);
        return;
    }
    if (explorer->state == ALE_EXPLORER_EXPLORING) {
        plan_exploring(explorer, robot);
    }
    if (explorer->state == ALE_EXPLORER_RETURNING || explorer->state == ALE_EXPLORER_BLOCKED) {
        const ale_point_t home = {explorer->home.x_um, explorer->home.y_um};
        const bool open = ale_planner_go(&explorer->planner, &explorer->grid, robot, home, &explorer->route);
        explorer->state = open ? ALE_EXPLORER_RETURNING : ALE_EXPLORER_BLOCKED;
    }
}

/* A robot without progress gives its goal up; on the way home it plans the path anew and is BLOCKED. */
static void watch_progress(ale_explorer_t *explorer)
{
    const ale_point_t robot = {explorer->pose.x_um, explorer->pose.y_um};
    explorer->steps_without_progress++;
    if (distance_um(robot, explorer->progress_at) > PROGRESS_UM) {
        note_progress(explorer);
    } else if (explorer->steps_without_progress > STALL_STEPS && is_going(explorer)) {
        give_up(explorer, ALE_GIVEN_UP_STUCK);
    } else if (explorer->steps_without_progress > STALL_STEPS) {
        const bool exploring = explorer->state == ALE_EXPLORER_EXPLORING;
        const bool given_up = exploring && explorer->goal != ALE_GRID_NONE &&
                              ale_planner_refuse(&explorer->planner, explorer->goal, explorer->scan);
        explorer->state =
            given_up ? ALE_EXPLORER_EXPLORING : (exploring ? ALE_EXPLORER_RETURNING : ALE_EXPLORER_BLOCKED);
        explorer->goal = ALE_GRID_NONE;
        explorer->steps_since_plan = PLAN_EVERY;
        note_progress(explorer);
    }
}

static ale_velocity_t drive_route(ale_explorer_t *explorer, const ale_scan_t *scan)
{
    const ale_point_t robot = {explorer->pose.x_um, explorer->pose.y_um};
    if (explorer->route.count == 0) {
        return standing;
    }
    const ale_point_t lookahead =
        ale_planner_lookahead(&explorer->planner, &explorer->grid, &explorer->route, robot, LOOKAHEAD_UM);
    const int64_t path_um = ale_max64((int64_t)explorer->route.cost * UM_PER_CM, ALE_GRID_CELL_UM);
    ale_follower_t follower = explorer->config.follower;
    if (ale_planner_is_tight(&explorer->planner, &explorer->route, TIGHT_AHEAD_UM)) {
        follower.speed_um_s = (int32_t)ale_min64(follower.speed_um_s, follower.shape.blind_um_s);
    }
    return back_off(explorer, ale_follow(&follower, explorer->pose, lookahead, path_um, scan), scan);
}

static ale_velocity_t drive_home(ale_explorer_t *explorer, const ale_scan_t *scan)
{
    const ale_point_t robot = {explorer->pose.x_um, explorer->pose.y_um};
    const ale_point_t home = {explorer->home.x_um, explorer->home.y_um};
    const int64_t left_um = distance_um(robot, home);
    if (left_um <= HOME_UM) {
        explorer->state = is_going(explorer) ? ALE_EXPLORER_ARRIVED : ALE_EXPLORER_TURNING;
        return standing;
    }
    if (left_um > HOME_NEAR_UM || explorer->route.count > HOME_NEAR_CELLS) {
        return drive_route(explorer, scan);
    }
    return ale_follow(&explorer->config.follower, explorer->pose, home, left_um, scan);
}

static ale_velocity_t turn_home(ale_explorer_t *explorer)
{
    const uint32_t wanted_bam = explorer->home.theta_bam;
    if (ale_abs64(ale_bam_diff(wanted_bam, explorer->pose.theta_bam)) <= HOME_TURN_BAM) {
        explorer->state = ALE_EXPLORER_FINISHED;
        return standing;
    }
    const int32_t turn = ale_turn_towards(&explorer->config.follower, explorer->pose.theta_bam, wanted_bam);
    return (ale_velocity_t){0, turn};
}

static ale_velocity_t drive(ale_explorer_t *explorer, const ale_scan_t *scan)
{
    switch (explorer->state) {
    case ALE_EXPLORER_EXPLORING:
        return drive_route(explorer, scan);
    case ALE_EXPLORER_RETURNING:
    case ALE_EXPLORER_GOING:
        return drive_home(explorer, scan);
    case ALE_EXPLORER_TURNING:
        return turn_home(explorer);
    case ALE_EXPLORER_OFF:
    case ALE_EXPLORER_FINISHED:
    case ALE_EXPLORER_BLOCKED:
    case ALE_EXPLORER_ARRIVED:
    case ALE_EXPLORER_GIVEN_UP:
        break;
    }
    return standing;
}

void ale_explorer_correct(ale_explorer_t *explorer, const ale_correction_t *correction)
{
    if (!ale_explorer_is_active(explorer) || !explorer->begun || correction->epoch != explorer->epoch) {
        return;
    }
    const ale_pose_t shift = ale_correction_at(correction, explorer->scan);
    if (!is_going(explorer)) {
        explorer->home = ale_pose_compose(ale_correction_at(correction, explorer->home_scan), explorer->home);
    }
    explorer->progress_at = ale_pose_apply(shift, explorer->progress_at);
    explorer->pose = ale_pose_compose(shift, explorer->pose);
    ale_planner_correct(&explorer->planner, &explorer->grid, correction);
    if (ale_kept_scans_correct(&explorer->kept, correction)) {
        ale_grid_clear(&explorer->grid);
        draw_again(explorer);
    }
}

/* Where it will be then, nobody knows: the path is planned anew. */
static ale_velocity_t move_while_lost(ale_explorer_t *explorer, const ale_scan_t *scan)
{
    explorer->steps_since_plan = PLAN_EVERY;
    explorer->steps_stuck = 0;
    explorer->steps_back = 0;
    note_progress(explorer);
    return ale_wander_step(&explorer->wander, &explorer->config.follower, scan);
}

/* On the way to a place: before it began, and for some seconds, it may come back by itself. */
static ale_velocity_t stand_while_lost(ale_explorer_t *explorer)
{
    explorer->steps_without_progress++;
    if (!explorer->begun || explorer->steps_without_progress > STALL_STEPS) {
        give_up(explorer, ALE_GIVEN_UP_LOST);
    }
    explorer->steps_since_plan = PLAN_EVERY;
    return standing;
}

ale_velocity_t ale_explorer_step(ale_explorer_t *explorer, const ale_scan_t *scan,
                                 const ale_estimate_t *estimate, int64_t now_us)
{
    if (!ale_explorer_is_active(explorer)) {
        return standing;
    }
    if (estimate->state == ALE_STATE_LOST) {
        return is_going(explorer) ? stand_while_lost(explorer) : move_while_lost(explorer, scan);
    }
    ale_wander_begin(&explorer->wander);
    if (is_going(explorer) && explorer->begun &&
        (estimate->epoch != explorer->epoch || estimate->map_id != explorer->map_id)) {
        give_up(explorer, ALE_GIVEN_UP_MAP);
        return standing;
    }
    if (!explorer->begun || estimate->epoch != explorer->epoch) {
        begin(explorer, estimate);
    }
    explorer->scan = estimate->scan;
    if (!estimate->predicted) {
        add_scan(explorer, scan, estimate);
        make_room(explorer);
    }
    predict_pose(explorer, estimate, now_us);
    explorer->steps_since_plan++;
    if (explorer->steps_since_plan >= PLAN_EVERY) {
        plan(explorer);
    }
    watch_progress(explorer);
    return drive(explorer, scan);
}
