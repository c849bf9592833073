#include "lab/inspect/trace.h"

#include <stdlib.h>
#include <string.h>

#include "base/pose.h"
#include "extract/breakpoint.h"
#include "extract/points.h"
#include "extract/workspace.h"

enum { UM_PER_Q4_NUMERATOR = 1000, Q4 = 16 };

static int32_t um(int32_t q4)
{
    return (int32_t)((int64_t)q4 * UM_PER_Q4_NUMERATOR / Q4);
}

/* The extractor works in a frame that looks along the middle of its points. */
static void copy_points(const ale_extractor_t *e, inspect_trace_t *trace)
{
    const ale_points_t *points = &e->runs.scan.points;
    const ale_direction_t frame = ale_direction(points->frame_bam);
    trace->points = points->count;
    for (int32_t i = 0; i < points->count; i++) {
        trace->beam[i] = ale_points_beam(points, i);
        const ale_point_t p = ale_turn((ale_point_t){um(points->x_q4[i]), um(points->y_q4[i])}, frame);
        trace->x_um[i] = p.x_um;
        trace->y_um[i] = p.y_um;
        trace->segment_ends[i] = e->runs.scan.segments.jump_after[i];
    }
    trace->runs = e->runs.count;
    for (int32_t k = 0; k < e->runs.count; k++) {
        trace->run[k].first = e->runs.run[k].first;
        trace->run[k].last = e->runs.run[k].last;
    }
}

/* A bisection's steps follow from where it ended: it accepted exactly the guesses up to there. */
static void add_steps(inspect_trace_t *trace, int32_t from, int32_t direction, int32_t size, int32_t found)
{
    int32_t left = ALE_MIN_RUN - 1;
    int32_t right = size;
    while (right - left > 1 && trace->steps < INSPECT_MAX_STEPS) {
        const int32_t guess = (left + right) / 2;
        const bool accepted = guess <= found;
        trace->step[trace->steps++] = (inspect_step_t){(uint16_t)from,  (int16_t)direction, (uint16_t)left,
                                                       (uint16_t)right, (uint16_t)guess,    accepted};
        *(accepted ? &left : &right) = guess;
    }
}

static void search_again(ale_run_list_t *runs, int32_t first, int32_t last, inspect_trace_t *trace)
{
    const int32_t direction = ale_points_reading_direction(&runs->scan.points, first, last);
    const int32_t stop = direction > 0 ? last : first;
    int32_t from = direction > 0 ? first : last;
    while ((stop - from) * direction + 1 >= ALE_MIN_RUN) {
        ale_run_fit_t fit;
        const int32_t to = ale_break_search(runs, from, stop, &fit);
        const int32_t size = (stop - from) * direction + 1;
        add_steps(trace, from, direction, size, (to - from) * direction);
        from = to + direction;
    }
}

static void search_longest_segment(ale_run_list_t *runs, inspect_trace_t *trace)
{
    int32_t best_first = 0;
    int32_t best_last = -1;
    int32_t first = 0;
    const ale_prepared_scan_t *scan = &runs->scan;
    for (int32_t i = 0; i < scan->points.count; i++) {
        if (scan->segments.jump_after[i] || i + 1 == scan->points.count) {
            if (i - first > best_last - best_first) {
                best_first = first;
                best_last = i;
            }
            first = i + 1;
        }
    }
    if (best_last >= best_first) {
        runs->search_fits = 0;
        search_again(runs, best_first, best_last, trace);
    }
}

int inspect_trace(const ale_scan_t *scan, const ale_extract_config_t *config, inspect_trace_t *trace)
{
    ale_extractor_t *e = calloc(1, sizeof *e);
    if (e == NULL || ale_extractor_init(e, config) < 0) {
        free(e);
        return -1;
    }
    memset(trace, 0, sizeof *trace);
    ale_extract_scan(e, scan, NULL, &trace->features);
    search_longest_segment(&e->runs, trace);
    trace->smoothed = config->smooth_span > 1;
    if (trace->smoothed) {
        ale_points_place_smoothed(&e->runs.scan.points, e->smooth_q44);
    }
    copy_points(e, trace);
    free(e);
    return 0;
}
