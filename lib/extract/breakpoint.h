/* Where one line ends and the next begins: paper III.B and III.D. */
#ifndef ALE_EXTRACT_BREAKPOINT_H
#define ALE_EXTRACT_BREAKPOINT_H

#include "extract/run_list.h"

/* Binary search, from point `from` towards `to` (either direction), for the last point of the line that
 * begins at `from`. Returns it and its fit, or from when not even the shortest run is a line. O(log n) fits.
 */
int32_t ale_break_search(ale_run_list_t *r, int32_t from, int32_t to, ale_run_fit_t *accepted);

/* First step where a break is known from a search alone, and where it was placed before. */
enum { ALE_BREAK_WIDE_STEP = 8, ALE_BREAK_FINE_STEP = 1 };

/* Where a break may lie (last point of the first run), where the search for it starts, and in which
 * direction the points are read: that decides between equals. */
typedef struct {
    int32_t lowest;
    int32_t highest;
    int32_t start;
    int32_t direction;
    int32_t widest_step; /* first step of the search, a power of two */
} ale_break_range_t;

/* The break between two neighbouring runs, which are the points of both, by the best joint fit, each in its
 * own variance: a pattern search, 9 joint fits at most for each power of two. From there to where both lines
 * meet, unless that fits worse than noise makes it. range->start where the range is empty. a, b: the runs'
 * fits as they are known. */
int32_t ale_break_place(ale_run_list_t *r, ale_segment_t both, const ale_run_fit_t *a, const ale_run_fit_t *b,
                        const ale_break_range_t *range);

/* Whether a run has more than its noise: else it need not be tried for a break. */
bool ale_break_suspicious(const ale_run_fit_t *one);

/* The break that splits a run in two lines which explain it better than one by more than noise would
 * (merge.h), or -1. The same break in both directions. O(log n) fits. */
int32_t ale_break_find(ale_run_list_t *r, ale_run_t *run, int32_t direction);

/* Chi square of the two best lines less that of one, Q8: 0 or negative. */
int64_t ale_break_gain_q8(ale_run_list_t *r, ale_run_t *run);

#endif
