/* Normal equations of the registration, and what they determine.
 *
 * Rows are scalar errors, in um or urad, with a derivative by the six states in Q14 (um per um, um per
 * urad, and the same per tick of time) and a variance. The sums keep matrix in Q54 and gradient in Q40
 * of 1/um^2: rows of variance 0.25 mm^2 and more, levers to 80 m and a thousand rows fit. */
#ifndef ALE_MATCH_INFORMATION_H
#define ALE_MATCH_INFORMATION_H

#include <stdbool.h>
#include <stdint.h>

#include "motion/matrix.h"

enum { ALE_MATRIX_BITS = 54, ALE_GRADIENT_BITS = 40, ALE_ROW_BITS = 14, ALE_ROW_VAR_MIN_UM2 = 250000 };

enum { ALE_DETERMINED_UM = 30000 }; /* a direction that a scan alone knows better than this is determined */

typedef struct {
    ale_matrix_t matrix; /* lower half */
    int64_t gradient[ALE_STATES];
} ale_information_t;

/* Adds a row. var >= ALE_ROW_VAR_MIN_UM2 (lifted to it), |error| up to 2 m. */
void ale_information_add(ale_information_t *sum, const int64_t row_q14[ALE_STATES], int64_t error,
                         int64_t var);

/* Whether the scan alone determines every direction of the pose better than sigma (um, and urad at a
 * lever of one metre): all eigenvalues of the pose's information above 1/sigma^2. */
bool ale_information_determines(const ale_information_t *sum, int64_t sigma_um);

#endif
