#include "lab/figures/growth.h"

#include <math.h>
#include <stdlib.h>

#include "extract/moments.h"
#include "extract/workspace.h"

static double rms_mm(double sum_q8, int32_t points)
{
    return sqrt(sum_q8 / 256 / points);
}

int figures_growth(const ale_scan_t *scan, const ale_extract_config_t *config,
                   figures_growth_t growth[ALE_MAX_BEAMS])
{
    ale_extractor_t *e = calloc(1, sizeof *e);
    ale_features_t *features = calloc(1, sizeof *features);
    int entries = -1;
    if (e != NULL && features != NULL && ale_extractor_init(e, config) == 0) {
        ale_extract_scan(e, scan, NULL, features);
        entries = 0;
        const ale_prepared_scan_t *prepared = &e->runs.scan;
        for (int32_t last = ALE_MIN_RUN - 1; last < prepared->points.count; last++) {
            const ale_run_fit_t fit = ale_moments_fit(prepared, 0, last);
            const double variance = (double)fit.var_q8 / 256;
            growth[entries++] = (figures_growth_t){
                prepared->points.beam[last],
                (uint16_t)fit.n,
                rms_mm((double)fit.sse_q8, fit.n),
                rms_mm(variance * e->runs.chi_low_q8[fit.n], fit.n),
                rms_mm(variance * e->runs.chi_high_q8[fit.n], fit.n),
            };
        }
    }
    free(e);
    free(features);
    return entries;
}
