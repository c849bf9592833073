/* Symmetric systems of six unknowns in integers: the pose and the velocity of the robot.
 *
 * A matrix is scaled by powers of two to a diagonal of one before it is factored (LDL^T, Q60), so that
 * micrometres and microradians of any size may stand in one matrix; right-hand sides are block-floating.
 * All loops have constant length. Twin: Eigen's LDLT in tests/lib/motion/test_matrix.cpp. */
#ifndef ALE_MOTION_MATRIX_H
#define ALE_MOTION_MATRIX_H

#include <stdbool.h>
#include <stdint.h>

enum { ALE_STATES = 6 };

typedef struct {
    int64_t m[ALE_STATES][ALE_STATES];
} ale_matrix_t;

/* The factors of a matrix; private to matrix.c. */
typedef struct {
    int64_t lower_q40[ALE_STATES][ALE_STATES];
    int64_t reciprocal[ALE_STATES]; /* of the pivot: 2^31..2^32 */
    uint8_t reciprocal_bits[ALE_STATES];
    uint8_t scale_bits[ALE_STATES];
} ale_factors_t;

/* Factors a symmetric positive matrix (lower half is read). Pivots below 2^-30 of their diagonal are
 * lifted to that, and what hangs on them is left out; returns how many were: 0 for a matrix that is well
 * determined. Diagonal >= 0. */
uint32_t ale_matrix_factor(const ale_matrix_t *a, ale_factors_t *out);

/* x * 2^shift with a x = b; shift 0..60. Saturates instead of overflowing. */
void ale_matrix_solve(const ale_factors_t *factors, const int64_t b[ALE_STATES], int32_t shift,
                      int64_t x[ALE_STATES]);

/* Inverse of a factored matrix, times 2^shift: symmetric. */
void ale_matrix_invert(const ale_factors_t *factors, int32_t shift, ale_matrix_t *out);

/* Square root of a variance on the diagonal. */
int64_t ale_matrix_sigma(const ale_matrix_t *cov, int axis);

/* f p f^T with f in Q20; the result is symmetric. p and out may not be the same. */
void ale_matrix_congruence(const int64_t f_q20[ALE_STATES][ALE_STATES], const ale_matrix_t *p,
                           ale_matrix_t *out);

#endif
