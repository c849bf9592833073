#include "match/odometry_scale_error.h"

#include "base/fixed.h"
#include "base/trig.h"

/* Bound of the shift, either way. */
static const int64_t most_um = 1000000;

void ale_scale_error_predict(ale_scale_error_t *scale_error, ale_pose_t from, ale_pose_t to,
                             int64_t error_ppm)
{
    const int64_t x_um =
        scale_error->x_um + ale_round_div(((int64_t)to.x_um - from.x_um) * error_ppm, 1000000);
    const int64_t y_um =
        scale_error->y_um + ale_round_div(((int64_t)to.y_um - from.y_um) * error_ppm, 1000000);
    scale_error->x_um = ale_clamp64(x_um, -most_um, most_um);
    scale_error->y_um = ale_clamp64(y_um, -most_um, most_um);
}

/* A direction in Q20. */
typedef struct {
    int64_t x;
    int64_t y;
} axis_t;

static axis_t axis(uint32_t bam)
{
    const ale_direction_t d = ale_direction(bam);
    return (axis_t){ale_round_shift(d.cos_q30, 10), ale_round_shift(d.sin_q30, 10)};
}

static int64_t along(axis_t a, int64_t x, int64_t y)
{
    return ale_mul_shift(x, a.x, 20) + ale_mul_shift(y, a.y, 20);
}

/* x^T S x of a symmetric matrix. */
static int64_t squared(axis_t a, int64_t xx, int64_t xy, int64_t yy)
{
    return along(a, along(a, xx, xy), along(a, xy, yy));
}

/* What remains of the shift along a principal axis of the scan's information. */
static int64_t remaining_um(const ale_scale_error_t *scale_error, const ale_observability_t *observability,
                            const ale_motion_t *predicted, uint32_t bam)
{
    const axis_t a = axis(bam);
    const ale_matrix_t *cov = &predicted->cov;
    const int64_t before_um = along(a, scale_error->x_um, scale_error->y_um);
    const int64_t weight_q20 =
        squared(a, observability->xx_q20, observability->xy_q20, observability->yy_q20);
    if (weight_q20 <= 0) {
        return before_um;
    }
    const int64_t walls_um =
        ale_round_div(along(a, observability->bias_x_q20, observability->bias_y_q20), weight_q20);
    const int64_t var_um2 =
        squared(axis(bam - predicted->pose.theta_bam), cov->m[0][0], cov->m[0][1], cov->m[1][1]);
    const int64_t share_q20 =
        ale_mul_div((int64_t)1 << 20, (int64_t)1 << 20,
                    ((int64_t)1 << 20) +
                        ale_min64(ale_mul_div(ale_max64(var_um2, 0), weight_q20, 1000000), (int64_t)1 << 40));
    return walls_um + ale_mul_shift(before_um - walls_um, share_q20, 20);
}

void ale_scale_error_update(ale_scale_error_t *scale_error, const ale_observability_t *observability,
                            const ale_motion_t *predicted)
{
    /* Along the principal axes of the walls' information: along others it would mix the two directions. */
    const uint32_t along_bam =
        ale_atan2_bam(2 * observability->xy_q20, observability->xx_q20 - observability->yy_q20) / 2;
    const int64_t u_um = remaining_um(scale_error, observability, predicted, along_bam);
    const int64_t v_um =
        remaining_um(scale_error, observability, predicted, along_bam + ALE_BAM_QUARTER_TURN);
    const axis_t u = axis(along_bam);
    scale_error->x_um = ale_clamp64(along(u, u_um, -v_um), -most_um, most_um);
    scale_error->y_um = ale_clamp64(along(u, v_um, u_um), -most_um, most_um);
}
