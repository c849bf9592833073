/* The clock of a rotary scanner in host time. Bytes arrive late, never early, so the line under the arrivals
 * is the clock: it steps down at once and rises slowly. Its slope is measured, because the time of a point is
 * often only counted: so many points of so many microseconds.
 *
 * Integers only: the same samples give the same times. Constant time. No clock is read. */
#ifndef ALE_SCANNER_ROTARY_CLOCK_H
#define ALE_SCANNER_ROTARY_CLOCK_H

#include <stdbool.h>
#include <stdint.h>

enum {
    ALE_ROTARY_CLOCK_WINDOW_US = 4000000, /* over which the slope is measured */
    ALE_ROTARY_CLOCK_JUMP_US = 500000,    /* more is another clock: the sensor began anew, or stood still */
    ALE_ROTARY_CLOCK_RISE_PPM = 2000,     /* most by which it rises above its slope, */
    ALE_ROTARY_CLOCK_RISE_NEW_PPM = 30000 /* and before that is known */
};

/* Fields are private, but for reading. Begins zeroed. */
typedef struct {
    bool started;
    bool sloped; /* the slope was measured */
    int64_t sensor_us;
    int64_t host_us;
    int32_t slope_ppm; /* by which the sensor's second is longer than the host's */
    int64_t window_sensor_us;
    int64_t window_host_us;
    uint64_t jumps;
} ale_rotary_clock_t;

/* Host time of sensor_us, whose packet arrived at arrival_us; both from 0 to 2^49 (17 years). A sensor's
 * clock that steps back is another one. */
int64_t ale_rotary_clock_take(ale_rotary_clock_t *clock, int64_t sensor_us, int64_t arrival_us);

#endif
