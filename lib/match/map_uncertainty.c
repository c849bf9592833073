#include "match/map_uncertainty.h"

#include "base/fixed.h"
#include "base/trig.h"
#include "motion/projection.h"

enum {
    STEP_UM2 = 500000, /* systematic errors of a scan's surfaces, not in its covariance */
    STEP_URAD2 = 100000,
    DRIFT_MOST_UM = 1000000,
    BEFORE_MM = 100,
    BEFORE_LEAST_Q20 = 256, /* of the whole weight: below that nothing could be divided by */
    COMPARED_BITS = 26,
    COVARIANCE_BITS = 16
};

/* (2 m)^2 and (1 rad)^2: beyond it the uncertainty does not grow. */
static const int64_t most_um2 = 4000000000000;
static const int64_t most_urad2 = 1000000000000;

/* A symmetric matrix of two. */
typedef struct {
    int64_t xx;
    int64_t xy;
    int64_t yy;
} square_t;

static int64_t weight_mm(const ale_observation_t *observation, const ale_association_t *association)
{
    return association->wall != ALE_NO_WALL && observation->kind == ALE_OBSERVATION_LINE
               ? ale_max64(ale_observation_length_um(observation) / 1000, 1)
               : 0;
}

/* n n^T in Q20. */
static square_t facing(const ale_wall_t *wall)
{
    const int64_t x = wall->normal_x_q30;
    const int64_t y = wall->normal_y_q30;
    return (square_t){ale_round_shift(x * x, 40), ale_round_shift(x * y, 40), ale_round_shift(y * y, 40)};
}

static void add_scaled(square_t *sum, const square_t *q20, int64_t by)
{
    sum->xx += ale_round_shift(q20->xx * by, 20);
    sum->xy += ale_round_shift(q20->xy * by, 20);
    sum->yy += ale_round_shift(q20->yy * by, 20);
}

/* A^(-1/2) of a positive matrix in Q20: with d the root of its determinant and t that of its trace plus 2 d,
 * its root is (A + d) / t, which has the determinant d. */
static square_t inverse_root(const square_t *a_q20)
{
    const int64_t det_q40 = a_q20->xx * a_q20->yy - a_q20->xy * a_q20->xy;
    const int64_t d = ale_max64(ale_isqrt((uint64_t)ale_max64(det_q40, 0)), 1);
    const int64_t t = ale_isqrt((uint64_t)(a_q20->xx + a_q20->yy + 2 * d) << 20);
    return (square_t){ale_mul_div(a_q20->yy + d, (int64_t)1 << 40, t * d),
                      ale_mul_div(-a_q20->xy, (int64_t)1 << 40, t * d),
                      ale_mul_div(a_q20->xx + d, (int64_t)1 << 40, t * d)};
}

static int64_t of_two(int64_t a, int64_t by_a, int64_t b, int64_t by_b)
{
    return ale_mul_shift(a, by_a, 20) + ale_mul_shift(b, by_b, 20);
}

/* s b s^T, s in Q20. */
static square_t congruence(const square_t *s, const square_t *b)
{
    const int64_t xx = of_two(s->xx, b->xx, s->xy, b->xy);
    const int64_t xy = of_two(s->xx, b->xy, s->xy, b->yy);
    const int64_t yx = of_two(s->xy, b->xx, s->yy, b->xy);
    const int64_t yy = of_two(s->xy, b->xy, s->yy, b->yy);
    return (square_t){of_two(s->xx, xx, s->xy, xy), of_two(s->xy, xx, s->yy, xy),
                      of_two(s->xy, yx, s->yy, yy)};
}

/* A place in metres. */
typedef struct {
    int64_t x_q20;
    int64_t y_q20;
} metres_t;

static metres_t metres(ale_point_t p)
{
    return (metres_t){ale_round_div((int64_t)p.x_um * (1 << 20), 1000000),
                      ale_round_div((int64_t)p.y_um * (1 << 20), 1000000)};
}

