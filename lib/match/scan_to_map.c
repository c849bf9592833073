#include "match/scan_to_map.h"

#include <stddef.h>
#include <string.h>

#include "base/fixed.h"
#include "base/trig.h"
#include "motion/ratio.h"

enum {
    CONVERGED_UM = 30, /* a step below this (um, urad) ends the iterations */
    HUBER_SIGMAS = 2,
    LATER_SIGMAS = 4, /* gates of the later iterations */
    LATER_OFFSET_UM = 60000,
    LATER_ANGLE_URAD = 200000,
    LATER_SEGMENT_UM = 50000,
    LANDMARK_PASSING_UM2 = 400000000, /* (20 mm)^2 more of one that is not confirmed: of somebody who walks */
    SEGMENT_ANGLE_URAD = 600000,      /* a short segment hardly has a direction */
    FOCUS_MARGIN_UM = 2000000
};

static const ale_information_t no_information = {{{{0}}}, {0}};
static const ale_gate_t later = {LATER_OFFSET_UM, LATER_ANGLE_URAD, LATER_SIGMAS, LATER_SEGMENT_UM};

static int64_t ticks_q20(int64_t time_us)
{
    return ale_round_shift(time_us * (1 << 20), ALE_TICK_BITS);
}

/* Time at the observation's centre, and how it grows along the wall (ticks per metre), Q20. */
static void observation_time(const ale_observation_t *v, int64_t *centre_q20, int64_t *slope_q20)
{
    const int64_t length_um = ale_max64(ale_observation_length_um(v), 10000);
    const int64_t start = ticks_q20(v->start_time_us);
    const int64_t growth = ticks_q20(v->end_time_us) - start;
    *centre_q20 = start + ale_round_div(growth * -v->start_um, length_um);
    *slope_q20 = ale_round_div(growth * 1000000, length_um);
}

void ale_observation_rows(const ale_observation_t *observation, uint32_t pose_theta_bam,
                          uint32_t wall_normal_bam, ale_observation_rows_t *out)
{
    const uint32_t normal_bam = wall_normal_bam - pose_theta_bam;
    const ale_direction_t normal = ale_direction(normal_bam);
    const int64_t nx = ale_round_shift(normal.cos_q30, 16);
    const int64_t ny = ale_round_shift(normal.sin_q30, 16);
    const int64_t lever = ale_round_div(
        (int64_t)observation->centre.x_um * ny - (int64_t)observation->centre.y_um * nx, 1000000);
    int64_t time;
    int64_t slope;
    observation_time(observation, &time, &slope);
    const int64_t offset[3] = {nx, ny, lever};
    for (int i = 0; i < 3; i++) {
        out->offset_row_q14[i] = offset[i];
        out->offset_row_q14[i + 3] = ale_round_shift(offset[i] * time, 20);
        out->angle_row_q14[i] = i == 2 ? 1 << ALE_ROW_BITS : 0;
        out->angle_row_q14[i + 3] = ale_round_shift(offset[i] * slope, 20);
    }
    out->angle_row_q14[5] += ale_round_shift(time, 20 - ALE_ROW_BITS);
}

/* Errors as they are with the velocity found so far: the scan was straightened with another. */
static void correct_for_velocity(const ale_observation_rows_t *rows, const int64_t change[3],
                                 ale_wall_error_t *e)
{
    for (int i = 0; i < 3; i++) {
        if (change[i] == 0) {
            continue;
        }
        e->offset_um += ale_mul_shift(rows->offset_row_q14[i + 3], change[i], ALE_ROW_BITS);
        e->angle_urad += ale_mul_shift(rows->angle_row_q14[i + 3], change[i], ALE_ROW_BITS);
    }
}

/* Huber: beyond two sigmas an error counts as if its variance grew with it. */
static int64_t robust_var(int64_t error, int64_t var)
{
    const int64_t limit = (int64_t)HUBER_SIGMAS * ale_isqrt((uint64_t)var);
    const int64_t size = ale_abs64(error);
    return size <= limit ? var : var / ale_max64(limit, 1) * size;
}

/* Two rows: the offset, and the angle freed of what the wall's own error shares between them. */
static void add_rows(const ale_observation_t *observation, const ale_wall_t *wall,
                     const ale_observation_rows_t *rows, const ale_wall_error_t *e, ale_information_t *sum)
{
    const int64_t var_offset = ale_wall_offset_var(wall, e->t_um) + observation->var_offset_um2;
    const int64_t shared = ale_wall_offset_angle_cov(wall, e->t_um);
    const int64_t part_q30 = ale_ratio_q30(shared, var_offset);
    const int64_t var_angle =
        wall->var_angle_urad2 + observation->var_angle_urad2 - ale_mul_shift(part_q30, shared, 30);
    const int64_t rest_urad = e->angle_urad - ale_mul_shift(part_q30, e->offset_um, 30);
    int64_t rest_row[ALE_STATES];
    for (int i = 0; i < ALE_STATES; i++) {
        rest_row[i] = rows->angle_row_q14[i] - ale_mul_shift(part_q30, rows->offset_row_q14[i], 30);
    }
    ale_information_add(sum, rows->offset_row_q14, e->offset_um, robust_var(e->offset_um, var_offset));
    ale_information_add(sum, rest_row, rest_urad, robust_var(rest_urad, var_angle));
}

