#include "extract/corner.h"

#include <stdbool.h>

#include "base/fixed.h"
#include "base/trig.h"

enum {
    MAX_GAP_BEAMS = 5,
    MAX_REACH_UM = 150000,
    STEP_BEAMS2 = 26, /* see var_of_step_um2 */
    OVERSHOOT =
        2 /* times the deviations of both walls and a beam's width that a wall may go on past the other */
};
static const int64_t min_sine_q30 = 277905233; /* sin 15 degrees */
#define MAX_VAR_UM2 ((int64_t)1 << 40)         /* (1 m)^2: what is not known better has no corner */

typedef struct {
    int64_t c;
    int64_t s;
} direction_t;

static direction_t normal_of(const ale_line_t *line)
{
    const ale_direction_t n = ale_direction(line->alpha_bam);
    const direction_t d = {n.cos_q30, n.sin_q30};
    return d;
}

static int64_t squared_distance(ale_point_t a, ale_point_t b)
{
    const int64_t dx = (int64_t)a.x_um - b.x_um;
    const int64_t dy = (int64_t)a.y_um - b.y_um;
    return dx * dx + dy * dy;
}

/* Direction from p along the line towards its point far. */
static uint32_t wall_direction(const ale_line_t *line, direction_t n, ale_point_t p, ale_point_t far)
{
    const int64_t along = ((int64_t)far.y_um - p.y_um) * n.c - ((int64_t)far.x_um - p.x_um) * n.s;
    return line->alpha_bam + (along >= 0 ? ALE_BAM_QUARTER_TURN : 0u - ALE_BAM_QUARTER_TURN);
}

/* Variance of the line's position along its normal, at p. */
static int64_t var_at_um2(const ale_line_t *line, direction_t n, ale_point_t p)
{
    const int64_t along = ale_round_shift((int64_t)p.y_um * n.c - (int64_t)p.x_um * n.s, 30);
    const int64_t turn = ale_mul_nano(line->var_alpha_nrad2, along) - 2 * line->cov_alpha_rho;
    return ale_max64(line->var_rho_um2 + ale_mul_nano(turn, along), 0);
}

static void set_shape(ale_corner_t *corner, uint32_t wall_a, uint32_t wall_b)
{
    const int32_t opening = ale_bam_diff(wall_b, wall_a);
    const uint32_t between = wall_a + (uint32_t)(opening / 2);
    const ale_direction_t middle = ale_direction(between);
    const int64_t outward =
        (int64_t)corner->p.x_um * middle.cos_q30 + (int64_t)corner->p.y_um * middle.sin_q30;
    corner->angle_bam = opening < 0 ? 0u - (uint32_t)opening : (uint32_t)opening;
    corner->kind = outward > 0 ? ALE_CORNER_CONVEX : ALE_CORNER_CONCAVE;
    corner->bisector_bam = outward > 0 ? between + ALE_BAM_HALF_TURN : between;
}

static void set_covariance(ale_corner_t *corner, const ale_line_t *a, const ale_line_t *b, direction_t na,
                           direction_t nb, int64_t det)
{
    const int64_t ua = ale_min64(var_at_um2(a, na, corner->p), MAX_VAR_UM2);
    const int64_t ub = ale_min64(var_at_um2(b, nb, corner->p), MAX_VAR_UM2);
    const int64_t det2_q20 = ale_max64(ale_round_shift(det * det, 40), 1);
    const int64_t xx = ua * ale_round_shift(nb.s * nb.s, 40) + ub * ale_round_shift(na.s * na.s, 40);
    const int64_t xy = ua * ale_round_shift(nb.s * nb.c, 40) + ub * ale_round_shift(na.s * na.c, 40);
    const int64_t yy = ua * ale_round_shift(nb.c * nb.c, 40) + ub * ale_round_shift(na.c * na.c, 40);
    corner->cov_um2[0] = ale_round_div(xx, det2_q20);
    corner->cov_um2[1] = -ale_round_div(xy, det2_q20);
    corner->cov_um2[2] = ale_round_div(yy, det2_q20);
}

