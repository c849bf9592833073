#include "track/drift.h"

#include "base/fixed.h"
#include "base/trig.h"

enum {
    STEP_UM2 = 9000000, /* what a scan's surfaces add that its covariance does not know */
    STEP_URAD2 = 800000,
    SLID_MOST_UM = 1000000,
    BEFORE_MM = 100,
    BEFORE_LEAST_Q20 = 256 /* of the whole weight: below that nothing could be divided by */
};

/* A symmetric matrix of two. */
typedef struct {
    int64_t xx;
    int64_t xy;
    int64_t yy;
} square_t;

static int64_t weight_mm(const ale_view_t *view, const ale_match_t *match)
{
    return match->wall != ALE_NO_WALL && view->kind == ALE_VIEW_WALL
               ? ale_max64(((int64_t)view->end_um - view->start_um) / 1000, 1)
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

ale_drift_here_t ale_drift_here(const ale_local_map_t *map, const ale_view_t view[], uint32_t count,
                                const ale_fit_t *fit, const ale_drift_here_t *before)
{
    int64_t whole_mm = 0;
    for (uint32_t i = 0; i < count; i++) {
        whole_mm += weight_mm(&view[i], &fit->match[i]);
    }
    if (whole_mm == 0) {
        return *before;
    }
    const int64_t old_q20 = ale_clamp64(((int64_t)BEFORE_MM << 20) / whole_mm, BEFORE_LEAST_Q20, 1 << 20);
    square_t a = {old_q20, 0, old_q20};
    square_t b = {0, 0, 0};
    int64_t var_urad2 = 0;
    add_scaled(&b, &(square_t){before->xx_um2, before->xy_um2, before->yy_um2}, old_q20);
    for (uint32_t i = 0; i < count; i++) {
        const int64_t w_mm = weight_mm(&view[i], &fit->match[i]);
        if (w_mm == 0) {
            continue;
        }
        const ale_wall_t *wall = &map->wall[fit->match[i].wall];
        const int64_t part_q20 = (w_mm << 20) / whole_mm;
        const square_t n_nt = facing(wall);
        add_scaled(&a, &n_nt, part_q20);
        add_scaled(&b, &n_nt, ale_round_shift(wall->drift.var_um2 * part_q20, 20));
        var_urad2 += ale_round_shift(wall->drift.var_urad2 * part_q20, 20);
    }
    const square_t root = inverse_root(&a);
    const square_t mean = congruence(&root, &b);
    return (ale_drift_here_t){mean.xx, mean.xy, mean.yy, var_urad2};
}

/* Variance of the place in the direction of a normal, of a matrix in the same frame. */
static int64_t across(const square_t *var, uint32_t normal_bam)
{
    const ale_direction_t n = ale_direction(normal_bam);
    const int64_t x = ale_round_shift(n.cos_q30, 10);
    const int64_t y = ale_round_shift(n.sin_q30, 10);
    return ale_mul_shift(var->xx, ale_round_shift(x * x, 20), 20) +
           2 * ale_mul_shift(var->xy, ale_round_shift(x * y, 20), 20) +
           ale_mul_shift(var->yy, ale_round_shift(y * y, 20), 20);
}

static int64_t within(int64_t var)
{
    return ale_clamp64(var, 0, ALE_DRIFT_MOST);
}

ale_drift_t ale_drift_of_new_wall(const ale_drift_here_t *here, const ale_motion_t *motion,
                                  uint32_t normal_bam)
{
    const square_t map = {here->xx_um2, here->xy_um2, here->yy_um2};
    const square_t pose = {motion->cov.m[0][0], motion->cov.m[0][1], motion->cov.m[1][1]};
    const int64_t var_um2 = across(&map, normal_bam) + across(&pose, normal_bam - motion->pose.theta_bam);
    return (ale_drift_t){within(var_um2 + STEP_UM2),
                         within(here->var_urad2 + motion->cov.m[2][2] + STEP_URAD2)};
}

ale_drift_here_t ale_drift_go_on(const ale_drift_here_t *here, const ale_motion_t *motion)
{
    ale_matrix_t turned;
    ale_motion_map_covariance(motion, &turned);
    return (ale_drift_here_t){within(here->xx_um2 + turned.m[0][0] + STEP_UM2), here->xy_um2 + turned.m[0][1],
                              within(here->yy_um2 + turned.m[1][1] + STEP_UM2),
                              within(here->var_urad2 + turned.m[2][2] + STEP_URAD2)};
}

void ale_drift_slide(ale_drift_here_t *here, int64_t *slid_um, uint32_t along_bam, const ale_motion_t *before,
                     const ale_motion_t *predicted)
{
    const square_t then = {before->cov.m[0][0], before->cov.m[0][1], before->cov.m[1][1]};
    const square_t now = {predicted->cov.m[0][0], predicted->cov.m[0][1], predicted->cov.m[1][1]};
    const int64_t grown_um2 = across(&now, along_bam - predicted->pose.theta_bam) -
                              across(&then, along_bam - before->pose.theta_bam);
    const int64_t slid = ale_min64(*slid_um + ale_isqrt((uint64_t)ale_max64(grown_um2, 0)), SLID_MOST_UM);
    const int64_t more_um2 = slid * slid - *slid_um * *slid_um;
    const ale_direction_t along = ale_direction(along_bam);
    const int64_t x = ale_round_shift(along.cos_q30, 10);
    const int64_t y = ale_round_shift(along.sin_q30, 10);
    here->xx_um2 = within(here->xx_um2 + ale_mul_shift(more_um2, x * x, 40));
    here->xy_um2 += ale_mul_shift(more_um2, x * y, 40);
    here->yy_um2 = within(here->yy_um2 + ale_mul_shift(more_um2, y * y, 40));
    *slid_um = slid;
}