/* A landmark: the offset along its normal, for a point feature also the one across. */
static void add_landmark_rows(const ale_observation_t *observation, const ale_landmark_t *landmark,
                              uint32_t theta_bam, const int64_t change[3], ale_association_t *association,
                              ale_information_t *sum)
{
    ale_observation_rows_t rows;
    const int64_t passing = landmark->seen < ALE_LANDMARK_CONFIRMED ? LANDMARK_PASSING_UM2 : 0;
    const int64_t var = observation->var_offset_um2 + landmark->var_um2 + passing;
    ale_observation_rows(observation, theta_bam, landmark->normal_bam, &rows);
    correct_for_velocity(&rows, change, &association->error);
    ale_information_add(sum, rows.offset_row_q14, association->error.offset_um,
                        robust_var(association->error.offset_um, var));
    if (observation->kind == ALE_OBSERVATION_POINT && landmark->is_point) {
        const int64_t width_um = ale_observation_length_um(observation);
        const int64_t var_across = var + width_um * width_um / 12;
        ale_wall_error_t across = {.offset_um = association->error.t_um};
        ale_observation_rows(observation, theta_bam, ale_tangent_bam(landmark->normal_bam), &rows);
        correct_for_velocity(&rows, change, &across);
        ale_information_add(sum, rows.offset_row_q14, across.offset_um,
                            robust_var(across.offset_um, var_across));
    }
}

static void add_wall_rows(const ale_observation_t *observation, const ale_wall_t *wall, ale_fit_t *fit,
                          ale_association_t *association)
{
    ale_observation_rows_t rows;
    ale_observation_rows(observation, fit->motion.pose.theta_bam, wall->normal_bam, &rows);
    correct_for_velocity(&rows, fit->velocity_change, &association->error);
    add_rows(observation, wall, &rows, &association->error, &fit->information);
}

static ale_association_t find(const ale_scene_t *scene, const ale_observation_t *observation,
                              const ale_viewpoint_t *viewpoint, const ale_matrix_t *cov,
                              const ale_gate_t *gate, int32_t *work)
{
    if (observation->kind == ALE_OBSERVATION_LINE) {
        const ale_association_t wall = ale_associate(scene->map, observation, viewpoint, cov, gate, work);
        const bool found =
            wall.wall != ALE_NO_WALL || ale_observation_length_um(observation) >= ALE_WALL_LENGTH_UM;
        return found ? wall : ale_associate_landmark(scene->map, observation, viewpoint, gate->segment_um);
    }
    const ale_gate_t segment_gate = {gate->segment_um, SEGMENT_ANGLE_URAD, gate->sigmas, 0};
    const ale_association_t association =
        observation->kind == ALE_OBSERVATION_SEGMENT
            ? ale_associate(scene->map, observation, viewpoint, cov, &segment_gate, work)
            : (ale_association_t){.wall = ALE_NO_WALL};
    return association.wall != ALE_NO_WALL
               ? association
               : ale_associate_landmark(scene->map, observation, viewpoint, gate->segment_um);
}

static void clear(ale_fit_t *fit)
{
    fit->matched = 0;
    fit->matched_segments = 0;
    fit->matched_um = 0;
    fit->shown_um = 0;
}

/* Associates every observation at the pose of fit->motion. */
static void find_all(const ale_scene_t *scene, const ale_matrix_t *cov, const ale_gate_t *gate,
                     ale_fit_t *fit)
{
    const ale_viewpoint_t viewpoint = ale_viewpoint(fit->motion.pose);
    int32_t work = ALE_ASSOCIATION_WORK;
    clear(fit);
    for (uint32_t i = 0; i < scene->observation_count; i++) {
        const ale_observation_t *observation = &scene->observation[i];
        ale_association_t *association = &fit->association[i];
        const int64_t length_um = ale_observation_length_um(observation);
        work -= ALE_OBSERVATION_WORK;
        *association = work < 0 ? (ale_association_t){.wall = ALE_NO_WALL, .landmark = ALE_NO_LANDMARK}
                                : find(scene, observation, &viewpoint, cov, gate, &work);
        fit->shown_um += length_um;
        if (association->wall != ALE_NO_WALL || association->landmark != ALE_NO_LANDMARK) {
            fit->matched_um += length_um;
            fit->matched = (uint16_t)(fit->matched + (observation->kind == ALE_OBSERVATION_LINE));
            fit->matched_segments =
                (uint16_t)(fit->matched_segments + (observation->kind != ALE_OBSERVATION_LINE));
        }
    }
    fit->work += ALE_ASSOCIATION_WORK - (work < 0 ? 0 : work);
}

