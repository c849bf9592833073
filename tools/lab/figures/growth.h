/* How the error of a fitted line grows as points are added, and between which bounds the extractor's
 * threshold floats. */
#ifndef ALE_LAB_FIGURES_GROWTH_H
#define ALE_LAB_FIGURES_GROWTH_H

#include <stdint.h>

#include "base/scan.h"
#include "extract/extract.h"

typedef struct {
    uint16_t beam; /* last beam of the run */
    uint16_t points;
    double rmse_mm;
    double low_mm; /* bounds of the threshold that the noise model sets for a run of so many points */
    double high_mm;
} figures_growth_t;

/* Runs from the first point of the scan on, 5 points and more, in the moments of libale. The noise model must
 * have no shared part: it would raise the bounds further. Returns the number of entries, or -1 as
 * ale_extractor_init. */
int figures_growth(const ale_scan_t *scan, const ale_extract_config_t *config,
                   figures_growth_t growth[ALE_MAX_BEAMS]);

#endif
