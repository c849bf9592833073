/* The circle through a run of points. */
#ifndef ALE_EXTRACT_CIRCLE_H
#define ALE_EXTRACT_CIRCLE_H

#include "extract/moments.h"

/* Centre and radius, Q4 mm; radius_q4 0: no circle (the points lie on a line). */
typedef struct {
    int64_t x_q4;
    int64_t y_q4;
    int64_t radius_q4;
} ale_circle_t;

/* Least squares of x^2 + y^2 - 2 a x - 2 b y - c (Kasa). O(points). */
ale_circle_t ale_circle_fit(const ale_prepared_scan_t *scan, int32_t first, int32_t last);

/* Squared distances of the points from the circle, mm^2 Q8. O(points). */
int64_t ale_circle_sse_q8(const ale_prepared_scan_t *scan, const ale_circle_t *circle, int32_t first,
                          int32_t last);

#endif
