#include "match/association.h"

#include "base/fixed.h"
#include "base/trig.h"

enum { OVERLAP_PERCENT = 40, OVERLAP_LEAST_UM = 60000, NEVER_TOO_FAR_UM = 30000, NEVER_TOO_FAR_URAD = 50000 };

/* Whether the lever is below 8 m, and the pose known to some 90 mm and 16 mrad: the products of its variance
 * fit int64 then, and none need be asked for its width. */
static inline bool is_plain(const ale_matrix_t *cov, int64_t lever_q14)
{
    return (ale_beyond(lever_q14, 17) | ale_beyond(cov->m[0][0], 33) | ale_beyond(cov->m[1][0], 33) |
            ale_beyond(cov->m[1][1], 33) | ale_beyond(cov->m[2][0], 31) | ale_beyond(cov->m[2][1], 31) |
            ale_beyond(cov->m[2][2], 28)) == 0;
}

int64_t ale_observation_offset_var(const ale_observation_t *observation, const ale_matrix_t *cov)
{
    const ale_direction_t normal = ale_direction(observation->normal_bam);
    const int64_t lever_um = ale_round_shift((int64_t)observation->centre.x_um * normal.sin_q30 -
                                                 (int64_t)observation->centre.y_um * normal.cos_q30,
                                             30);
    const int64_t x = ale_round_shift(normal.cos_q30, 16);
    const int64_t y = ale_round_shift(normal.sin_q30, 16);
    const int64_t lever = ale_round_div(lever_um * (1 << 14), 1000000);
    if (is_plain(cov, lever)) {
        const int64_t plain =
            ale_round_shift(x * x * cov->m[0][0], 28) + ale_round_shift(y * y * cov->m[1][1], 28) +
            ale_round_shift(lever * lever * cov->m[2][2], 28) +
            2 * (ale_round_shift(y * x * cov->m[1][0], 28) + ale_round_shift(lever * x * cov->m[2][0], 28) +
                 ale_round_shift(lever * y * cov->m[2][1], 28));
        return ale_max64(plain, 0);
    }
    const int64_t var =
        ale_mul_shift(x * x, cov->m[0][0], 28) + ale_mul_shift(y * y, cov->m[1][1], 28) +
        ale_mul_shift(lever * lever, cov->m[2][2], 28) +
        2 * (ale_mul_shift(y * x, cov->m[1][0], 28) + ale_mul_shift(lever * x, cov->m[2][0], 28) +
             ale_mul_shift(lever * y, cov->m[2][1], 28));
    return ale_max64(var, 0);
}

int64_t ale_observation_angle_var(const ale_matrix_t *cov)
{
    return cov->m[2][2];
}

/* An observation placed in the frame of the walls, and the variance that the pose's covariance gives its
 * offset, computed on demand. */
typedef struct {
    const ale_observation_t *observation;
    ale_point_t centre;
    uint32_t normal_bam;
    const ale_matrix_t *cov; /* NULL: the pose is known exactly */
    int64_t pose_var_um2;    /* negative: not computed yet */
} candidate_t;

static int64_t pose_var_um2(candidate_t *c)
{
    if (c->pose_var_um2 < 0) {
        c->pose_var_um2 = c->cov ? ale_observation_offset_var(c->observation, c->cov) : 0;
    }
    return c->pose_var_um2;
}

/* Of wall and observation, without the pose. */
static int64_t known_var(const ale_wall_t *wall, const candidate_t *c, const ale_wall_error_t *e)
{
    return ale_wall_offset_var(wall, e->t_um) + c->observation->var_offset_um2;
}

static int64_t angle_var(const ale_wall_t *wall, const candidate_t *c)
{
    return wall->var_angle_urad2 + c->observation->var_angle_urad2 +
           (c->cov ? ale_observation_angle_var(c->cov) : 0);
}

/* Whether observation and wall overlap enough for one to show the other. */
static inline bool overlaps(const ale_wall_t *wall, const ale_observation_t *observation, int64_t overlap_um)
{
    if (overlap_um <= 0) {
        return false;
    }
    const int64_t shorter_um =
        ale_min64(wall->end_um - wall->start_um, ale_observation_length_um(observation));
    return overlap_um * 10 > shorter_um * 8 ||
           (overlap_um > OVERLAP_LEAST_UM && overlap_um * 100 > shorter_um * OVERLAP_PERCENT);
}

/* The observation's errors against a wall that it overlaps, within the gate. The cheapest tests come first:
 * they dismiss most walls. */
static inline bool is_beside(const ale_wall_t *wall, const candidate_t *c, const ale_gate_t *gate,
                             ale_wall_error_t *e)
{
    e->t_um = ale_wall_along(wall, c->centre);
    e->overlap_um = ale_wall_overlap(wall, c->observation, e->t_um);
    if (!overlaps(wall, c->observation, e->overlap_um)) {
        return false;
    }
    e->angle_urad = ale_wall_angle(wall, c->normal_bam);
    if (ale_abs64(e->angle_urad) > gate->angle_urad) {
        return false;
    }
    e->offset_um = ale_wall_offset(wall, c->centre);
    return ale_abs64(e->offset_um) <= gate->offset_um;
}

/* Whether the errors are within the gate in sigmas. The variance of the offset costs most, that of the pose
 * first of all, and few ask for it. */