static int64_t times(int64_t m_q20, int64_t v)
{
    return ale_mul_shift(v, m_q20, 20);
}

/* The same uncertainty with the centre of the turn moved by p. */
static ale_map_uncertainty_t moved(const ale_map_uncertainty_t *d, metres_t p)
{
    const int64_t x_turn = times(p.x_q20, d->tt_urad2);
    const int64_t y_turn = times(p.y_q20, d->tt_urad2);
    return (ale_map_uncertainty_t){
        .xx_um2 = d->xx_um2 - 2 * times(p.y_q20, d->xt_um_urad) + times(p.y_q20, y_turn),
        .xy_um2 = d->xy_um2 + times(p.x_q20, d->xt_um_urad) - times(p.y_q20, d->yt_um_urad) -
                  times(p.x_q20, y_turn),
        .yy_um2 = d->yy_um2 + 2 * times(p.x_q20, d->yt_um_urad) + times(p.x_q20, x_turn),
        .xt_um_urad = d->xt_um_urad - y_turn,
        .yt_um_urad = d->yt_um_urad + x_turn,
        .tt_urad2 = d->tt_urad2};
}

ale_map_uncertainty_t ale_map_uncertainty_at(const ale_map_uncertainty_t *map_uncertainty, ale_point_t place)
{
    return moved(map_uncertainty, metres(place));
}

/* The uncertainty about the origin that is `at` about a place. */
static ale_map_uncertainty_t about_origin(const ale_map_uncertainty_t *at, ale_point_t place)
{
    const metres_t p = metres(place);
    return moved(at, (metres_t){-p.x_q20, -p.y_q20});
}

/* Variance of the position along a wall's normal, and its covariance with the heading. */
typedef struct {
    int64_t var_um2;
    int64_t cov_um_urad;
} facing_var_t;

static facing_var_t facing_var(const ale_wall_t *wall, const square_t *n_nt, metres_t place)
{
    const ale_map_uncertainty_t *d = &wall->map_uncertainty;
    const int64_t x = ale_round_shift(wall->normal_x_q30, 10);
    const int64_t y = ale_round_shift(wall->normal_y_q30, 10);
    const int64_t lever_q20 = ale_round_shift(y * place.x_q20 - x * place.y_q20, 20);
    const int64_t cov = times(x, d->xt_um_urad) + times(y, d->yt_um_urad);
    const int64_t turn = times(lever_q20, d->tt_urad2);
    const int64_t var = times(n_nt->xx, d->xx_um2) + 2 * times(n_nt->xy, d->xy_um2) +
                        times(n_nt->yy, d->yy_um2) + times(lever_q20, 2 * cov + turn);
    return (facing_var_t){ale_clamp64(var, 0, most_um2), cov + turn};
}

/* The covariance c of position and heading is averaged over walls that face one way, the heading variance t
 * over all: c may exceed what a covariance can be. It is limited to c^T V^(-1) c <= 3/4 t, its value at the
 * end of a straight path along which the heading drifts evenly. */
static void limit_covariance(ale_map_uncertainty_t *at)
{
    const int64_t turn_urad = ale_max64(ale_isqrt((uint64_t)at->tt_urad2), 1);
    const unsigned bits = ale_bit_length((uint64_t)ale_max64(ale_max64(at->xx_um2, at->yy_um2), 0));
    const unsigned half = bits > COMPARED_BITS ? (bits - COMPARED_BITS + 1) / 2 : 0;
    const int64_t most = (int64_t)1 << COVARIANCE_BITS;
    const int64_t x = ale_clamp64(ale_round_shift(at->xt_um_urad / turn_urad, half), -most, most);
    const int64_t y = ale_clamp64(ale_round_shift(at->yt_um_urad / turn_urad, half), -most, most);
    const int64_t xx = ale_round_shift(at->xx_um2, 2 * half);
    const int64_t xy = ale_round_shift(at->xy_um2, 2 * half);
    const int64_t yy = ale_round_shift(at->yy_um2, 2 * half);
    const int64_t may = ale_max64(xx * yy - xy * xy, 0) / 4 * 3;
    const int64_t has = x * x * yy - 2 * x * y * xy + y * y * xx;
    if (has > may) {
        const int64_t part_q20 = ale_mul_div(ale_isqrt((uint64_t)may), 1 << 20, ale_isqrt((uint64_t)has));
        at->xt_um_urad = times(part_q20, at->xt_um_urad);
        at->yt_um_urad = times(part_q20, at->yt_um_urad);
    }
}

