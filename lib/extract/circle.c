#include "extract/circle.h"

#include <stdbool.h>

#include "base/fixed.h"

enum {
    MAX_RADIUS_Q4 = 10000 << ALE_POINT_SHIFT,
    MAX_EXTENT_Q4 = 1 << 18,
    MAX_DISTANCE_Q4 = 1 << 20,
    SUM_BITS = 29,
    HALF_Q4 = 1 << (ALE_POINT_SHIFT - 1)
};

typedef struct {
    int64_t uu;
    int64_t uv;
    int64_t vv;
    int64_t uz;
    int64_t vz;
    int64_t z;
} circle_sums_t;

typedef struct {
    int64_t x;
    int64_t y;
} mean_t;

/* Sums of the squares about the mean, from those of the scan. */
static circle_sums_t squares_about(const ale_prepared_scan_t *scan, int32_t first, int32_t last, mean_t mean)
{
    const ale_moments_t *p = &scan->sum[first];
    const ale_moments_t *q = &scan->sum[last + 1];
    const int64_t n = last + 1 - first;
    const int64_t sx = q->x - p->x;
    const int64_t sy = q->y - p->y;
    return (circle_sums_t){.uu = q->xx - p->xx - 2 * mean.x * sx + n * mean.x * mean.x,
                           .uv = q->xy - p->xy - mean.x * sy - mean.y * sx + n * mean.x * mean.y,
                           .vv = q->yy - p->yy - 2 * mean.y * sy + n * mean.y * mean.y};
}

/* The same of points that count as though no farther than MAX_EXTENT_Q4. */
static circle_sums_t held_squares_about(const ale_prepared_scan_t *scan, int32_t first, int32_t last,
                                        mean_t mean)
{
    circle_sums_t s = {0};
    for (int32_t i = first; i <= last; i++) {
        const int64_t u = ale_clamp64(scan->points.x_q4[i] - mean.x, -MAX_EXTENT_Q4, MAX_EXTENT_Q4);
        const int64_t v = ale_clamp64(scan->points.y_q4[i] - mean.y, -MAX_EXTENT_Q4, MAX_EXTENT_Q4);
        s.uu += u * u;
        s.uv += u * v;
        s.vv += v * v;
    }
    return s;
}

/* Adds those of the third powers, of points held at that extent or not. */
static inline __attribute__((always_inline)) void add_thirds_about(const ale_prepared_scan_t *scan,
                                                                   int32_t first, int32_t last, mean_t mean,
                                                                   bool held, circle_sums_t *s)
{
    for (int32_t i = first; i <= last; i++) {
        int64_t u = scan->points.x_q4[i] - mean.x;
        int64_t v = scan->points.y_q4[i] - mean.y;
        if (held) {
            u = ale_clamp64(u, -MAX_EXTENT_Q4, MAX_EXTENT_Q4);
            v = ale_clamp64(v, -MAX_EXTENT_Q4, MAX_EXTENT_Q4);
        }
        const int64_t z = (u * u + v * v + HALF_Q4) >> ALE_POINT_SHIFT;
        s->uz += u * z;
        s->vz += v * z;
        s->z += z;
    }
}

/* Whether all points lie within half of that extent of the sensor: then none is so far off their mean. No
 * branch: the compiler takes several at once. */
static bool are_near(const ale_points_t *p, int32_t first, int32_t last)
{
    uint32_t reach = 0;
    for (int32_t i = first; i <= last; i++) {
        reach |= (uint32_t)(p->x_q4[i] + MAX_EXTENT_Q4 / 2) | (uint32_t)(p->y_q4[i] + MAX_EXTENT_Q4 / 2);
    }
    return reach < MAX_EXTENT_Q4;
}

