#include "map/wall.h"

#include "base/fixed.h"
#include "base/trig.h"
#include "motion/ratio.h"

/* Floors of the variance: buildings are not straighter than this, and the filter stays open to change. */
enum {
    OFFSET_FLOOR_UM2 = 10000,
    ANGLE_FLOOR_URAD2 = 2500,
    END_NOISE_UM = 150000,
    OUTWARDS = 4, /* divisors of the step of an end towards what one scan shows */
    INWARDS = 16
};

void ale_wall_set_normal(ale_wall_t *wall, uint32_t normal_bam)
{
    wall->normal_bam = normal_bam;
    const ale_direction_t normal = ale_direction(normal_bam);
    wall->normal_x_q30 = normal.cos_q30;
    wall->normal_y_q30 = normal.sin_q30;
}

void ale_wall_from_observation(ale_wall_t *wall, const ale_observation_t *observation)
{
    *wall = (ale_wall_t){.anchor = observation->centre,
                         .start_um = observation->start_um,
                         .end_um = observation->end_um,
                         .var_offset_um2 = observation->var_offset_um2,
                         .var_angle_urad2 = observation->var_angle_urad2};
    ale_wall_set_normal(wall, observation->normal_bam);
}

ale_wall_error_t ale_wall_error(const ale_wall_t *wall, const ale_observation_t *observation)
{
    ale_wall_error_t e;
    e.offset_um = ale_wall_offset(wall, observation->centre);
    e.t_um = ale_wall_along(wall, observation->centre);
    e.angle_urad = ale_wall_angle(wall, observation->normal_bam);
    e.overlap_um = ale_wall_overlap(wall, observation, e.t_um);
    return e;
}

int64_t ale_wall_offset_angle_cov(const ale_wall_t *wall, int64_t t_um)
{
    return wall->cov_um_urad + ale_mul_div(wall->var_angle_urad2, t_um, 1000000);
}

/* Whether t is within 8 m and the angle known to about 90 mrad: then plain int64 products cannot overflow. */
static inline bool is_plain(const ale_wall_t *wall, int64_t t_um)
{
    return (ale_beyond(t_um, 23) | ale_beyond(wall->var_angle_urad2, 33) |
            ale_beyond(wall->cov_um_urad, 36)) == 0;
}

int64_t ale_wall_offset_var(const ale_wall_t *wall, int64_t t_um)
{
    if (is_plain(wall, t_um)) {
        const int64_t sum = 2 * wall->cov_um_urad + ale_round_div(wall->var_angle_urad2 * t_um, 1000000);
        return ale_max64(wall->var_offset_um2 + ale_round_div(sum * t_um, 1000000), OFFSET_FLOOR_UM2);
    }
    const int64_t twice = wall->cov_um_urad + ale_wall_offset_angle_cov(wall, t_um);
    return ale_max64(wall->var_offset_um2 + ale_mul_div(twice, t_um, 1000000), OFFSET_FLOOR_UM2);
}

static void floor_variance(ale_wall_t *w)
{
    w->var_offset_um2 = ale_max64(w->var_offset_um2, OFFSET_FLOOR_UM2);
    w->var_angle_urad2 = ale_max64(w->var_angle_urad2, ANGLE_FLOOR_URAD2);
}

/* One scalar measurement `error` of a state whose covariance with (offset, angle) is (po, pa). */
static void measure(ale_wall_t *w, int64_t error, int64_t po, int64_t pa, int64_t s, int64_t step[2])
{
    const int64_t gain_offset = ale_ratio_q30(po, s);
    const int64_t gain_angle = ale_ratio_q30(pa, s);
    step[0] += ale_mul_shift(gain_offset, error, 30);
    step[1] += ale_mul_shift(gain_angle, error, 30);
    w->var_offset_um2 -= ale_mul_shift(gain_offset, po, 30);
    w->cov_um_urad -= ale_mul_shift(gain_offset, pa, 30);
    w->var_angle_urad2 -= ale_mul_shift(gain_angle, pa, 30);
    floor_variance(w);
}

void ale_wall_observe(ale_wall_t *wall, const ale_wall_error_t *error, int64_t var_offset_um2,
                      int64_t var_angle_urad2)
{
    int64_t step[2] = {0, 0};
    const int64_t pa = ale_wall_offset_angle_cov(wall, error->t_um);
    const int64_t po = wall->var_offset_um2 + ale_mul_div(wall->cov_um_urad, error->t_um, 1000000);
    const int64_t s = ale_wall_offset_var(wall, error->t_um) + var_offset_um2;
    measure(wall, error->offset_um, po, pa, s, step);
    const int64_t left_urad = error->angle_urad - step[1];
    measure(wall, left_urad, wall->cov_um_urad, wall->var_angle_urad2,
            wall->var_angle_urad2 + var_angle_urad2, step);
    wall->anchor = ale_plus(wall->anchor, ale_polar(step[0], wall->normal_bam));
    ale_wall_set_normal(wall, wall->normal_bam + (uint32_t)ale_nrad_to_bam(step[1] * 1000));
}

void ale_wall_extend(ale_wall_t *wall, int64_t from_um, int64_t to_um)
{
    wall->start_um = (int32_t)ale_min64(wall->start_um, from_um);
    wall->end_um = (int32_t)ale_max64(wall->end_um, to_um);
}

static int32_t settled_end(int32_t end_um, int64_t seen_um, int64_t outwards)
{
    const int64_t beyond_um = (seen_um - end_um) * outwards;
    if (beyond_um > END_NOISE_UM) {
        return (int32_t)seen_um;
    }
    const int64_t parts = beyond_um > 0 ? OUTWARDS : INWARDS;
    return beyond_um < -END_NOISE_UM ? end_um : (int32_t)(end_um + (seen_um - end_um) / parts);
}

void ale_wall_settle_ends(ale_wall_t *wall, int64_t from_um, int64_t to_um)
{
    wall->start_um = settled_end(wall->start_um, from_um, -1);
    wall->end_um = settled_end(wall->end_um, to_um, 1);
}

ale_point_t ale_wall_point(const ale_wall_t *wall, int64_t t_um)
{
    return (ale_point_t){wall->anchor.x_um + (int32_t)ale_round_shift(t_um * wall->normal_y_q30, 30),
                         wall->anchor.y_um - (int32_t)ale_round_shift(t_um * wall->normal_x_q30, 30)};
}
