#include "match/information.h"

#include "base/fixed.h"

enum { WEIGHT_BITS = 38 };

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

/* Sylvester: information - 1/sigma^2 is positive when its pivots are. */
bool ale_information_determines(const ale_information_t *sum, int64_t sigma_um)
{
    const int64_t least = ((int64_t)1 << ALE_MATRIX_BITS) / (sigma_um * sigma_um);
    ale_matrix_t excess = {{{0}}};
    ale_factors_t factors;
    for (int i = 0; i < ALE_STATES; i++) {
        excess.m[i][i] = 1;
    }
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < i; j++) {
            excess.m[i][j] = sum->matrix.m[i][j];
        }
        excess.m[i][i] = sum->matrix.m[i][i] - least;
        if (excess.m[i][i] <= 0) {
            return false;
        }
    }
    return ale_matrix_factor(&excess, &factors) == 0;
}