/* Weighted sums over walls: of n n^T, of n n^T times the variance along n, of n times the covariance with the
 * heading, and of the heading's variance. */
typedef struct {
    square_t facing_q20;
    square_t var;
    int64_t x_cov;
    int64_t y_cov;
    int64_t var_urad2;
} sums_t;

/* The uncertainty so far counts in all directions, and not for the heading. */
static sums_t begin_with(const ale_map_uncertainty_t *old, int64_t part_q20)
{
    const int64_t xx = ale_min64(old->xx_um2, most_um2);
    const int64_t yy = ale_min64(old->yy_um2, most_um2);
    const int64_t most_cov = ale_isqrt((uint64_t)xx) * (int64_t)ale_isqrt((uint64_t)yy);
    const int64_t xy = ale_clamp64(old->xy_um2, -most_cov, most_cov);
    return (sums_t){.facing_q20 = {part_q20, 0, part_q20},
                    .var = {times(part_q20, xx), times(part_q20, xy), times(part_q20, yy)},
                    .x_cov = times(part_q20, old->xt_um_urad),
                    .y_cov = times(part_q20, old->yt_um_urad)};
}

static void add_wall(sums_t *sums, const ale_wall_t *wall, metres_t place, int64_t part_q20)
{
    const square_t n_nt = facing(wall);
    const facing_var_t along = facing_var(wall, &n_nt, place);
    const int64_t cov = times(part_q20, along.cov_um_urad);
    add_scaled(&sums->facing_q20, &n_nt, part_q20);
    add_scaled(&sums->var, &n_nt, times(part_q20, along.var_um2));
    sums->x_cov += ale_mul_shift(cov, wall->normal_x_q30, 30);
    sums->y_cov += ale_mul_shift(cov, wall->normal_y_q30, 30);
    sums->var_urad2 += times(part_q20, wall->map_uncertainty.tt_urad2);
}

static ale_map_uncertainty_t mean_of(const sums_t *sums)
{
    const square_t root = inverse_root(&sums->facing_q20);
    const square_t var = congruence(&root, &sums->var);
    const int64_t x = of_two(root.xx, sums->x_cov, root.xy, sums->y_cov);
    const int64_t y = of_two(root.xy, sums->x_cov, root.yy, sums->y_cov);
    ale_map_uncertainty_t mean = {.xx_um2 = var.xx,
                                  .xy_um2 = var.xy,
                                  .yy_um2 = var.yy,
                                  .xt_um_urad = of_two(root.xx, x, root.xy, y),
                                  .yt_um_urad = of_two(root.xy, x, root.yy, y),
                                  .tt_urad2 = sums->var_urad2};
    limit_covariance(&mean);
    return mean;
}

