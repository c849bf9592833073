#include "motion/wheel_scale.h"

#include "base/fixed.h"

enum {
    END_SIGMA_UM = 4000,  /* error of matching at either end of a way */
    MEMORY_UM = 20000000, /* way over which the factor is remembered */
    FLOOR_PPM = 2000,     /* the factor swings by this much */
    STAYS_PPM = 1000,     /* and by this much for long */
    FORGOTTEN_SHARE = 8   /* an eighth at a time */
};

static const int64_t ppm = 1000000;
static const int64_t two_ends_um2 = (int64_t)2 * END_SIGMA_UM * END_SIGMA_UM;

void ale_wheel_scale_init(ale_wheel_scale_t *scale, int32_t sigma_ppm)
{
    *scale =
        (ale_wheel_scale_t){.sigma_ppm = (int32_t)ale_max64(sigma_ppm, FLOOR_PPM), .ends_um2 = two_ends_um2};
}

static void forget(ale_wheel_scale_t *scale)
{
    scale->counted_um -= scale->counted_um / FORGOTTEN_SHARE;
    scale->excess_um -= scale->excess_um / FORGOTTEN_SHARE;
    scale->erred_um -= scale->erred_um / FORGOTTEN_SHARE;
    scale->ends_um2 -= scale->ends_um2 / (FORGOTTEN_SHARE / 2);
}

/* Whether a way brings no ends of its own. Those of the first one are there from the beginning. */
static bool goes_on(const ale_wheel_scale_t *scale, const ale_wheel_lesson_t *lesson, bool back)
{
    return !scale->begun || (lesson->from_us == scale->end_us && back == scale->back);
}

void ale_wheel_scale_learn(ale_wheel_scale_t *scale, const ale_wheel_lesson_t *lesson)
{
    const int64_t excess_um = lesson->found_um - lesson->counted_um;
    if (ale_abs64(excess_um) > ale_abs64(lesson->counted_um) / 3 + END_SIGMA_UM) {
        return;
    }
    const bool back = lesson->counted_um < 0;
    const int64_t sign = back ? -1 : 1;
    scale->counted_um += sign * lesson->counted_um;
    scale->excess_um += sign * excess_um;
    scale->erred_um += sign * lesson->erred_um;
    const int64_t most_ends_um2 = ppm * ppm; /* (1 m)^2: nothing has been learnt */
    const int64_t ends_um2 = scale->ends_um2 + (goes_on(scale, lesson, back) ? 0 : two_ends_um2);
    scale->ends_um2 = ale_min64(ends_um2, most_ends_um2);
    scale->begun = true;
    scale->end_us = lesson->to_us;
    scale->back = back;
    if (scale->counted_um > MEMORY_UM) {
        forget(scale);
    }
}

/* v / sigma^2: the way, squared, that teaches as much as the prior. um^2 */
static int64_t prior_um2(const ale_wheel_scale_t *scale)
{
    return ale_mul_div(scale->ends_um2, ppm * ppm, (int64_t)scale->sigma_ppm * scale->sigma_ppm);
}

/* The factor is the more by an excess, the longer the way that this is of. */
static int64_t of_factor_ppm(const ale_wheel_scale_t *scale, int64_t excess_um)
{
    const int64_t way_um = ale_max64(scale->counted_um, 1);
    return ale_round_div(excess_um * ppm, way_um + prior_um2(scale) / way_um);
}

int32_t ale_wheel_scale_apply(const ale_wheel_scale_t *scale, int64_t counted_um)
{
    return (int32_t)(counted_um + ale_round_div(counted_um * of_factor_ppm(scale, scale->excess_um), ppm));
}

static int64_t learnt_sigma_ppm(const ale_wheel_scale_t *scale)
{
    const int64_t way_um = scale->counted_um;
    return ale_isqrt((uint64_t)scale->ends_um2) * ppm /
           ale_max64(ale_isqrt((uint64_t)(way_um * way_um + prior_um2(scale))), 1);
}

int64_t ale_wheel_scale_sigma_ppm(const ale_wheel_scale_t *scale)
{
    return ale_max64(learnt_sigma_ppm(scale), FLOOR_PPM);
}

int64_t ale_wheel_scale_error_ppm(const ale_wheel_scale_t *scale)
{
    return ale_max64(learnt_sigma_ppm(scale) + of_factor_ppm(scale, scale->erred_um), STAYS_PPM);
}