static circle_sums_t sums_about(const ale_prepared_scan_t *scan, int32_t first, int32_t last, mean_t mean)
{
    const int64_t most = (int64_t)MAX_EXTENT_Q4 * MAX_EXTENT_Q4;
    circle_sums_t s = squares_about(scan, first, last, mean);
    if ((s.uu <= most && s.vv <= most) || are_near(&scan->points, first, last)) { /* none is so far off */
        add_thirds_about(scan, first, last, mean, false, &s);
        return s;
    }
    s = held_squares_about(scan, first, last, mean);
    add_thirds_about(scan, first, last, mean, true, &s);
    return s;
}

static unsigned excess_bits(int64_t v)
{
    const unsigned bits = ale_bit_length((uint64_t)v);
    return bits > SUM_BITS ? bits - SUM_BITS : 0;
}

/* num * 2^scale / den, den > 0: the shift is taken from the denominator where the numerator has no room. */
static int64_t scaled_ratio(int64_t num, int64_t den, int32_t scale)
{
    if (scale < 0) {
        return ale_round_shift(ale_round_div(num, den), (unsigned)-scale);
    }
    const int32_t room = 62 - (int32_t)ale_bit_length((uint64_t)ale_abs64(num));
    const int32_t up = scale < room ? scale : room;
    return ale_round_div(num * ((int64_t)1 << up),
                         ale_max64(ale_round_shift(den, (unsigned)(scale - up)), 1));
}

ale_circle_t ale_circle_fit(const ale_prepared_scan_t *scan, int32_t first, int32_t last)
{
    const ale_circle_t none = {0, 0, 0};
    const int64_t n = last + 1 - first;
    const int64_t x = (scan->sum[last + 1].x - scan->sum[first].x) / n;
    const int64_t y = (scan->sum[last + 1].y - scan->sum[first].y) / n;
    const circle_sums_t s = sums_about(scan, first, last, (mean_t){x, y});
    const unsigned p = excess_bits(s.uu + s.vv);
    const unsigned q = excess_bits(ale_abs64(s.uz) + ale_abs64(s.vz));
    const int64_t uu = ale_round_shift(s.uu, p);
    const int64_t uv = ale_round_shift(s.uv, p);
    const int64_t vv = ale_round_shift(s.vv, p);
    const int64_t uz = ale_round_shift(s.uz, q);
    const int64_t vz = ale_round_shift(s.vz, q);
    /* 2 [uu uv; uv vv] (a, b) = (uz, vz); z is Q4, so the centre comes out in Q4 after a shift by 4 */
    const int64_t det = uu * vv - uv * uv;
    const int32_t scale = (int32_t)q - (int32_t)p + ALE_POINT_SHIFT - 1;
    if (det <= 0) {
        return none;
    }
    const int64_t a = scaled_ratio(uz * vv - vz * uv, det, scale);
    const int64_t b = scaled_ratio(vz * uu - uz * uv, det, scale);
    if (ale_abs64(a) > MAX_RADIUS_Q4 || ale_abs64(b) > MAX_RADIUS_Q4) {
        return none;
    }
    const uint32_t radius = ale_isqrt((uint64_t)(((s.z / n) << ALE_POINT_SHIFT) + a * a + b * b));
    const ale_circle_t circle = {x + a, y + b, radius <= MAX_RADIUS_Q4 ? radius : 0};
    return circle;
}

int64_t ale_circle_sse_q8(const ale_prepared_scan_t *scan, const ale_circle_t *circle, int32_t first,
                          int32_t last)
{
    const ale_circle_t c = *circle;
    const int64_t radius2 = c.radius_q4 * c.radius_q4;
    int64_t sum = 0;
    for (int32_t i = first; i <= last; i++) {
        const int64_t u = scan->points.x_q4[i] - c.x_q4;
        const int64_t v = scan->points.y_q4[i] - c.y_q4;
        const int64_t d = (u * u + v * v - radius2) / (2 * c.radius_q4);
        const int64_t bounded = ale_clamp64(d, -MAX_DISTANCE_Q4, MAX_DISTANCE_Q4);
        sum += bounded * bounded;
    }
    return sum;
}