ale_map_uncertainty_t ale_map_uncertainty_here(const ale_local_map_t *map,
                                               const ale_observation_t observation[], uint32_t count,
                                               const ale_fit_t *fit, const ale_map_uncertainty_t *before)
{
    int64_t whole_mm = 0;
    for (uint32_t i = 0; i < count; i++) {
        whole_mm += weight_mm(&observation[i], &fit->association[i]);
    }
    if (whole_mm == 0) {
        return *before;
    }
    const ale_point_t place = {fit->motion.pose.x_um, fit->motion.pose.y_um};
    const metres_t place_m = metres(place);
    const ale_map_uncertainty_t old = ale_map_uncertainty_at(before, place);
    sums_t sums = begin_with(
        &old, ale_clamp64(((int64_t)BEFORE_MM << 20) / whole_mm, BEFORE_LEAST_Q20, (int64_t)1 << 20));
    for (uint32_t i = 0; i < count; i++) {
        const int64_t w_mm = weight_mm(&observation[i], &fit->association[i]);
        if (w_mm > 0) {
            add_wall(&sums, &map->wall[fit->association[i].wall], place_m, (w_mm << 20) / whole_mm);
        }
    }
    const ale_map_uncertainty_t mean = mean_of(&sums);
    return about_origin(&mean, place);
}

/* Variance of the place in the direction of a normal, of a matrix in the same frame. */
static int64_t across(const square_t *var, uint32_t normal_bam)
{
    const ale_projection_t n_nt = ale_projection(normal_bam);
    return ale_mul_shift(var->xx, n_nt.xx_q20, 20) + 2 * ale_mul_shift(var->xy, n_nt.xy_q20, 20) +
           ale_mul_shift(var->yy, n_nt.yy_q20, 20);
}

ale_map_uncertainty_t ale_map_uncertainty_inherit(const ale_map_uncertainty_t *here,
                                                  const ale_motion_t *motion)
{
    const ale_point_t place = {motion->pose.x_um, motion->pose.y_um};
    ale_map_uncertainty_t at = ale_map_uncertainty_at(here, place);
    ale_matrix_t turned;
    ale_motion_map_covariance(motion, &turned);
    if (ale_max64(at.xx_um2, at.yy_um2) < most_um2 && at.tt_urad2 < most_urad2) {
        at.xx_um2 += turned.m[0][0] + STEP_UM2;
        at.xy_um2 += turned.m[0][1];
        at.yy_um2 += turned.m[1][1] + STEP_UM2;
        at.xt_um_urad += turned.m[0][2];
        at.yt_um_urad += turned.m[1][2];
        at.tt_urad2 += turned.m[2][2] + STEP_URAD2;
    }
    return about_origin(&at, place);
}

void ale_map_uncertainty_drift(ale_map_uncertainty_t *here, int64_t *drifted_um, uint32_t along_bam,
                               const ale_motion_t *before, const ale_motion_t *predicted)
{
    const square_t then = {before->cov.m[0][0], before->cov.m[0][1], before->cov.m[1][1]};
    const square_t now = {predicted->cov.m[0][0], predicted->cov.m[0][1], predicted->cov.m[1][1]};
    const int64_t grown_um2 = across(&now, along_bam - predicted->pose.theta_bam) -
                              across(&then, along_bam - before->pose.theta_bam);
    const int64_t sum_um =
        ale_min64(*drifted_um + ale_isqrt((uint64_t)ale_max64(grown_um2, 0)), DRIFT_MOST_UM);
    const ale_map_uncertainty_t at =
        ale_map_uncertainty_at(here, (ale_point_t){predicted->pose.x_um, predicted->pose.y_um});
    const int64_t more_um2 = ale_clamp64(sum_um * sum_um - *drifted_um * *drifted_um, 0,
                                         ale_max64(most_um2 - ale_max64(at.xx_um2, at.yy_um2), 0));
    const ale_direction_t along = ale_direction(along_bam);
    const int64_t x = ale_round_shift(along.cos_q30, 10);
    const int64_t y = ale_round_shift(along.sin_q30, 10);
    here->xx_um2 += ale_mul_shift(more_um2, x * x, 40);
    here->xy_um2 += ale_mul_shift(more_um2, x * y, 40);
    here->yy_um2 += ale_mul_shift(more_um2, y * y, 40);
    *drifted_um = sum_um;
}
