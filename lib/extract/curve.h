/* Curved surfaces, told from chains of lines. */
#ifndef ALE_EXTRACT_CURVE_H
#define ALE_EXTRACT_CURVE_H

#include "extract/workspace.h"

/* Marks in curved[] the runs that lie on a curve: a run whose middle stands out from its ends, and chains
 * of adjoining runs that turn the same way and bulge the way they turn. O(runs). */
void ale_curve_mark(const ale_extractor_t *e, bool curved[ALE_MAX_RUNS]);

/* The circle through the points first..last, in the frame of the points. O(points). */
void ale_curve_fit(const ale_extractor_t *e, int32_t first, int32_t last, ale_curve_t *curve);

#endif
