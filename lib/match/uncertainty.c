#include "match/uncertainty.h"

#include "base/fixed.h"

void ale_map_covariance(const ale_motion_t *motion, const ale_map_uncertainty_t *map_uncertainty,
                        const ale_scale_error_t *scale_error, int64_t out[9])
{
    ale_matrix_t turned;
    ale_motion_map_covariance(motion, &turned);
    const ale_map_uncertainty_t at =
        ale_map_uncertainty_at(map_uncertainty, (ale_point_t){motion->pose.x_um, motion->pose.y_um});
    const int64_t x_um = scale_error->x_um;
    const int64_t y_um = scale_error->y_um;
    const int64_t off[3][3] = {{at.xx_um2 + x_um * x_um, at.xy_um2 + x_um * y_um, at.xt_um_urad},
                               {at.xy_um2 + x_um * y_um, at.yy_um2 + y_um * y_um, at.yt_um_urad},
                               {at.xt_um_urad, at.yt_um_urad, at.tt_urad2}};
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            const int64_t to_nrad = (i == 2 ? 1000LL : 1LL) * (j == 2 ? 1000 : 1);
            out[3 * i + j] = (turned.m[i][j] + off[i][j]) * to_nrad;
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
