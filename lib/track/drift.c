#include "track/drift.h"

#include "base/fixed.h"

/* What a scan's surfaces add that its covariance does not know: (um)^2 and (urad)^2. */
enum { STEP_UM2 = 9000000, STEP_URAD2 = 800000 };

ale_drift_t ale_drift_here(const ale_local_map_t *map, const ale_view_t view[], uint32_t count,
                           const ale_fit_t *fit, ale_drift_t before)
{
    ale_drift_t sum = {0, 0};
    int64_t weight_mm = 0;
    for (uint32_t i = 0; i < count; i++) {
        if (fit->match[i].wall != ALE_NO_WALL && view[i].kind == ALE_VIEW_WALL) {
            const ale_drift_t *d = &map->wall[fit->match[i].wall].drift;
            const int64_t w_mm = ale_max64(((int64_t)view[i].end_um - view[i].start_um) / 1000, 1);
            sum.var_um2 += ale_min64(d->var_um2, ALE_DRIFT_MOST) * w_mm;
            sum.var_urad2 += ale_min64(d->var_urad2, ALE_DRIFT_MOST) * w_mm;
            weight_mm += w_mm;
        }
    }
    return weight_mm > 0 ? (ale_drift_t){sum.var_um2 / weight_mm, sum.var_urad2 / weight_mm} : before;
}

ale_drift_t ale_drift_of_new_wall(ale_drift_t here, const ale_matrix_t *cov)
{
    const int64_t position_um2 = (cov->m[0][0] + cov->m[1][1]) / 2;
    return (ale_drift_t){ale_min64(here.var_um2 + position_um2 + STEP_UM2, ALE_DRIFT_MOST),
                         ale_min64(here.var_urad2 + cov->m[2][2] + STEP_URAD2, ALE_DRIFT_MOST)};
}
