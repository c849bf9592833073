#include "motion/lag.h"

#include <stddef.h>

#include "base/fixed.h"
#include "base/trig.h"
#include "motion/motion.h"

enum {
    GAP_US = 350000,      /* headings farther apart than this are not interpolated */
    INTERVALS_A_SCAN = 4, /* what is left over waits for the next scan */
    INTERVAL_US = 80000,  /* shortest interval of the wheels that is compared */
    FORGET_SHIFT = 10,    /* a memory of about a thousand intervals */
    LAST_US = ALE_LAG_FIRST_US + (ALE_LAG_CANDIDATES - 1) * ALE_LAG_STEP_US,
    TELLING_URAD = 15000,        /* the candidates must differ by this, or the interval says nothing */
    NOISE_FLOOR_URAD2 = 9000000, /* (3 mrad)^2: no turn of an interval is known better */
    DISAGREEMENT_URAD = 150000,  /* wheels that slip or a wrong match: not evidence about time */
    LEAST_INTERVALS = 4,
    SIGMA_FLOOR_US = 2000
};

void ale_lag_init(ale_lag_t *lag, int32_t prior_us)
{
    *lag = (ale_lag_t){
        .done_us = INT64_MIN, .prior_us = prior_us, .lag_us = prior_us, .sigma_us = ALE_LAG_PRIOR_SIGMA_US};
}

static const ale_heading_t *heading_at(const ale_lag_t *lag, uint32_t index)
{
    return &lag->heading[(lag->first + index) % ALE_LAG_HEADINGS];
}

void ale_lag_add_heading(ale_lag_t *lag, const ale_heading_t *heading)
{
    if (lag->count > 0) {
        const int64_t dt_us = heading->stamp_us - heading_at(lag, lag->count - 1)->stamp_us;
        if (dt_us <= 0 || dt_us > GAP_US) {
            lag->count = 0;
        }
    }
    if (lag->count == ALE_LAG_HEADINGS) {
        lag->first = (lag->first + 1) % ALE_LAG_HEADINGS;
        lag->count--;
    }
    lag->heading[(lag->first + lag->count) % ALE_LAG_HEADINGS] = *heading;
    lag->count++;
}

void ale_lag_turn(ale_lag_t *lag, uint32_t turn_bam)
{
    for (uint32_t i = 0; i < ALE_LAG_HEADINGS; i++) {
        lag->heading[i].theta_bam += turn_bam;
    }
}

/* How far the row has been walked: to its heading number `at`, `turned_urad` from the first to the one
 * before. */
typedef struct {
    uint32_t at;
    int64_t turned_urad;
} walk_t;

/* Heading at an instant that the row covers, urad from the row's first: cubic through two headings and their
 * turning (Hermite), exact while the robot's acceleration is constant. A walk asks for later and later ones.
 */
static int64_t heading_urad(const ale_lag_t *lag, int64_t t_us, walk_t *walk)
{
    while (walk->at + 1 < lag->count && heading_at(lag, walk->at)->stamp_us < t_us) {
        const int32_t turn_bam =
            ale_bam_diff(heading_at(lag, walk->at)->theta_bam, heading_at(lag, walk->at - 1)->theta_bam);
        walk->turned_urad += ale_bam_to_nrad(turn_bam) / 1000;
        walk->at++;
    }
    const ale_heading_t *a = heading_at(lag, walk->at - 1);
    const ale_heading_t *b = heading_at(lag, walk->at);
    const int64_t dt_us = b->stamp_us - a->stamp_us;
    const int64_t u = ale_round_div((t_us - a->stamp_us) * (1 << 16), dt_us);
    const int64_t uu = ale_round_shift(u * u, 16);
    const int64_t uuu = ale_round_shift(uu * u, 16);
    const int64_t way = ale_bam_to_nrad(ale_bam_diff(b->theta_bam, a->theta_bam)) / 1000;
    const int64_t va = ale_round_shift(a->turn_urad_tick * dt_us, ALE_TICK_BITS);
    const int64_t vb = ale_round_shift(b->turn_urad_tick * dt_us, ALE_TICK_BITS);
    return walk->turned_urad +
           ale_round_shift((3 * uu - 2 * uuu) * way + (uuu - 2 * uu + u) * va + (uuu - uu) * vb, 16);
}

/* Turn of the scans minus turn of the wheels between two samples, for each candidate. */
static void compare(const ale_lag_t *lag, const ale_odometry_t *a, const ale_odometry_t *b,
                    int64_t diff_urad[ALE_LAG_CANDIDATES])
{
    const int64_t counted_urad = ale_bam_to_nrad(ale_bam_diff(b->pose.theta_bam, a->pose.theta_bam)) / 1000;
    walk_t to_a = {1, 0};
    walk_t to_b = {1, 0};
    for (int32_t k = 0; k < ALE_LAG_CANDIDATES; k++) {
        const int64_t shift_us = ALE_LAG_FIRST_US + (int64_t)k * ALE_LAG_STEP_US;
        diff_urad[k] = heading_urad(lag, b->stamp_us + shift_us, &to_b) -
                       heading_urad(lag, a->stamp_us + shift_us, &to_a) - counted_urad;
    }
}

