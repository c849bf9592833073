#include "track/map_update.h"

#include <stddef.h>

#include "base/fixed.h"
#include "base/trig.h"
#include "motion/ratio.h"

enum {
    CONFLICT_OFFSET_UM = 50000, /* a wall this near may be the same: better none than two of it */
    CONFLICT_ANGLE_URAD = 120000,
    CONFLICT_SIGMAS = 1000,
    NEW_LANDMARK_UM = 60000, /* landmarks lie no closer than this */
    UPDATE_WORK = 2048,      /* at walls near new ones, and near those that may be joined */
    REPLACED = 4             /* new walls a scan that may take the place of old ones in a full map */
};

/* Variance of an observation as one among independent ones. */
static int64_t diluted(int64_t var, const ale_map_update_context_t *context)
{
    return ale_min64(var, INT64_MAX / context->dilution) * context->dilution;
}

/* What the wheels have made of the robot's place goes into the wall with the same gain as what it sees. */
static void inherit_scale_error(ale_wall_t *wall, const ale_map_update_context_t *context, int64_t t_um,
                                int64_t var_um2)
{
    const int64_t own_um2 = ale_wall_offset_var(wall, t_um);
    const int64_t more_um =
        ale_scale_error_along(context->scale_error, wall->normal_x_q30, wall->normal_y_q30) -
        wall->scale_error_um;
    wall->scale_error_um += (int32_t)ale_mul_shift(more_um, ale_ratio_q30(own_um2, own_um2 + var_um2), 30);
}

static void sharpen(ale_wall_t *wall, const ale_observation_t *observation, const ale_fit_t *fit,
                    const ale_association_t *association, const ale_map_update_context_t *context)
{
    const int64_t var_offset =
        observation->var_offset_um2 + ale_observation_offset_var(observation, &fit->motion.cov);
    const int64_t var_angle = observation->var_angle_urad2 + ale_observation_angle_var(&fit->motion.cov);
    inherit_scale_error(wall, context, association->error.t_um, diluted(var_offset, context));
    ale_wall_observe(wall, &association->error, diluted(var_offset, context), diluted(var_angle, context));
    const int64_t from_um = association->error.t_um + observation->start_um;
    const int64_t to_um = association->error.t_um + observation->end_um;
    if (context->dilution > 1) {
        ale_wall_settle_ends(wall, from_um, to_um);
    } else {
        ale_wall_extend(wall, from_um, to_um);
    }
    wall->seen++;
    wall->last_scan = context->scan;
    wall->missed = 0;
}

/* The wall as the observation shows it, moved by what the change of velocity says. */
static void begin(ale_local_map_t *map, const ale_observation_t *observation, const ale_fit_t *fit,
                  const ale_map_update_context_t *context, const ale_map_uncertainty_t *map_uncertainty)
{
    ale_wall_t wall;
    ale_observation_rows_t rows;
    int64_t offset_um = 0;
    int64_t angle_urad = 0;
    const ale_viewpoint_t viewpoint = ale_viewpoint(fit->motion.pose);
    const ale_observation_t moved = ale_observation_from(observation, &viewpoint);
    ale_wall_from_observation(&wall, &moved);
    ale_observation_rows(observation, fit->motion.pose.theta_bam, wall.normal_bam, &rows);
    for (int i = 0; i < 3; i++) {
        offset_um += ale_mul_shift(rows.offset_row_q14[i + 3], fit->velocity_change[i], ALE_ROW_BITS);
        angle_urad += ale_mul_shift(rows.angle_row_q14[i + 3], fit->velocity_change[i], ALE_ROW_BITS);
    }
    wall.anchor = ale_plus(wall.anchor, ale_polar(offset_um, wall.normal_bam));
    ale_wall_set_normal(&wall, wall.normal_bam + (uint32_t)ale_nrad_to_bam(angle_urad * 1000));
    wall.var_offset_um2 += ale_observation_offset_var(observation, &fit->motion.cov);
    wall.var_angle_urad2 += ale_observation_angle_var(&fit->motion.cov);
    wall.map_uncertainty = *map_uncertainty;
    wall.scale_error_um =
        (int32_t)ale_scale_error_along(context->scale_error, wall.normal_x_q30, wall.normal_y_q30);
    wall.born = context->scan;
    wall.seen = 1;
    wall.last_scan = context->scan;
    ale_local_map_add(map, &wall);
}