static int64_t cross(ale_point_t a, ale_point_t b)
{
    return (int64_t)a.x_um * b.y_um - (int64_t)a.y_um * b.x_um;
}

static int64_t distance_um(const ale_line_t *line, direction_t n, ale_point_t p)
{
    return ale_abs64(ale_round_shift((int64_t)p.x_um * n.c + (int64_t)p.y_um * n.s, 30) - line->rho_um);
}

/* Whether the walls end where they meet. Seen from the sensor the corner lies between the facing ends; where
 * it does not, the one wall was seen beyond it, off the other by more than noise: something hides the corner.
 */
static bool ends_at_corner(const ale_line_t *a, const ale_line_t *b, direction_t na, direction_t nb,
                           ale_point_t corner, int64_t gap)
{
    const int64_t turn = cross(a->end, b->start);
    const int64_t sense = turn < 0 ? -1 : 1;
    int64_t off_um = 0;
    if (sense * cross(a->end, corner) < 0) {
        off_um = distance_um(b, nb, a->end);
    } else if (sense * cross(corner, b->start) < 0) {
        off_um = distance_um(a, na, b->start);
    }
    const int64_t range_um = ale_isqrt((uint64_t)squared_distance(corner, (ale_point_t){0, 0}));
    const int64_t width_um = sense * turn / ale_max64(range_um * gap, 1);
    return off_um <= OVERSHOOT * (a->rmse_um + b->rmse_um + width_um);
}

/* Variances of the place where two lines meet, whose ends lie near p, along each of them. */
typedef struct {
    int64_t first_um2;
    int64_t second_um2;
} meeting_t;

static meeting_t meeting_of(const ale_line_t *a, const ale_line_t *b, direction_t na, direction_t nb,
                            ale_point_t p)
{
    const int64_t ua = ale_min64(var_at_um2(a, na, p), MAX_VAR_UM2);
    const int64_t ub = ale_min64(var_at_um2(b, nb, p), MAX_VAR_UM2);
    const int64_t sine_q30 = ale_round_shift(na.c * nb.s - na.s * nb.c, 30);
    const int64_t sine2_q20 = ale_max64(ale_round_shift(sine_q30 * sine_q30, 40), 1);
    const int64_t cosine2_q20 = ((int64_t)1 << 20) - sine2_q20;
    return (meeting_t){(ua * cosine2_q20 + (ub << 20)) / sine2_q20,
                       (ub * cosine2_q20 + (ua << 20)) / sine2_q20};
}

/* Variance of the place where they part because the second goes on beside the first, if beams are so far
 * apart: of levels that lie k deviations of a point apart the best joint fit tells where they change to
 * 26 / k^4 beams squared. */
static int64_t var_of_step_um2(const ale_line_t *a, const ale_line_t *b, int64_t step_um,
                               int64_t spacing2_um2)
{
    const int64_t rmse2_um2 = ((int64_t)a->rmse_um * a->rmse_um + (int64_t)b->rmse_um * b->rmse_um) / 2;
    const int64_t part_q8 = ale_min64((rmse2_um2 << 8) / ale_max64(step_um * step_um, 1), 256);
    return ((((spacing2_um2 * STEP_BEAMS2) >> 8) * part_q8) >> 8) * part_q8;
}

/* Squared distance of neighbouring beams on a line, at its end. */
static int64_t spacing2_at_um2(const ale_line_t *line, ale_point_t end, int64_t step_nrad)
{
    const int64_t range2_um2 = squared_distance(end, (ale_point_t){0, 0});
    const int64_t spacing_um =
        ale_min64(ale_mul_nano(range2_um2 / ale_max64(line->rho_um, 1), step_nrad), ALE_MAX_RANGE_UM);
    return spacing_um * spacing_um;
}

/* How two lines that adjoin lie to each other at an end of one of them. */
typedef struct {
    int64_t meeting_um2;  /* variance of the place where they meet, along that one */
    int64_t step_um;      /* distance of its end from the other */
    int64_t spacing2_um2; /* of its beams */
    int64_t gap;          /* beams from end to end */
} facing_t;

