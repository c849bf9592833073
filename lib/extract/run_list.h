/* The runs of a scan, in the order of its points, and what has been spent on them. A run is a range of
 * points, both ends included, that is to be a line or a curve. */
#ifndef ALE_EXTRACT_RUN_LIST_H
#define ALE_EXTRACT_RUN_LIST_H

#include <stdbool.h>
#include <stdint.h>

#include "extract/features.h"
#include "extract/moments.h"

/* Fewest points that ALE fits a line to while it searches; shorter runs say nothing about a line. */
#define ALE_MIN_RUN 5
#define ALE_COSTLY_RUN 12 /* the same in a costly scan */
#define ALE_MAX_RUNS (ALE_MAX_BEAMS / ALE_MIN_RUN)

/* Rooms have up to 22 runs: more is clutter, of which only the most needed is made, for the time is bounded.
 * In a costly scan a third of them is. */
#define ALE_MANY_RUNS 24

/* The search of a room takes fewer fits. */
#define ALE_MANY_SEARCH_FITS 144

/* A room is searched and made good with less effort, in residual sums of runs; a suspect costs as much,
 * a fit of the search twice that. */
#define ALE_MOST_EFFORT 840

typedef struct {
    uint16_t first;
    uint16_t last;
    bool curved;
    bool no_arc;       /* tried: lines explain it better than a circle */
    bool no_break;     /* tried: one line explains it as well as two */
    bool no_curve;     /* all of the scan were asked for curves as this one is, and none was found */
    bool settled;      /* its ends have hardly moved when they were placed */
    ale_run_fit_t fit; /* see ale_fit_of_run */
    int64_t join_q8;   /* whether one line explains it and the next one: scratch of ale_merge_runs */
} ale_run_t;

typedef struct {
    ale_prepared_scan_t scan;

    /* Set once: fewest points of a line, and the largest chi square that a true line of n points has, Q8:
     * bounds of the floating threshold. */
    uint16_t min_points;
    int32_t chi_low_q8[ALE_MAX_BEAMS + 1];
    int32_t chi_high_q8[ALE_MAX_BEAMS + 1];

    int32_t search_fits; /* of the last search */
    int32_t effort; /* so far, in residual sums of runs; asked for between passes over all runs, so that a
                     * mirrored scan is treated alike */
    uint16_t count;
    ale_run_t run[ALE_MAX_RUNS];
    uint16_t refused[ALE_REFUSALS];
} ale_run_list_t;

/* Sets what is set once. min_points: ALE_MIN_RUN..ALE_MAX_BEAMS. O(ALE_MAX_BEAMS). */
void ale_run_list_init(ale_run_list_t *list, uint16_t min_points);

/* Whether the scan costs more than one of surfaces does: the range changes everywhere, or lines are hard to
 * find. What is done for it is bounded more narrowly. */
static inline bool ale_costly(const ale_run_list_t *list)
{
    return list->scan.segments.unruly || list->search_fits > ALE_MANY_SEARCH_FITS ||
           list->count > ALE_MANY_RUNS;
}

/* More than a room asks for: what was found so far has to do. */
static inline bool ale_effort_is_spent(const ale_run_list_t *list)
{
    return list->effort > ALE_MOST_EFFORT;
}

/* An end of the run has moved, or the noise has changed: what is known of it holds no longer. */
static inline void ale_run_changed(ale_run_t *run)
{
    run->fit.n = 0;
    run->no_arc = false;
    run->no_break = false;
    run->no_curve = false;
    run->settled = false;
}

/* The fit of a run, computed when it is asked for the first time. */
static inline const ale_run_fit_t *ale_fit_of_run(const ale_prepared_scan_t *scan, ale_run_t *run)
{
    if (run->fit.n == 0) {
        run->fit = ale_moments_fit(scan, run->first, run->last);
    }
    return &run->fit;
}

/* The points have moved: their runs are to be fitted anew. O(runs). */
void ale_run_list_forget_fits(ale_run_list_t *list);

/* Drops the runs of fewer points, and where `enough` longer ones are there all that are shorter than those,
 * too, or as long and farther from the middle of the points: one more than enough are kept at most, where two
 * lie alike on either side of it. Dropped ones are counted as refused. O(runs log beams). */
void ale_run_list_drop_short(ale_run_list_t *list, int32_t fewest, int32_t enough);

#endif
