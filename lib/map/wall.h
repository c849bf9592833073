/* One wall of the map: a segment with an error model, refined by every observation of it.
 *
 * A wall has an anchor on it, a normal towards the side it was seen from, and extends along its tangent
 * from start to end, counted from the anchor. Its error is an offset along the normal at the anchor and
 * an angle (counter-clockwise); a point t metres along the tangent then errs by offset + t * angle.
 * Both sides of a thin panel are two walls. Pure functions, constant time. */
#ifndef ALE_MAP_WALL_H
#define ALE_MAP_WALL_H

#include <stdbool.h>
#include <stdint.h>

#include "base/fixed.h"
#include "base/pose.h"
#include "observe/observation.h"

/* Number of the scan that saw first what was in the map before the drive began. */
#define ALE_BORN_BEFORE UINT32_MAX

/* Uncertainty of the map around a place relative to the map's origin, see match/map_uncertainty.h: covariance
 * of a rigid motion, a shift x, y and a turn t about the origin, that moves a point p by (x - t p.y, y + t
 * p.x). */
typedef struct {
    int64_t xx_um2;
    int64_t xy_um2;
    int64_t yy_um2;
    int64_t xt_um_urad;
    int64_t yt_um_urad;
    int64_t tt_urad2;
} ale_map_uncertainty_t;

typedef struct {
    ale_point_t anchor; /* map frame */
    uint32_t normal_bam;
    int32_t normal_x_q30; /* its cosine and sine, kept because every association needs them */
    int32_t normal_y_q30;
    int32_t start_um;
    int32_t end_um;
    uint32_t prior_id; /* its number in a map of tiles, see tile_change.h; 0: the drive has begun it */
    int64_t var_offset_um2;
    int64_t cov_um_urad;
    int64_t var_angle_urad2;
    ale_map_uncertainty_t map_uncertainty;
    int32_t scale_error_um; /* along the normal: see match/odometry_scale_error.h */
    uint32_t id;
    uint32_t born;      /* number of the scan that saw it first, or ALE_BORN_BEFORE */
    uint32_t seen;      /* scans that supported it */
    uint32_t last_scan; /* of the last one that did */
    uint16_t missed;    /* scans that saw through it since */
    uint8_t map;        /* that it belongs to: see atlas.h */
} ale_wall_t;

/* Errors of an observation against a wall, observation minus wall, at t along the wall. */
typedef struct {
    int64_t offset_um;
    int64_t angle_urad;
    int64_t t_um;       /* the observation's centre along the tangent, from the anchor */
    int64_t overlap_um; /* common length; negative: gap between them */
} ale_wall_error_t;

/* A new wall from an observation, which is in the map frame here and below (see ale_observation_from). */
void ale_wall_from_observation(ale_wall_t *wall, const ale_observation_t *observation);

/* Sets the normal with its cosine and sine. */
void ale_wall_set_normal(ale_wall_t *wall, uint32_t normal_bam);

ale_wall_error_t ale_wall_error(const ale_wall_t *wall, const ale_observation_t *observation);

/* The offset alone, of a point: how far it lies off the wall's line, on the side that the wall faces. */
static inline int64_t ale_wall_offset(const ale_wall_t *wall, ale_point_t p)
{
    return ale_round_shift(((int64_t)p.x_um - wall->anchor.x_um) * wall->normal_x_q30 +
                               ((int64_t)p.y_um - wall->anchor.y_um) * wall->normal_y_q30,
                           30);
}

/* And how far along it from the anchor. */
static inline int64_t ale_wall_along(const ale_wall_t *wall, ale_point_t p)
{
    return ale_round_shift(((int64_t)p.x_um - wall->anchor.x_um) * wall->normal_y_q30 -
                               ((int64_t)p.y_um - wall->anchor.y_um) * wall->normal_x_q30,
                           30);
}

/* Angle of a normal against the wall's, and the common length of an observation at t and the wall. */
static inline int64_t ale_wall_angle(const ale_wall_t *wall, uint32_t normal_bam)
{
    return ale_bam_to_nrad(ale_bam_diff(normal_bam, wall->normal_bam)) / 1000;
}
static inline int64_t ale_wall_overlap(const ale_wall_t *wall, const ale_observation_t *observation,
                                       int64_t t_um)
{
    return ale_min64(wall->end_um, t_um + observation->end_um) -
           ale_max64(wall->start_um, t_um + observation->start_um);
}

/* Variance of the wall's offset at t along it, and its covariance with the angle there. */
int64_t ale_wall_offset_var(const ale_wall_t *wall, int64_t t_um);
int64_t ale_wall_offset_angle_cov(const ale_wall_t *wall, int64_t t_um);

/* Kalman update by an independent observation: offset error at t and angle error, with their variances. */
void ale_wall_observe(ale_wall_t *wall, const ale_wall_error_t *error, int64_t var_offset_um2,
                      int64_t var_angle_urad2);

/* Extends the wall to include from..to (along the tangent, from the anchor). */
void ale_wall_extend(ale_wall_t *wall, int64_t from_um, int64_t to_um);

/* The same for one of many scans from one place, the longest of which would make the wall too long.
 * Asymmetric smoothing: an end within 150 mm moves outwards by a quarter and inwards by a sixteenth of its
 * error. One that is shorter by more may be hidden, and is ignored. */
void ale_wall_settle_ends(ale_wall_t *wall, int64_t from_um, int64_t to_um);

/* The point at t along the tangent. */
ale_point_t ale_wall_point(const ale_wall_t *wall, int64_t t_um);

#endif
