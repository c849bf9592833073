#include "track/map_update.h"

#include <stddef.h>

#include "base/fixed.h"
#include "base/trig.h"
#include "motion/ratio.h"

enum {
    CONFLICT_OFFSET_UM = 50000, /* a wall this near may be the same: better none than two of it */
    CONFLICT_ANGLE_URAD = 120000,
    CONFLICT_SIGMAS = 1000,
    NEW_MARK_UM = 60000, /* marks lie no closer than this */
    MAP_LOOKS = 2048,    /* at walls near new ones, and near those that may be joined */
    REPLACED = 4         /* new walls a scan that may take the place of old ones in a full map */
};

/* Variance of a look as one among independent ones. */
static int64_t diluted(int64_t var, const ale_taking_t *taking)
{
    return ale_min64(var, INT64_MAX / taking->dilution) * taking->dilution;
}

/* What the wheels have made of the robot's place goes into the wall with the same gain as what it sees. */
static void drift_along(ale_wall_t *wall, const ale_taking_t *taking, int64_t t_um, int64_t var_um2)
{
    const int64_t own_um2 = ale_wall_offset_var(wall, t_um);
    const int64_t more_um =
        ale_wheel_drift_along(taking->wheel_drift, wall->normal_x_q30, wall->normal_y_q30) -
        wall->wheel_drift_um;
    wall->wheel_drift_um += (int32_t)ale_mul_shift(more_um, ale_ratio_q30(own_um2, own_um2 + var_um2), 30);
}

static void sharpen(ale_wall_t *wall, const ale_view_t *view, const ale_fit_t *fit, const ale_match_t *match,
                    const ale_taking_t *taking)
{
    const int64_t var_offset = view->var_offset_um2 + ale_view_offset_var(view, &fit->motion.cov);
    const int64_t var_angle = view->var_angle_urad2 + ale_view_angle_var(&fit->motion.cov);
    drift_along(wall, taking, match->error.t_um, diluted(var_offset, taking));
    ale_wall_observe(wall, &match->error, diluted(var_offset, taking), diluted(var_angle, taking));
    const int64_t from_um = match->error.t_um + view->start_um;
    const int64_t to_um = match->error.t_um + view->end_um;
    if (taking->dilution > 1) {
        ale_wall_settle_ends(wall, from_um, to_um);
    } else {
        ale_wall_extend(wall, from_um, to_um);
    }
    wall->seen++;
    wall->last_scan = taking->scan;
    wall->missed = 0;
}

/* The wall as the view shows it, moved by what the change of velocity says. */
static void begin(ale_local_map_t *map, const ale_view_t *view, const ale_fit_t *fit,
                  const ale_taking_t *taking, const ale_drift_t *drift)
{
    ale_wall_t wall;
    ale_view_rows_t rows;
    int64_t offset_um = 0;
    int64_t angle_urad = 0;
    const ale_stand_t stand = ale_stand(fit->motion.pose);
    const ale_view_t moved = ale_view_from(view, &stand);
    ale_wall_from_view(&wall, &moved);
    ale_view_rows(view, fit->motion.pose.theta_bam, wall.normal_bam, &rows);
    for (int i = 0; i < 3; i++) {
        offset_um += ale_mul_shift(rows.offset_row_q14[i + 3], fit->velocity_change[i], ALE_ROW_BITS);
        angle_urad += ale_mul_shift(rows.angle_row_q14[i + 3], fit->velocity_change[i], ALE_ROW_BITS);
    }
    wall.anchor = ale_plus(wall.anchor, ale_polar(offset_um, wall.normal_bam));
    ale_wall_set_normal(&wall, wall.normal_bam + (uint32_t)ale_nrad_to_bam(angle_urad * 1000));
    wall.var_offset_um2 += ale_view_offset_var(view, &fit->motion.cov);
    wall.var_angle_urad2 += ale_view_angle_var(&fit->motion.cov);
    wall.drift = *drift;
    wall.wheel_drift_um =
        (int32_t)ale_wheel_drift_along(taking->wheel_drift, wall.normal_x_q30, wall.normal_y_q30);
    wall.born = taking->scan;
    wall.seen = 1;
    wall.last_scan = taking->scan;
    ale_local_map_add(map, &wall);
}

static void update_mark(ale_marks_t *marks, const ale_view_t *view, const ale_fit_t *fit,
                        const ale_match_t *match, const ale_taking_t *taking)
{
    const ale_point_t p = ale_pose_apply(fit->motion.pose, view->centre);
    const uint32_t normal_bam = view->normal_bam + fit->motion.pose.theta_bam;
    const int64_t var_um2 = view->var_offset_um2 + ale_view_offset_var(view, &fit->motion.cov);
    if (match->mark != ALE_NO_MARK) {
        ale_mark_observe(&marks->mark[match->mark], p, normal_bam, diluted(var_um2, taking), taking->scan);
    } else if (taking->grow && match->wall == ALE_NO_WALL) {
        const bool spot = view->kind == ALE_VIEW_SPOT;
        if (ale_marks_find(marks, p, normal_bam, spot, NEW_MARK_UM) == ALE_NO_MARK) {
            ale_marks_add(marks, &(ale_mark_t){.p = p,
                                               .normal_bam = normal_bam,
                                               .var_um2 = var_um2,
                                               .spot = spot,
                                               .seen = 1,
                                               .last_scan = taking->scan,
                                               .born = taking->scan});
        }
    }
}

/* Joins walls that have turned out to be one: one join a scan, tried at the walls in view. */
static void tidy(ale_local_map_t *map, uint32_t count, const ale_fit_t *fit, int32_t *looks)
{
    for (uint32_t i = 0; i < count; i++) {
        if (fit->match[i].wall != ALE_NO_WALL && ale_local_map_merge_at(map, fit->match[i].wall, looks)) {
            return;
        }
    }
}

void ale_map_update(ale_local_map_t *map, const ale_view_t view[], uint32_t count, const ale_fit_t *fit,
                    const ale_taking_t *taking)
{
    int32_t looks = MAP_LOOKS;
    int room = REPLACED;
    bool begun = false;
    ale_drift_t drift = *taking->here;
    const ale_stand_t stand = ale_stand(fit->motion.pose);
    const ale_gate_t conflict = {CONFLICT_OFFSET_UM, CONFLICT_ANGLE_URAD, CONFLICT_SIGMAS, 0};
    for (uint32_t i = 0; i < count; i++) {
        const ale_match_t *match = &fit->match[i];
        const int64_t length_um = ale_view_length_um(&view[i]);
        if (match->wall == ALE_NO_WALL && (view[i].kind != ALE_VIEW_WALL || length_um < ALE_WALL_LENGTH_UM)) {
            update_mark(&map->marks, &view[i], fit, match, taking);
            continue;
        }
        if (view[i].kind != ALE_VIEW_WALL) {
            map->wall[match->wall].last_scan =
                taking->scan; /* it is there, but a piece is too short to sharpen it */
            continue;
        }
        if (match->wall != ALE_NO_WALL) {
            sharpen(&map->wall[match->wall], &view[i], fit, match, taking);
            continue;
        }
        const bool full = map->count == ALE_MAP_MAX_LINES;
        if (taking->grow && (!full || room-- > 0) &&
            ale_match_view(map, &view[i], &stand, NULL, &conflict, &looks).wall == ALE_NO_WALL) {
            if (!begun) {
                drift = ale_drift_go_on(taking->here, &fit->motion);
                begun = true;
            }
            begin(map, &view[i], fit, taking, &drift);
        }
    }
    map->version++;
    tidy(map, count, fit, &looks);
}