/* Variance of an end along its line, where another adjoins. The place where they part lies half way between
 * the ends that face each other, give or take a beam where neither is seen: (3 g^2 + 1) / 12 of the beams'
 * distance on the wall squared, for g beams from end to end. It errs by what moves that place. */
static int64_t facing_end_var_um2(const ale_line_t *a, const ale_line_t *b, const facing_t *f)
{
    const int64_t parting_um2 = ale_min64(f->meeting_um2, var_of_step_um2(a, b, f->step_um, f->spacing2_um2));
    return f->spacing2_um2 * (3 * f->gap * f->gap + 1) / 12 + parting_um2;
}

static bool corner_of(const ale_line_t *a, const ale_line_t *b, direction_t na, direction_t nb, int64_t gap,
                      ale_corner_t *corner)
{
    const int64_t det = ale_round_shift(na.c * nb.s - na.s * nb.c, 30);
    const int64_t sine = ale_abs64(det);
    if (sine < min_sine_q30) {
        return false;
    }
    const int64_t sign = det < 0 ? -1 : 1;
    const int64_t x = sign * (a->rho_um * nb.s - b->rho_um * na.s);
    const int64_t y = sign * (b->rho_um * na.c - a->rho_um * nb.c);
    corner->p.x_um = (int32_t)ale_clamp64(ale_round_div(x, sine), INT32_MIN / 2, INT32_MAX / 2);
    corner->p.y_um = (int32_t)ale_clamp64(ale_round_div(y, sine), INT32_MIN / 2, INT32_MAX / 2);
    const int64_t reach2 = (int64_t)MAX_REACH_UM * MAX_REACH_UM;
    if (squared_distance(corner->p, a->end) > reach2 || squared_distance(corner->p, b->start) > reach2) {
        return false;
    }
    if (!ends_at_corner(a, b, na, nb, corner->p, gap)) {
        return false;
    }
    set_shape(corner, wall_direction(a, na, corner->p, a->start), wall_direction(b, nb, corner->p, b->end));
    set_covariance(corner, a, b, na, nb, det);
    return true;
}

/* Beams from one line to the next, of a whole turn also over the seam; 0 and less: the one does not lie
 * behind the other. */
static int32_t gap_between(const ale_line_t *a, const ale_line_t *b, int32_t turn_beams)
{
    const int32_t gap = b->first - a->last;
    return gap < 0 ? gap + turn_beams : gap;
}

void ale_corner_find(int64_t step_nrad, int32_t turn_beams, ale_features_t *out)
{
    out->corner_count = 0;
    if (out->line_count < 2) {
        return;
    }
    direction_t next = normal_of(&out->line[0]);
    const uint16_t last = (uint16_t)(out->line_count - (turn_beams > 0 ? 1 : 2)); /* that has a next one */
    for (uint16_t k = 0; k <= last; k++) {
        const uint16_t after = (uint16_t)(k + 1 < out->line_count ? k + 1 : 0);
        ale_line_t *a = &out->line[k];
        ale_line_t *b = &out->line[after];
        ale_corner_t *corner = &out->corner[out->corner_count];
        const direction_t here = next;
        next = normal_of(b);
        const int32_t gap = gap_between(a, b, turn_beams);
        if (gap <= 0 || gap > MAX_GAP_BEAMS) {
            continue;
        }
        const meeting_t meeting = meeting_of(a, b, here, next, a->end);
        const facing_t end = {meeting.first_um2, distance_um(b, next, a->end),
                              spacing2_at_um2(a, a->end, step_nrad), gap};
        const facing_t start = {meeting.second_um2, distance_um(a, here, b->start),
                                spacing2_at_um2(b, b->start, step_nrad), gap};
        a->var_end_um2 = facing_end_var_um2(a, b, &end);
        b->var_start_um2 = facing_end_var_um2(b, a, &start);
        if (!corner_of(a, b, here, next, gap, corner)) {
            continue;
        }
        corner->first_line = k;
        corner->second_line = after;
        a->last_end = ALE_END_EDGE;
        b->first_end = ALE_END_EDGE;
        out->corner_count++;
    }
}
