#include "extract/lowess.h"

#include <stdbool.h>
#include <string.h>

#include "base/fixed.h"
#include "extract/points.h"

enum {
    ONE_Q8 = 256,
    REJECT_MADS = 6, /* of (9) */
    ASK_MADS = 3     /* a residual that asks for a robust pass: its bisquare weight is 0.56 */
};
static const int64_t largest_difference = (int64_t)1 << 26;

/* (8): (1 - (distance / reach)^3)^3, Q8; distance < reach <= ALE_MAX_SPAN + 1. */
/*@ requires 0 <= distance < reach <= ALE_MAX_SPAN + 1;
  @ assigns \nothing; */
static int64_t tricube_q8(int64_t distance, int64_t reach)
{
    const int64_t cube = reach * reach * reach;
    const int64_t rest_q16 = ((cube - distance * distance * distance) << 16) / cube;
    return ale_round_shift(((rest_q16 * rest_q16) >> 16) * rest_q16, 24);
}

/* (9): (1 - (e / 6 M)^2)^2, Q8. */
/*@ requires 0 <= residual <= 1 << 33 && 1 <= mad <= 1 << 34;
  @ assigns \nothing; */
static uint16_t bisquare_q8(int64_t residual, int64_t mad)
{
    const int64_t limit = REJECT_MADS * mad;
    if (residual >= limit) {
        return 0;
    }
    const int64_t ratio_q12 = ale_min64((residual << 12) / limit, 4096); /* less, for who cannot see it */
    const int64_t rest_q12 = 4096 - ale_round_shift(ratio_q12 * ratio_q12, 12);
    return (uint16_t)ale_round_shift(rest_q12 * rest_q12, 16);
}

typedef struct {
    int64_t w;
    int64_t x;
    int64_t xx;
    int64_t y;
    int64_t xy;
} sums_t;

static void add_neighbour(sums_t *s, int64_t weight_q8, int64_t dx, int64_t dy)
{
    const int64_t y = ale_clamp64(dy, -largest_difference, largest_difference);
    s->w += weight_q8;
    s->x += weight_q8 * dx;
    s->xx += weight_q8 * dx * dx;
    s->y += weight_q8 * y;
    s->xy += weight_q8 * dx * y;
}

/* Reach of the window about point i: half a span, and more beams where the segment's end cuts it short. */
/*@ requires 1 <= config->span <= ALE_MAX_SPAN;
  @ assigns \nothing; */
static int64_t reach_at(const ale_lowess_config_t *config, const uint16_t *beam, int32_t count, int32_t i)
{
    const int64_t half = config->span / 2;
    const int64_t left = ale_clamp64(ale_beams_between(beam, 0, i), 0, half);
    const int64_t right = ale_clamp64(ale_beams_between(beam, i, count - 1), 0, half);
    const int64_t reach = 1 + config->span - 1 - ale_min64(left, right);
    //@ assert 1 <= reach <= ALE_MAX_SPAN + 1;
    return reach;
}

/* The regression at point i; the value itself where fewer than two neighbours have a weight. */
static int32_t smooth_at(const ale_lowess_config_t *config, const uint16_t *beam, const int32_t *value,
                         int32_t count, int32_t i, const uint16_t *robust_q8)
{
    const int64_t reach = reach_at(config, beam, count, i);
    sums_t s = {0};
    //@ split reach;
    //@ loop unroll 32;
    for (int32_t n = 0; i + n < count; n++) {
        const int32_t k = i + n;
        const int64_t dx = ale_beams_between(beam, i, k);
        //@ assert n <= dx;
        if (dx >= reach) {
            break;
        }
        add_neighbour(&s, tricube_q8(dx, reach) * robust_q8[k] / ONE_Q8, dx, (int64_t)value[k] - value[i]);
    }
    //@ loop unroll 32;
    for (int32_t n = 1; i - n >= 0; n++) {
        const int32_t k = i - n;
        const int64_t dx = ale_beams_between(beam, k, i);
        //@ assert n <= dx;
        if (dx >= reach) {
            break;
        }
        add_neighbour(&s, tricube_q8(dx, reach) * robust_q8[k] / ONE_Q8, -dx, (int64_t)value[k] - value[i]);
    }
    const int64_t det = s.w * s.xx - s.x * s.x;
    if (det <= 0) {
        return value[i];
    }
    const int64_t most = INT64_MAX / 4; /* neither is larger: for those who cannot see it */
    const int64_t from_mean = ale_clamp64(ale_mul_div(s.xx, s.y, det), -most, most);
    const int64_t from_slope = ale_clamp64(ale_mul_div(s.x, s.xy, det), -most, most);
    return (int32_t)(value[i] + from_mean - from_slope);
}

