#include "extract/moments.h"

#include "base/fixed.h"

_Static_assert(ALE_POINT_MAX_Q4 *ALE_POINT_MAX_Q4 <= INT64_MAX / 2 / ALE_MAX_BEAMS / ALE_MAX_BEAMS,
               "twice the centred moments of the largest scan must fit int64");

enum {
    MOST_RELATIVE_Q36 = 1 << 29, /* no error is believed to exceed 9 % of the range */
    OWN_SCALED_BITS = 37,
    SCATTER_BITS = 30, /* centred moments are scaled to this many bits: their products fit int64 */
    VAR_FLOOR_Q8 = 16  /* (0.25 mm)^2: no range is known better than its quantum of 1 mm */
};

void ale_moments_build(ale_extractor_t *e)
{
    ale_moments_t total = {0};
    /* own_mm2 / range^2 from 2^44 / range: its square >> 34, times this, >> 26, is Q36 */
    const int64_t own_scaled =
        ale_min64(((e->noise.own_mm2_q36 >> 10) * 15625) >> 12, (int64_t)1 << OWN_SCALED_BITS);
    e->inverse_sum[0] = 0;
    for (int32_t i = 0; i < e->count; i++) {
        e->sum[i] = total;
        e->inverse_sum[i + 1] = e->inverse_sum[i] + e->inverse_q44[i];
        const int64_t x = e->x_q4[i];
        const int64_t y = e->y_q4[i];
        total.x += x;
        total.y += y;
        total.xx += x * x;
        total.yy += y * y;
        total.xy += x * y;
        const int64_t inverse = e->inverse_q44[i];
        total.noise_q36 += ((inverse * inverse >> 34) * own_scaled >> 26) + e->noise.own_relative_q36;
    }
    e->sum[e->count] = total;
}

typedef struct {
    int64_t a; /* scaled scatter matrix [a b; b c] */
    int64_t b;
    int64_t c;
    int64_t lambda; /* its small eigenvalue */
    unsigned shift;
} scatter_t;

static scatter_t scatter_of(int64_t n, const ale_moments_t *s)
{
    const int64_t a = n * s->xx - s->x * s->x;
    const int64_t b = n * s->xy - s->x * s->y;
    const int64_t c = n * s->yy - s->y * s->y;
    const unsigned bits = ale_bit_length((uint64_t)(a + c));
    const unsigned shift = bits > SCATTER_BITS ? bits - SCATTER_BITS : 0;
    scatter_t m = {a >> shift, b < 0 ? -(-b >> shift) : b >> shift, c >> shift, 0, shift};
    const int64_t det = ale_max64(m.a * m.c - m.b * m.b, 0);
    const int64_t trace = m.a + m.c;
    if (trace > 0) {
        m.lambda = det / ale_max64(trace - det / trace, 1);
    }
    return m;
}

/* Squared distance of the line from the sensor, mm^2: (mean' N mean), N = n n' from the scatter. */
static int64_t squared_rho_mm2(const scatter_t *m, int64_t mean_x_mm, int64_t mean_y_mm)
{
    const int64_t spread = (m->a + m->c - 2 * m->lambda) >> 2;
    if (spread <= 0) {
        return mean_x_mm * mean_x_mm + mean_y_mm * mean_y_mm;
    }
    const int64_t nxx = (m->c - m->lambda) >> 2;
    const int64_t nyy = (m->a - m->lambda) >> 2;
    const int64_t nxy = m->b / 4;
    const int64_t sum =
        nxx * mean_x_mm * mean_x_mm + nyy * mean_y_mm * mean_y_mm - 2 * nxy * mean_x_mm * mean_y_mm;
    return ale_max64(sum, 0) / spread;
}

static ale_moments_t sums_of(const ale_extractor_t *e, int32_t first, int32_t last)
{
    const ale_moments_t *p = &e->sum[first];
    const ale_moments_t *q = &e->sum[last + 1];
    const ale_moments_t s = {q->x - p->x,   q->y - p->y,   q->xx - p->xx,
                             q->yy - p->yy, q->xy - p->xy, q->noise_q36 - p->noise_q36};
    return s;
}

static ale_fit_t fit_of(const ale_extractor_t *e, int64_t n, const ale_moments_t *s, const scatter_t *m)
{
    const ale_scan_noise_t *noise = &e->noise;
    const int64_t rho2 = squared_rho_mm2(m, s->x / (n << ALE_POINT_SHIFT), s->y / (n << ALE_POINT_SHIFT));
    const int64_t range2 = ((s->xx + s->yy) >> (2 * ALE_POINT_SHIFT)) / n;
    const int64_t own_q36 = ale_min64(s->noise_q36 / n, MOST_RELATIVE_Q36);
    const int64_t own = rho2 * own_q36 + ale_max64(range2 - rho2, 0) * noise->bearing_rad2_q36;
    const int64_t shared_q36 = ale_min64(
        noise->shared_mm2_q36 / ale_max64(range2, 1) + noise->shared_relative_q36, MOST_RELATIVE_Q36);
    const ale_fit_t fit = {
        .n = (int32_t)n,
        .sse_q8 = (m->lambda << m->shift) / n,
        .var_q8 = ale_max64((own >> 28) * noise->own_scale_q8 >> 8, VAR_FLOOR_Q8),
        .shared_q8 = rho2 * shared_q36 >> 28,
    };
    return fit;
}

int64_t ale_moments_sse_q8(const ale_extractor_t *e, int32_t first, int32_t last)
{
    const ale_moments_t *p = &e->sum[first];
    const ale_moments_t *q = &e->sum[last + 1];
    const int64_t n = last + 1 - first;
    const ale_moments_t s = {
        .x = q->x - p->x, .y = q->y - p->y, .xx = q->xx - p->xx, .yy = q->yy - p->yy, .xy = q->xy - p->xy};
    const scatter_t m = scatter_of(n, &s);
    return (m.lambda << m.shift) / n;
}

ale_fit_t ale_moments_fit(const ale_extractor_t *e, int32_t first, int32_t last)
{
    const int64_t n = last + 1 - first;
    const ale_moments_t s = sums_of(e, first, last);
    const scatter_t m = scatter_of(n, &s);
    return fit_of(e, n, &s, &m);
}

ale_spread_t ale_moments_spread(const ale_extractor_t *e, int32_t first, int32_t last)
{
    const int64_t n = last + 1 - first;
    const ale_moments_t s = sums_of(e, first, last);
    const scatter_t m = scatter_of(n, &s);
    const ale_spread_t spread = {
        .fit = fit_of(e, n, &s, &m),
        .a = m.a,
        .b = m.b,
        .c = m.c,
        .along2_q8 = ((m.a + m.c - m.lambda) << m.shift) / n,
        .mean_x_um = ale_round_div(s.x * 1000, n << ALE_POINT_SHIFT),
        .mean_y_um = ale_round_div(s.y * 1000, n << ALE_POINT_SHIFT),
    };
    return spread;
}