/* The rows of all associations. */
static void add_all(const ale_scene_t *scene, ale_fit_t *fit)
{
    fit->information = no_information;
    for (uint32_t i = 0; i < scene->observation_count; i++) {
        ale_association_t *association = &fit->association[i];
        if (association->wall != ALE_NO_WALL) {
            add_wall_rows(&scene->observation[i], &scene->map->wall[association->wall], fit, association);
        } else if (association->landmark != ALE_NO_LANDMARK) {
            add_landmark_rows(&scene->observation[i], &scene->map->landmarks.landmark[association->landmark],
                              fit->motion.pose.theta_bam, fit->velocity_change, association,
                              &fit->information);
        }
    }
}

/* The covariance after a step: the gates of the next pass ask for it, and whoever keeps the fit. */
static void find_covariance(ale_fit_t *fit)
{
    ale_matrix_invert(&fit->factors, ALE_MATRIX_BITS, &fit->motion.cov);
}

/* Eight kilometres, or as many microradians: what solves nonsense may be as large as its numbers, and their
 * sums, and a turn in BAM, must fit. */
static const int64_t most_step = INT64_C(1) << 33;

/* One Gauss-Newton step on scan and prediction together; returns its size. */
static int64_t step(const ale_matrix_t *prior, int64_t total[ALE_STATES], ale_fit_t *fit)
{
    ale_matrix_t sum;
    int64_t gradient[ALE_STATES];
    int64_t delta[ALE_STATES];
    for (int i = 0; i < ALE_STATES; i++) {
        gradient[i] = fit->information.gradient[i];
        for (int j = 0; j < ALE_STATES; j++) {
            /* Sums of saturated numbers wrap: there is no fit in them, only steps that are bounded below. */
            gradient[i] = (int64_t)((uint64_t)gradient[i] -
                                    (uint64_t)ale_mul_shift(prior->m[i][j], total[j],
                                                            ALE_MATRIX_BITS - ALE_GRADIENT_BITS));
            sum.m[i][j] = (int64_t)((uint64_t)prior->m[i][j] +
                                    (uint64_t)fit->information.matrix.m[i > j ? i : j][i > j ? j : i]);
        }
        gradient[i] = ale_max64(gradient[i], -INT64_MAX);
    }
    ale_matrix_factor(&sum, &fit->factors);
    ale_matrix_solve(&fit->factors, gradient, ALE_MATRIX_BITS - ALE_GRADIENT_BITS, delta);
    for (int i = 0; i < ALE_STATES; i++) {
        delta[i] = ale_clamp64(delta[i], -most_step, most_step);
    }
    ale_motion_correct(&fit->motion, delta);
    int64_t size = 0;
    for (int i = 0; i < ALE_STATES; i++) {
        total[i] += delta[i];
        size = ale_max64(size, ale_abs64(delta[i]));
    }
    return size;
}

static void note_velocity_change(const ale_motion_t *predicted, const ale_scene_t *scene, ale_fit_t *fit)
{
    const int32_t *straightened = scene->velocity ? scene->velocity : predicted->velocity;
    for (int i = 0; i < ALE_AXES; i++) {
        fit->velocity_change[i] = (int64_t)fit->motion.velocity[i] - straightened[i];
    }
}

static void start(const ale_motion_t *predicted, const ale_scene_t *scene, ale_fit_t *fit)
{
    fit->motion = *predicted;
    fit->work = 0;
    note_velocity_change(predicted, scene, fit);
}

void ale_register_reject(const ale_motion_t *predicted, const ale_scene_t *scene, ale_fit_t *fit)
{
    start(predicted, scene, fit);
    clear(fit);
    fit->shown_um = ale_observations_length_um(scene->observation, scene->observation_count);
    fit->information = no_information;
    fit->iterations = 0;
    for (uint32_t i = 0; i < scene->observation_count; i++) {
        fit->association[i] = (ale_association_t){.wall = ALE_NO_WALL, .landmark = ALE_NO_LANDMARK};
    }
}

/* Largest distance from the robot of a wall that an observation may show; the margin covers gates and steps.
 */