static void count(ale_lag_t *lag, const int64_t diff_urad[ALE_LAG_CANDIDATES])
{
    int64_t low_urad = INT64_MAX;
    int64_t high_urad = INT64_MIN;
    int64_t least_urad = INT64_MAX;
    for (int k = 0; k < ALE_LAG_CANDIDATES; k++) {
        low_urad = ale_min64(low_urad, diff_urad[k]);
        high_urad = ale_max64(high_urad, diff_urad[k]);
        least_urad = ale_min64(least_urad, ale_abs64(diff_urad[k]));
    }
    if (high_urad - low_urad < TELLING_URAD || least_urad > DISAGREEMENT_URAD) {
        return;
    }
    for (int k = 0; k < ALE_LAG_CANDIDATES; k++) {
        lag->cost_urad2[k] += diff_urad[k] * diff_urad[k] - (lag->cost_urad2[k] >> FORGET_SHIFT);
    }
    lag->weight_q16 += 65536 - (lag->weight_q16 >> FORGET_SHIFT);
}

/* Cost of a candidate with the prior's share, in the unit of the noise of one interval. */
static int64_t total_cost(const ale_lag_t *lag, int k, int64_t noise_urad2)
{
    const int64_t off_us = ALE_LAG_FIRST_US + (int64_t)k * ALE_LAG_STEP_US - lag->prior_us;
    const int64_t prior_us2 = (int64_t)ALE_LAG_PRIOR_SIGMA_US * ALE_LAG_PRIOR_SIGMA_US;
    return lag->cost_urad2[k] + ale_mul_div(off_us * off_us, noise_urad2, prior_us2);
}

/* Minimum of the parabola through the least cost and its neighbours; the curvature gives the variance:
 * cost(l) = c0 + h (l - l0)^2, noise of one interval c0 / n, so var(l0) = (c0 / n) / h. */
static void minimise(ale_lag_t *lag)
{
    int64_t least_urad2 = INT64_MAX;
    for (int k = 0; k < ALE_LAG_CANDIDATES; k++) {
        least_urad2 = ale_min64(least_urad2, lag->cost_urad2[k]);
    }
    const int64_t noise_urad2 =
        ale_max64(ale_mul_div(least_urad2, 65536, lag->weight_q16), NOISE_FLOOR_URAD2);
    int best = 1;
    for (int k = 1; k < ALE_LAG_CANDIDATES - 1; k++) {
        best = total_cost(lag, k, noise_urad2) < total_cost(lag, best, noise_urad2) ? k : best;
    }
    const int64_t before = total_cost(lag, best - 1, noise_urad2);
    const int64_t after = total_cost(lag, best + 1, noise_urad2);
    const int64_t bend = before + after - 2 * total_cost(lag, best, noise_urad2); /* 2 h step^2 */
    if (bend <= 0) {
        return;
    }
    const int64_t offset_us = ale_clamp64(ale_mul_div(before - after, ALE_LAG_STEP_US, 2 * bend),
                                          -ALE_LAG_STEP_US, ALE_LAG_STEP_US);
    const int64_t step2_us2 = (int64_t)ALE_LAG_STEP_US * ALE_LAG_STEP_US;
    const int64_t var_us2 = ale_mul_div(2 * step2_us2, noise_urad2, bend);
    lag->lag_us = (int32_t)(ALE_LAG_FIRST_US + best * ALE_LAG_STEP_US + offset_us);
    lag->sigma_us =
        (int32_t)ale_clamp64(ale_isqrt((uint64_t)var_us2), SIGMA_FLOOR_US, ALE_LAG_PRIOR_SIGMA_US);
}

/* Whether the headings cover the interval of two samples under every candidate. */
static bool covered(const ale_lag_t *lag, int64_t from_us)
{
    return lag->count >= 2 && heading_at(lag, 0)->stamp_us <= from_us + ALE_LAG_FIRST_US;
}

void ale_lag_update(ale_lag_t *lag, const ale_wheels_t *wheels)
{
    const int64_t until_us = lag->count > 0 ? heading_at(lag, lag->count - 1)->stamp_us - LAST_US : INT64_MIN;
    const ale_odometry_t *a = ale_wheels_sample_from(wheels, lag->done_us);
    for (uint32_t n = 0; a != NULL && n < INTERVALS_A_SCAN; n++) {
        const ale_odometry_t *b = ale_wheels_sample_from(wheels, a->stamp_us + INTERVAL_US);
        if (b == NULL || b->stamp_us > until_us) {
            break;
        }
        if (covered(lag, a->stamp_us) && b->stamp_us - a->stamp_us < GAP_US) {
            int64_t diff_urad[ALE_LAG_CANDIDATES];
            compare(lag, a, b, diff_urad);
            count(lag, diff_urad);
        }
        lag->done_us = b->stamp_us;
        a = b;
    }
    if (lag->weight_q16 >= (int64_t)LEAST_INTERVALS * 65536) {
        minimise(lag);
    }
}
