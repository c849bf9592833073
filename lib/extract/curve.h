/* Curved surfaces, told from chains of lines. */
#ifndef ALE_EXTRACT_CURVE_H
#define ALE_EXTRACT_CURVE_H

#include "extract/run_list.h"

/* Finds the runs that lie on a curve, joins those of one curve and marks it (run.curved): a run whose
 * middle stands out from its ends, or a chain of adjoining runs that turn the same way and bulge the way
 * they turn, when a circle explains the points as well as lines do. again: they were looked for before, so
 * that few runs are left to be tried. O(runs) and O(points) of the suspects. */
void ale_curve_find(ale_run_list_t *r, bool again);

/* The circle through the points of a run, in the frame of the points. O(points). */
void ale_curve_fit(const ale_prepared_scan_t *scan, ale_segment_t run, ale_curve_t *curve);

#endif