static void update_landmark(ale_landmarks_t *landmarks, const ale_observation_t *observation,
                            const ale_fit_t *fit, const ale_association_t *association,
                            const ale_map_update_context_t *context)
{
    const ale_point_t p = ale_pose_apply(fit->motion.pose, observation->centre);
    const uint32_t normal_bam = observation->normal_bam + fit->motion.pose.theta_bam;
    const int64_t var_um2 =
        observation->var_offset_um2 + ale_observation_offset_var(observation, &fit->motion.cov);
    if (association->landmark != ALE_NO_LANDMARK) {
        ale_landmark_observe(&landmarks->landmark[association->landmark], p, normal_bam,
                             diluted(var_um2, context), context->scan);
    } else if (context->grow && association->wall == ALE_NO_WALL) {
        const bool is_point = observation->kind == ALE_OBSERVATION_POINT;
        if (ale_landmarks_find(landmarks, p, normal_bam, is_point, NEW_LANDMARK_UM) == ALE_NO_LANDMARK) {
            ale_landmarks_add(landmarks, &(ale_landmark_t){.p = p,
                                                           .normal_bam = normal_bam,
                                                           .var_um2 = var_um2,
                                                           .is_point = is_point,
                                                           .map = landmarks->selected,
                                                           .seen = 1,
                                                           .last_scan = context->scan,
                                                           .born = context->scan});
        }
    }
}

/* Joins walls that have turned out to be one: one join a scan, tried at the walls in view. */
static void tidy(ale_local_map_t *map, uint32_t count, const ale_fit_t *fit, int32_t *work)
{
    for (uint32_t i = 0; i < count; i++) {
        if (fit->association[i].wall != ALE_NO_WALL &&
            ale_local_map_merge_at(map, fit->association[i].wall, work)) {
            return;
        }
    }
}

void ale_map_update(ale_local_map_t *map, const ale_observation_t observation[], uint32_t count,
                    const ale_fit_t *fit, const ale_map_update_context_t *context)
{
    int32_t work = UPDATE_WORK;
    int room = REPLACED;
    bool begun = false;
    ale_map_uncertainty_t map_uncertainty = *context->here;
    const ale_viewpoint_t viewpoint = ale_viewpoint(fit->motion.pose);
    const ale_gate_t conflict = {CONFLICT_OFFSET_UM, CONFLICT_ANGLE_URAD, CONFLICT_SIGMAS, 0};
    for (uint32_t i = 0; i < count; i++) {
        const ale_association_t *association = &fit->association[i];
        const int64_t length_um = ale_observation_length_um(&observation[i]);
        if (association->wall == ALE_NO_WALL &&
            (observation[i].kind != ALE_OBSERVATION_LINE || length_um < ALE_WALL_LENGTH_UM)) {
            update_landmark(&map->landmarks, &observation[i], fit, association, context);
            continue;
        }
        if (observation[i].kind != ALE_OBSERVATION_LINE) {
            map->wall[association->wall].last_scan =
                context->scan; /* it is there, but a short segment is too short to sharpen it */
            continue;
        }
        if (association->wall != ALE_NO_WALL) {
            sharpen(&map->wall[association->wall], &observation[i], fit, association, context);
            continue;
        }
        const bool full = map->count == ALE_MAP_MAX_LINES;
        if (context->grow && (!full || room-- > 0) &&
            ale_associate(map, &observation[i], &viewpoint, NULL, &conflict, &work).wall == ALE_NO_WALL) {
            if (!begun) {
                map_uncertainty = ale_map_uncertainty_inherit(context->here, &fit->motion);
                begun = true;
            }
            begin(map, &observation[i], fit, context, &map_uncertainty);
        }
    }
    map->version++;
    tidy(map, count, fit, &work);
}
