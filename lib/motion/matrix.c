#include "motion/matrix.h"

#include "base/fixed.h"

enum { UNIT_BITS = 60, LOWER_BITS = 40, SMALLEST_PIVOT_BITS = 30, RIGHT_SIDE_BITS = 40 };

/* v * 2^bits, rounded; bits from -126 to 62; saturates. */
static int64_t scaled(int64_t v, int32_t bits)
{
    return bits < 0 ? ale_mul_shift(v, 1, (unsigned)ale_min64(-bits, 126))
                    : ale_mul_shift(v, (int64_t)1 << ale_min64(bits, 62), 0);
}

/* Entries of a scaled positive matrix are at most one; rounding may have made it otherwise. */
static int64_t within(int64_t v_q60)
{
    const int64_t most = (int64_t)1 << (UNIT_BITS + 1);
    return ale_clamp64(v_q60, -most, most);
}

static void set_pivot(ale_factors_t *out, int j, int64_t pivot)
{
    const unsigned bits = ale_bit_length((uint64_t)pivot);
    const uint64_t mantissa = bits > 32 ? (uint64_t)pivot >> (bits - 32) : (uint64_t)pivot << (32 - bits);
    out->reciprocal[j] = (int64_t)(((uint64_t)1 << 63) / (mantissa | 1u));
    out->reciprocal_bits[j] = (uint8_t)(31 + bits);
}

uint32_t ale_matrix_factor(const ale_matrix_t *a, ale_factors_t *out)
{
    int64_t c_q60[ALE_STATES][ALE_STATES];
    uint32_t lifted = 0;
    for (int i = 0; i < ALE_STATES; i++) {
        out->scale_bits[i] = (uint8_t)((ale_bit_length((uint64_t)a->m[i][i]) + 1) / 2);
    }
    for (int j = 0; j < ALE_STATES; j++) {
        for (int i = j; i < ALE_STATES; i++) {
            int64_t v = within(scaled(a->m[i][j], UNIT_BITS - out->scale_bits[i] - out->scale_bits[j]));
            for (int k = 0; k < j; k++) {
                v = within(v - within(ale_mul_shift(out->lower_q40[i][k], c_q60[j][k], LOWER_BITS)));
            }
            c_q60[i][j] = v;
        }
        const bool weak = c_q60[j][j] < (int64_t)1 << SMALLEST_PIVOT_BITS;
        set_pivot(out, j, weak ? (int64_t)1 << SMALLEST_PIVOT_BITS : c_q60[j][j]);
        lifted += weak ? 1 : 0;
        for (int i = j + 1; i < ALE_STATES; i++) {
            c_q60[i][j] = weak ? 0 : c_q60[i][j];
            out->lower_q40[i][j] = ale_mul_shift(c_q60[i][j], out->reciprocal[j],
                                                 (unsigned)out->reciprocal_bits[j] - LOWER_BITS);
        }
    }
    return lifted;
}

/* Brings the scaled right side to about 40 bits; returns the power of two that was put in. */
static int32_t normalise(const ale_factors_t *f, const int64_t b[ALE_STATES], int64_t out[ALE_STATES])
{
    int32_t top = -64;
    for (int i = 0; i < ALE_STATES; i++) {
        if (b[i] != 0) {
            const int32_t bits = (int32_t)ale_bit_length((uint64_t)ale_abs64(b[i])) - f->scale_bits[i];
            top = bits > top ? bits : top;
        }
    }
    const int32_t gain = RIGHT_SIDE_BITS - top;
    for (int i = 0; i < ALE_STATES; i++) {
        out[i] = b[i] == 0 ? 0 : scaled(b[i], gain - f->scale_bits[i]);
    }
    return gain;
}

/* What stands before it stays zero on the way down: the columns of an inverse have half of that way. */
static int first_not_zero(const int64_t b[ALE_STATES])
{
    int i = 0;
    while (i < ALE_STATES && b[i] == 0) {
        i++;
    }
    return i;
}

/* a - b. Where the factors are those of nonsense it wraps: whoever takes the solution bounds it. */
static inline int64_t less(int64_t a, int64_t b)
{
    return (int64_t)((uint64_t)a - (uint64_t)b);
}

void ale_matrix_solve(const ale_factors_t *factors, const int64_t b[ALE_STATES], int32_t shift,
                      int64_t x[ALE_STATES])
{
    int64_t y[ALE_STATES];
    const int32_t gain = normalise(factors, b, y);
    const int first = first_not_zero(b);
    for (int i = first + 1; i < ALE_STATES; i++) {
        for (int k = first; k < i; k++) {
            y[i] = less(y[i], ale_mul_shift(factors->lower_q40[i][k], y[k], LOWER_BITS));
        }
    }
    for (int i = first; i < ALE_STATES; i++) {
        const int32_t bits = (int32_t)factors->reciprocal_bits[i] - UNIT_BITS;
        y[i] = ale_mul_shift(y[i], factors->reciprocal[i], (unsigned)bits);
    }
    for (int i = ALE_STATES - 1; i >= 0; i--) {
        for (int k = i + 1; k < ALE_STATES; k++) {
            y[i] = less(y[i], ale_mul_shift(factors->lower_q40[k][i], y[k], LOWER_BITS));
        }
    }
    for (int i = 0; i < ALE_STATES; i++) {
        x[i] = scaled(y[i], shift - gain - factors->scale_bits[i]);
    }
}

void ale_matrix_invert(const ale_factors_t *factors, int32_t shift, ale_matrix_t *out)
{
    int64_t column[ALE_STATES][ALE_STATES];
    for (int j = 0; j < ALE_STATES; j++) {
        int64_t unit[ALE_STATES] = {0};
        unit[j] = 1;
        ale_matrix_solve(factors, unit, shift, column[j]);
    }
    for (int i = 0; i < ALE_STATES; i++) {
        for (int j = 0; j <= i; j++) {
            out->m[i][j] = out->m[j][i] = column[i][j] / 2 + column[j][i] / 2;
        }
    }
}

void ale_matrix_congruence(const int64_t f_q20[ALE_STATES][ALE_STATES], const ale_matrix_t *p,
                           ale_matrix_t *out)
{
    int64_t fp[ALE_STATES][ALE_STATES];
    for (int i = 0; i < ALE_STATES; i++) {
        for (int j = 0; j < ALE_STATES; j++) {
            fp[i][j] = 0;
            for (int k = 0; k < ALE_STATES; k++) {
                fp[i][j] += f_q20[i][k] == 0 ? 0 : ale_mul_shift(f_q20[i][k], p->m[k][j], 20);
            }
        }
    }
    for (int i = 0; i < ALE_STATES; i++) {
        for (int j = 0; j <= i; j++) {
            int64_t sum = 0;
            for (int k = 0; k < ALE_STATES; k++) {
                sum += f_q20[j][k] == 0 ? 0 : ale_mul_shift(fp[i][k], f_q20[j][k], 20);
            }
            out->m[i][j] = out->m[j][i] = sum;
        }
    }
}

int64_t ale_matrix_sigma(const ale_matrix_t *cov, int axis)
{
    return (int64_t)ale_isqrt((uint64_t)ale_max64(cov->m[axis][axis], 0));
}
