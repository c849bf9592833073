/* Capacities of the core: every loop of the estimate task is bounded by one of these.
 * What does not fit is counted and reported by the stage that met it. */
#ifndef ALE_BASE_LIMITS_H
#define ALE_BASE_LIMITS_H

#include <stdint.h>

/* Largest scan that is accepted: a 270 degree scanner at 0.25 degrees a beam. The URG-04LX has 682. */
#define ALE_MAX_BEAMS 1081

/* Most points that a scanner may measure in a turn: 32,000 a second at 8 turns a second. What is more than
 * ALE_MAX_BEAMS is joined (base/turn.h). */
#define ALE_MAX_TURN_POINTS 4096

/* Lines, curves and corners of one scan. A zigzag of eight-beam walls over 1081 beams has 135 lines. */
#define ALE_MAX_LINES 136
#define ALE_MAX_CURVES 32
#define ALE_MAX_CORNERS ALE_MAX_LINES

/* The next point of a surface is at most so many beams away: those between have no value. */
#define ALE_MAX_GAP_BEAMS 8

/* Sectors of the scan that are never used (the robot's own body). */
#define ALE_MAX_BLIND_SECTORS 8

/* Farthest range that the number formats are proved for: twice the squared moments of a scan of Q4
 * millimetres fit int64 (extract/moments.c). */
#define ALE_MAX_RANGE_UM 80000000

/* Farthest stamp from 0, either way, in microseconds: differences of stamps, and what is added to them, fit
 * int64. 73,000 years; also milliseconds that a log takes for seconds are within. */
#define ALE_MAX_STAMP_US (INT64_C(1) << 61)

/* Longest time between a scan's stamp and one of its beams: two turns of a slow scanner. */
#define ALE_MAX_SWEEP_US 2000000

#endif