static int32_t reach_um(const ale_scene_t *scene)
{
    int64_t reach = 0;
    for (uint32_t i = 0; i < scene->observation_count; i++) {
        const ale_observation_t *v = &scene->observation[i];
        const int64_t away = ale_abs64(v->centre.x_um) + ale_abs64(v->centre.y_um);
        reach = ale_max64(reach, away + ale_max64(ale_abs64(v->start_um), ale_abs64(v->end_um)));
    }
    return (int32_t)ale_min64(reach + FOCUS_MARGIN_UM, INT32_MAX);
}

static void set_prior(const ale_motion_t *predicted, ale_fit_t *fit)
{
    ale_factors_t factors;
    ale_matrix_factor(&predicted->cov, &factors);
    ale_matrix_invert(&factors, ALE_MATRIX_BITS, &fit->prior);
}

/* Gauss-Newton iterations from out->motion with out->prior; the gates narrow. Where the work `left` does not
 * suffice for two more passes like the first, one step is made. */
static void fit_from(const ale_motion_t *predicted, const ale_scene_t *scene,
                     const ale_gate_t *const gates[ALE_REGISTER_ITERATIONS], int32_t left, ale_fit_t *out)
{
    const ale_pose_t ahead = ale_pose_between(predicted->pose, out->motion.pose);
    int64_t total[ALE_STATES] = {ahead.x_um, ahead.y_um, ale_bam_to_nrad((int32_t)ahead.theta_bam) / 1000};
    int64_t size = INT64_MAX;
    ale_local_map_focus(scene->map, (ale_point_t){out->motion.pose.x_um, out->motion.pose.y_um},
                        reach_um(scene));
    uint8_t most = ALE_REGISTER_ITERATIONS;
    for (out->iterations = 0; out->iterations < most && size > CONVERGED_UM; out->iterations++) {
        if (out->iterations > 0) {
            find_covariance(out);
        }
        find_all(scene, out->iterations == 0 ? &predicted->cov : &out->motion.cov, gates[out->iterations],
                 out);
        add_all(scene, out);
        size = step(&out->prior, total, out);
        note_velocity_change(predicted, scene, out);
        most = out->iterations == 0 && 3 * out->work > left ? 1 : most;
    }
}

/* After all iterations the associations of the last are kept. */
static bool is_associated(const ale_fit_t *fit)
{
    return fit->iterations == ALE_REGISTER_ITERATIONS;
}

void ale_register_associate(const ale_scene_t *scene, ale_fit_t *fit)
{
    if (!is_associated(fit)) {
        find_covariance(fit);
        find_all(scene, &fit->motion.cov, &later, fit);
    }
}

void ale_register_weigh(const ale_scene_t *scene, ale_fit_t *fit)
{
    if (is_associated(fit)) {
        const ale_viewpoint_t viewpoint = ale_viewpoint(fit->motion.pose);
        find_covariance(fit);
        for (uint32_t i = 0; i < scene->observation_count; i++) {
            ale_association_renew(scene->map, &scene->observation[i], &viewpoint, &fit->association[i]);
        }
    }
    add_all(scene, fit);
}

void ale_register_pose(const ale_motion_t *predicted, const ale_scene_t *scene, const ale_gate_t *gate,
                       ale_fit_t *out)
{
    const ale_gate_t second = {(gate->offset_um + LATER_OFFSET_UM) / 3, gate->angle_urad, LATER_SIGMAS,
                               gate->segment_um};
    const ale_gate_t *const wide[ALE_REGISTER_ITERATIONS] = {gate, &second, &later};
    start(predicted, scene, out);
    set_prior(predicted, out);
    fit_from(predicted, scene, wide, INT32_MAX, out);
}

void ale_register_scan(const ale_motion_t *predicted, const ale_scene_t *scene, const ale_gate_t *gate,
                       ale_fit_t *out)
{
    ale_register_pose(predicted, scene, gate, out);
    ale_register_associate(scene, out);
    ale_register_weigh(scene, out);
}

bool ale_register_again(const ale_scene_t *scene, const ale_second_fit_t *second, ale_fit_t *other,
                        ale_fit_t *fit)
{
    const ale_gate_t *const gates[ALE_REGISTER_ITERATIONS] = {second->gate, &later, &later};
    start(second->predicted, scene, other);
    other->motion.pose = second->start;
    if (second->is_new_prior) {
        set_prior(second->predicted, other);
    } else {
        other->prior = fit->prior;
    }
    fit_from(second->predicted, scene, gates, second->most_work - fit->work, other);
    ale_register_associate(scene, other);
    const int64_t least_um = fit->matched_um + second->least_more_um;
    const bool kept = other->matched_um >= least_um;
    if (kept) {
        *fit = *other;
    }
    return kept;
}