static inline bool is_within(const ale_wall_t *wall, candidate_t *c, const ale_wall_error_t *e,
                             int32_t sigmas)
{
    const int64_t limit = (int64_t)sigmas * sigmas;
    if (ale_abs64(e->angle_urad) > NEVER_TOO_FAR_URAD &&
        e->angle_urad * e->angle_urad > limit * angle_var(wall, c)) {
        return false;
    }
    if (ale_abs64(e->offset_um) <= NEVER_TOO_FAR_UM) {
        return true;
    }
    const int64_t known_um2 = known_var(wall, c, e);
    const int64_t offset_um2 = e->offset_um * e->offset_um;
    return offset_um2 <= limit * known_um2 || offset_um2 <= limit * (known_um2 + pose_var_um2(c));
}

/* Squared distance in sigmas. */
static int64_t distance_q8(const ale_wall_t *wall, candidate_t *c, const ale_wall_error_t *e)
{
    return (e->offset_um * e->offset_um << 8) / (known_var(wall, c, e) + pose_var_um2(c)) +
           (e->angle_urad * e->angle_urad << 8) / angle_var(wall, c);
}

/* Whether a place lies off the wall's line by `limit_q30` or more, um. */
static inline bool is_off(const ale_candidate_t *wall, ale_point_t p, int64_t limit_q30)
{
    const int64_t off_q30 =
        (int64_t)p.x_um * wall->normal_x_q30 + (int64_t)p.y_um * wall->normal_y_q30 - wall->offset_q30;
    return (uint64_t)(off_q30 + limit_q30 - 1) >= (uint64_t)(2 * limit_q30 - 1);
}

/* The first wall of a range that a place does not lie off; most are passed over here. */
static inline const ale_candidate_t *skip_off(const ale_candidate_t *wall, const ale_candidate_t *last,
                                              ale_point_t p, int64_t limit_q30)
{
    while (wall < last && is_off(wall, p, limit_q30)) {
        wall++;
    }
    return wall;
}

ale_association_t ale_associate(const ale_local_map_t *map, const ale_observation_t *observation,
                                const ale_viewpoint_t *viewpoint, const ale_matrix_t *cov,
                                const ale_gate_t *gate, int32_t *work)
{
    ale_association_t best = {.wall = ALE_NO_WALL, .landmark = ALE_NO_LANDMARK};
    int64_t least_q8 = -1; /* of the best, computed when a second wall passes */
    candidate_t shown = {observation, ale_point_from(observation->centre, viewpoint),
                         observation->normal_bam + viewpoint->pose.theta_bam, cov, -1};
    const int64_t limit_q30 =
        ((int64_t)gate->offset_um << 30) + (1 << 29); /* what rounds to more than the gate */
    ale_range_t facing[2];
    ale_local_map_facing(map->candidate_first, shown.normal_bam, ale_local_map_buckets(gate->angle_urad),
                         facing);
    for (int r = 0; r < 2; r++) {
        ale_spend_work(&facing[r], work);
        const ale_candidate_t *const last = &map->candidate[facing[r].last];
        const ale_candidate_t *const first = &map->candidate[facing[r].first];
        for (const ale_candidate_t *candidate = skip_off(first, last, shown.centre, limit_q30);
             candidate < last; candidate = skip_off(candidate + 1, last, shown.centre, limit_q30)) {
            *work -= ALE_WALL_WORK;
            if (*work < 0) {
                return best;
            }
            const ale_wall_t *wall = &map->wall[candidate->wall];
            ale_wall_error_t e;
            if (!is_beside(wall, &shown, gate, &e) || !is_within(wall, &shown, &e, gate->sigmas)) {
                continue;
            }
            if (best.wall != ALE_NO_WALL) {
                least_q8 = least_q8 < 0 ? distance_q8(&map->wall[best.wall], &shown, &best.error) : least_q8;
                const int64_t own_q8 = distance_q8(wall, &shown, &e);
                if (own_q8 >= least_q8) {
                    continue;
                }
                least_q8 = own_q8;
            }
            best.wall = candidate->wall;
            best.error = e;
        }
    }
    return best;
}

static ale_wall_error_t landmark_error(const ale_landmark_t *landmark, ale_point_t p)
{
    const ale_point_t d = ale_minus(p, landmark->p);
    const ale_direction_t n = ale_direction(landmark->normal_bam);
    return (ale_wall_error_t){
        .offset_um = ale_round_shift((int64_t)d.x_um * n.cos_q30 + (int64_t)d.y_um * n.sin_q30, 30),
        .t_um = ale_round_shift((int64_t)d.x_um * n.sin_q30 - (int64_t)d.y_um * n.cos_q30, 30)};
}

ale_association_t ale_associate_landmark(const ale_local_map_t *map, const ale_observation_t *observation,
                                         const ale_viewpoint_t *viewpoint, int32_t reach_um)
{
    ale_association_t found = {.wall = ALE_NO_WALL};
    const ale_point_t p = ale_point_from(observation->centre, viewpoint);
    found.landmark =
        ale_landmarks_find(&map->landmarks, p, observation->normal_bam + viewpoint->pose.theta_bam,
                           observation->kind == ALE_OBSERVATION_POINT, reach_um);
    if (found.landmark != ALE_NO_LANDMARK) {
        found.error = landmark_error(&map->landmarks.landmark[found.landmark], p);
    }
    return found;
}

void ale_association_renew(const ale_local_map_t *map, const ale_observation_t *observation,
                           const ale_viewpoint_t *viewpoint, ale_association_t *association)
{
    if (association->wall != ALE_NO_WALL) {
        const ale_observation_t moved = ale_observation_from(observation, viewpoint);
        association->error = ale_wall_error(&map->wall[association->wall], &moved);
    } else if (association->landmark != ALE_NO_LANDMARK) {
        association->error = landmark_error(&map->landmarks.landmark[association->landmark],
                                            ale_point_from(observation->centre, viewpoint));
    }
}
