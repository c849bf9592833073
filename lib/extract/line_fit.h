/* The final fit of a line on the raw points, in normal form by total least squares, with its covariance. */
#ifndef ALE_EXTRACT_LINE_FIT_H
#define ALE_EXTRACT_LINE_FIT_H

#include "extract/features.h"
#include "extract/moments.h"

/* Fits the points of the run. Everything of *line but the kinds of its ends is set. Returns what the fit says
 * of the run, for the decision whether it is a line. */
ale_run_fit_t ale_line_fit(const ale_prepared_scan_t *scan, ale_segment_t run, ale_line_t *line);

#endif