/* Fixed filter of the first pass where the window is full: symmetric, so the regression is the mean. */
static void filter_weights(int32_t half, int64_t *weight_q8, int64_t *sum)
{
    *sum = 0;
    //@ loop unroll 16;
    for (int32_t k = 0; k <= half; k++) {
        weight_q8[k] = tricube_q8(k, half + 1);
        *sum += k == 0 ? weight_q8[k] : 2 * weight_q8[k];
    }
}

static void first_pass(const ale_lowess_config_t *config, const uint16_t *beam, const int32_t *value,
                       int32_t count, int32_t *smooth, const uint16_t *robust_q8)
{
    const int32_t half = config->span / 2;
    //@ split half;
    int64_t weight_q8[ALE_MAX_SPAN / 2 + 1];
    int64_t sum;
    filter_weights(half, weight_q8, &sum);
    for (int32_t i = 0; i < count; i++) {
        if (i < half || i + half >= count || beam[i + half] - beam[i - half] != 2 * half) {
            smooth[i] = smooth_at(config, beam, value, count, i, robust_q8);
            continue;
        }
        int64_t total = 0;
        //@ loop unroll 16;
        for (int32_t k = 1; k <= half; k++) {
            total += weight_q8[k] * ((int64_t)value[i - k] + value[i + k] - 2 * (int64_t)value[i]);
        }
        smooth[i] = (int32_t)(value[i] + ale_round_div(total, ale_max64(sum, 1)));
    }
}

static int64_t residual_at(const int32_t *value, const int32_t *smooth, int32_t i)
{
    return ale_abs64((int64_t)value[i] - smooth[i]);
}

/* Median of the residuals' magnitude, at least the floor. */
static int64_t median_residual(const int32_t *value, const int32_t *smooth, int32_t count, int64_t floor_of,
                               uint16_t *bins)
{
    memset(bins, 0, ALE_HISTOGRAM_BINS * sizeof *bins);
    for (int32_t i = 0; i < count; i++) {
        bins[ale_histogram_bin((uint64_t)residual_at(value, smooth, i))]++;
    }
    return ale_clamp64(ale_histogram_quantile(bins, count, 50), floor_of, INT32_MAX);
}

/* Sets the robust weights; true when a residual asks for a pass. */
static bool weigh(const int32_t *value, const int32_t *smooth, int32_t count, int64_t mad,
                  uint16_t *robust_q8)
{
    bool asked = false;
    for (int32_t i = 0; i < count; i++) {
        const int64_t residual = residual_at(value, smooth, i);
        robust_q8[i] = bisquare_q8(residual, mad);
        asked = asked || residual > ASK_MADS * mad;
    }
    return asked;
}

void ale_lowess(const ale_lowess_config_t *config, const uint16_t *beam, const int32_t *value, int32_t count,
                int32_t *smooth, ale_lowess_work_t *work)
{
    if (config->span < 3 || count < 3) {
        for (int32_t i = 0; i < count; i++) {
            smooth[i] = value[i];
        }
        return;
    }
    for (int32_t i = 0; i < count; i++) {
        work->robust_q8[i] = ONE_Q8;
    }
    first_pass(config, beam, value, count, smooth, work->robust_q8);
    for (int32_t pass = 0; pass < config->passes; pass++) {
        const int64_t mad = median_residual(value, smooth, count, config->mad_floor, work->bins);
        if (!weigh(value, smooth, count, mad, work->robust_q8)) {
            return;
        }
        for (int32_t i = 0; i < count; i++) {
            smooth[i] = smooth_at(config, beam, value, count, i, work->robust_q8);
        }
    }
}
