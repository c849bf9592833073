/* Robust lowess: paper III.A, (8) to (10). Locally weighted regression of the first degree with tri-cube
 * weights, then passes with bisquare weights that switch outliers off.
 *
 * Corrections: the window reaches to the first beam outside, so that the farthest neighbour keeps a weight
 * ((8) gives it 0); M of (9) has a floor, for it is 0 where a third of neighbouring values are equal. */
#ifndef ALE_EXTRACT_LOWESS_H
#define ALE_EXTRACT_LOWESS_H

#include <stdint.h>

#include "base/histogram.h"
#include "base/limits.h"

/* Widest window, beams. */
#define ALE_MAX_SPAN 31

/* Scratch memory; contents mean nothing between calls. */
typedef struct {
    uint16_t robust_q8[ALE_MAX_BEAMS];
    uint16_t bins[ALE_HISTOGRAM_BINS];
} ale_lowess_work_t;

typedef struct {
    uint16_t span;     /* odd, 1..ALE_MAX_SPAN: beams of the window; 1 copies */
    uint8_t passes;    /* robust passes at most; a pass ends the work when no residual asks for another */
    int32_t mad_floor; /* least median of the residuals that is believed, unit of the values; >= 1 */
} ale_lowess_config_t;

/* Smooths count values of one segment. beam: their strictly ascending beams; |value| < 2^30, and within one
 * window they must differ by less than 2^26 (what differs more is held at that). smooth may not be value.
 * Work: O(count * span * (1 + passes)). A mirrored segment gives the mirrored result. */
void ale_lowess(const ale_lowess_config_t *config, const uint16_t *beam, const int32_t *value, int32_t count,
                int32_t *smooth, ale_lowess_work_t *work);

#endif
