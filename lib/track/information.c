#include "track/information.h"

#include "base/fixed.h"
#include "base/trig.h"

enum {
    WEIGHT_BITS = 38,
    ONE_Q20 = 1 << 20,
    POSITION_BITS = 29, /* of the position's information while its directions are compared */
    CERTAIN = 4096      /* directions that differ by less than this factor are all known */
};

void ale_information_add(ale_information_t *sum, const int64_t row_q14[ALE_STATES], int64_t error,
                         int64_t var)
{
    const int64_t weight_q38 = ((int64_t)1 << WEIGHT_BITS) / ale_max64(var, ALE_ROW_VAR_MIN_UM2);
    for (int i = 0; i < ALE_STATES; i++) {
        const int64_t w = weight_q38 * row_q14[i];
        if (w == 0) {
            continue;
        }
        sum->gradient[i] -= ale_mul_shift(w, error, WEIGHT_BITS + ALE_ROW_BITS - ALE_GRADIENT_BITS);
        for (int j = 0; j <= i; j++) {
            sum->matrix.m[i][j] +=
                ale_round_shift(w * row_q14[j], WEIGHT_BITS + 2 * ALE_ROW_BITS - ALE_MATRIX_BITS);
        }
    }
}

/* A direction of the robot's frame and what is left of the information along it, as a root. */
typedef struct {
    int64_t x_q20;
    int64_t y_q20;
    int64_t lost_q20;
} doubtful_t;

/* The direction of the position that is known least. False when it is known well enough to leave alone. */
static bool find_doubtful(const ale_information_t *sum, doubtful_t *out)
{
    const ale_matrix_t *m = &sum->matrix;
    const unsigned bits = ale_bit_length((uint64_t)(m->m[0][0] + m->m[1][1]));
    const unsigned drop = bits > POSITION_BITS ? bits - POSITION_BITS : 0;
    const int64_t xx = ale_round_shift(m->m[0][0], drop);
    const int64_t xy = ale_round_shift(m->m[1][0], drop);
    const int64_t yy = ale_round_shift(m->m[1][1], drop);
    const int64_t trace = xx + yy;
    const int64_t det = ale_max64(xx * yy - xy * xy, 0);
    if (trace == 0 || det > trace * trace / CERTAIN) {
        return false;
    }
    /* ratio of the lesser eigenvalue to the greater, and of what is doubted to the lesser */
    const int64_t doubted =
        trace * trace / (1000000000000 / ((int64_t)ALE_WALL_DIRECTION_URAD * ALE_WALL_DIRECTION_URAD));
    const int64_t kept_q40 =
        det > doubted ? ((int64_t)1 << 40) - ale_mul_div(doubted, (int64_t)1 << 40, det) : 0;
    const uint32_t along_bam = ale_atan2_bam(2 * xy, xx - yy) / 2 + ALE_BAM_QUARTER_TURN;
    const ale_direction_t along = ale_direction(along_bam);
    *out = (doubtful_t){ale_round_shift(along.cos_q30, 10), ale_round_shift(along.sin_q30, 10),
                        ONE_Q20 - ale_isqrt((uint64_t)kept_q40)};
    return true;
}

static void shorten(const doubtful_t *d, int64_t *x, int64_t *y)
{
    const int64_t along = ale_mul_shift(*x, d->x_q20, 20) + ale_mul_shift(*y, d->y_q20, 20);
    const int64_t lost = ale_mul_shift(along, d->lost_q20, 20);
    *x -= ale_mul_shift(lost, d->x_q20, 20);
    *y -= ale_mul_shift(lost, d->y_q20, 20);
}

void ale_information_doubt_directions(ale_information_t *sum)
{
    doubtful_t d;
    if (!find_doubtful(sum, &d)) {
        return;
    }
    int64_t(*m)[ALE_STATES] = sum->matrix.m;
    m[0][1] = m[1][0];
    for (int i = 0; i < ALE_STATES; i++) {
        if (i > 1) {
            shorten(&d, &m[i][0], &m[i][1]);
        } else {
            shorten(&d, &m[0][i], &m[1][i]);
        }
    }
    shorten(&d, &m[0][0], &m[0][1]);
    shorten(&d, &m[1][0], &m[1][1]);
    m[0][1] = 0;
    shorten(&d, &sum->gradient[0], &sum->gradient[1]);
}

/* Sylvester: information - 1/sigma^2 is positive when its pivots are. */
bool ale_information_determines(const ale_information_t *sum, int64_t sigma_um)
{
    const int64_t least = ((int64_t)1 << ALE_MATRIX_BITS) / (sigma_um * sigma_um);
    ale_matrix_t rest = {{{0}}};
    ale_factors_t factors;
    for (int i = 0; i < ALE_STATES; i++) {
        rest.m[i][i] = 1;
    }
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < i; j++) {
            rest.m[i][j] = sum->matrix.m[i][j];
        }
        rest.m[i][i] = sum->matrix.m[i][i] - least;
        if (rest.m[i][i] <= 0) {
            return false;
        }
    }
    return ale_matrix_factor(&rest, &factors) == 0;
}
