#include "track/uncertainty.h"

#include "base/fixed.h"

/* What the drift of the heading does to a place x, y from the origin. */
static void add_lever(ale_matrix_t *cov, int64_t var_urad2, ale_point_t p)
{
    const int64_t x_mm = p.x_um / 1000;
    const int64_t y_mm = p.y_um / 1000;
    cov->m[0][0] += ale_mul_div(var_urad2, y_mm * y_mm, 3000000);
    cov->m[1][1] += ale_mul_div(var_urad2, x_mm * x_mm, 3000000);
    cov->m[0][1] -= ale_mul_div(var_urad2, x_mm * y_mm, 3000000);
    cov->m[0][2] -= ale_mul_div(var_urad2, y_mm, 2000);
    cov->m[1][2] += ale_mul_div(var_urad2, x_mm, 2000);
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < i; j++) {
            cov->m[i][j] = cov->m[j][i];
        }
    }
}

void ale_map_covariance(const ale_motion_t *motion, const ale_drift_here_t *drift, int64_t out[9])
{
    ale_matrix_t turned;
    ale_motion_map_covariance(motion, &turned);
    turned.m[0][0] += drift->xx_um2;
    turned.m[0][1] += drift->xy_um2;
    turned.m[1][1] += drift->yy_um2;
    turned.m[2][2] += drift->var_urad2;
    add_lever(&turned, drift->var_urad2, (ale_point_t){motion->pose.x_um, motion->pose.y_um});
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            const int64_t to_nrad = (i == 2 ? 1000LL : 1LL) * (j == 2 ? 1000 : 1);
            out[3 * i + j] = turned.m[i][j] * to_nrad;
        }
    }
}

void ale_scan_information(const ale_information_t *sum, int64_t out[6])
{
    const int64_t(*m)[ALE_STATES] = sum->matrix.m;
    const int64_t in[6] = {m[0][0], m[1][0], m[2][0], m[1][1], m[2][1], m[2][2]};
    for (int i = 0; i < 6; i++) {
        /* 1/um^2 in Q54 becomes 1/mm^2 in Q20, microradians at a metre milliradians */
        out[i] = ale_mul_shift(in[i], 1000000, ALE_MATRIX_BITS - 20);
    }
}
