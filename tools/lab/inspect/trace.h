/* What the extractor did with one scan: its points, segments, runs, and the steps of its binary search. */
#ifndef ALE_LAB_INSPECT_TRACE_H
#define ALE_LAB_INSPECT_TRACE_H

#include <stdbool.h>
#include <stdint.h>

#include "extract/extract.h"

/* One step of the search for the break of a line (paper fig. 2): the span [left, right] in points from the
 * line's first point on, the guess in its middle, and whether the line up to the guess was accepted. */
typedef struct {
    uint16_t line_first; /* point the line begins at */
    int16_t direction;   /* 1: the search goes towards higher points, -1: lower */
    uint16_t left;
    uint16_t right;
    uint16_t guess;
    bool accepted;
} inspect_step_t;

enum { INSPECT_MAX_STEPS = 1024 };

typedef struct {
    ale_features_t features;
    uint16_t points; /* beams that have a value and are not stray, in beam order */
    uint16_t beam[ALE_MAX_BEAMS];
    bool smoothed;               /* the configuration asks for it; the points then are smoothed ones */
    int32_t x_um[ALE_MAX_BEAMS]; /* where the decisions saw the point; sensor's frame */
    int32_t y_um[ALE_MAX_BEAMS];
    bool segment_ends[ALE_MAX_BEAMS];
    uint16_t runs; /* what the search, the merging and the placing of the breaks left, before the tests */
    struct {
        uint16_t first; /* points, inclusive */
        uint16_t last;
    } run[ALE_MAX_BEAMS];
    uint16_t steps; /* of the search through the longest segment */
    inspect_step_t step[INSPECT_MAX_STEPS];
} inspect_trace_t;

/* Extracts the scan and fills *trace. 0, or -1: no memory or a configuration that the extractor refuses. */
int inspect_trace(const ale_scan_t *scan, const ale_extract_config_t *config, inspect_trace_t *trace);

#endif
