/* What Python hands over, and where results go; pointers are borrowed for the call. */
#ifndef ALE_PYTHON_ARGUMENTS_H
#define ALE_PYTHON_ARGUMENTS_H

#include <stdint.h>

#include "records.h"

/* settings: in the order of ale_binding_describe(). */
typedef struct {
    const double *settings;
    const double *blind_rad; /* pairs from, to, counter-clockwise */
    uint32_t blind_count;
    uint32_t close_loops;
    uint32_t rebuilds_map;
} ale_binding_config_t;

/* One scan: ranges in metres, as 64 or 32 bit floats. */
typedef struct {
    const ale_scanner_record_t *scanner;
    const void *ranges;
    uint32_t beams;
    uint32_t is_float32;
    double stamp_s;
} ale_binding_scan_t;

/* Where features go: arrays of ALE_MAX_LINES, ALE_MAX_CORNERS, ALE_MAX_CURVES; counts of them, then outliers
 * and the refused (ALE_REFUSALS). */
typedef struct {
    ale_line_record_t *lines;
    ale_corner_record_t *corners;
    ale_curve_record_t *curves;
    uint32_t *counts;
} ale_binding_features_t;

#endif
