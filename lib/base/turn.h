/* A turn of a scanner whose points do not lie on a grid, made into a scan.
 *
 *   ale_turn_begin(&turn);
 *   for every point that the device sends, in the order measured, until the turn is complete:
 *       ale_turn_add(&turn, bearing_bam, range_um, flag);
 *   turn.first_us = time of the first point, turn.last_us = time of the last one;
 *   scan.range_min_um = ..., scan.range_max_um = ...;
 *   if (ale_turn_to_scan(&turn, &scan) != ALE_TURN_FINE) ... it says why ...
 *
 * Every point becomes a beam, in the order of the bearings, clockwise or not: none is moved to a grid, and
 * two points in the same direction are two beams. Where points are missing (a packet was lost) the beams that
 * would lie there are added as ALE_BEAM_UNKNOWN, so that the number of a beam goes with its bearing. Only a
 * turn of more points than ALE_MAX_BEAMS is joined: as many neighbours as it takes give one beam, the mean of
 * those that lie on one surface, and where they do not, one for each surface. Were those too many, in
 * clutter, only the nearest is kept and the others counted (left_out). The number of beams may differ from
 * turn to turn.
 *
 * The stamp is that of the middle of the turn: whoever straightens the scan takes the motion for even, and an
 * acceleration a then leaves a t^2 / 2 of a beam at t, which is a T^2 / 8 at most from the middle of a turn
 * that takes T, and four times as much from its beginning.
 *
 * The memory is the caller's; no function allocates or keeps a pointer. O(points log points). */
#ifndef ALE_BASE_TURN_H
#define ALE_BASE_TURN_H

#include <stdint.h>

#include "base/limits.h"
#include "base/scan.h"

typedef struct {
    uint32_t bearing_bam; /* sensor's frame, counter-clockwise positive, whichever way the mirror turns */
    int32_t range_um;
    uint8_t flag; /* ale_beam_flag_t; a VALID one is judged by the scan's range limits */
} ale_turn_point_t;

/* Points that make one beam, and the missing beams after it. */
typedef struct {
    uint16_t first;
    uint16_t last;
    uint16_t lost_after;
} ale_turn_part_t;

typedef struct {
    int64_t first_us;  /* set by the caller: when the first and the last point were measured, at most */
    int64_t last_us;   /* ALE_TURN_MOST_US apart, within half of ALE_MAX_STAMP_US */
    uint32_t count;    /* of all points that were added, also of those beyond ALE_MAX_TURN_POINTS */
    uint32_t left_out; /* of the scan made last: points of joined ones for whose surface there was no room */
    ale_turn_point_t point[ALE_MAX_TURN_POINTS];

    ale_turn_point_t sorted[ALE_MAX_TURN_POINTS]; /* working memory */
    ale_turn_part_t part[ALE_MAX_TURN_POINTS];
    uint16_t parts;
} ale_turn_t;

typedef enum {
    ALE_TURN_FINE = 0,
    ALE_TURN_FEW = -1,  /* fewer than ALE_TURN_LEAST points */
    ALE_TURN_MANY = -2, /* more than ALE_MAX_TURN_POINTS */
    ALE_TURN_STILL = -3 /* all points in one direction: the mirror does not turn */
} ale_turn_status_t;

enum { ALE_TURN_LEAST = 8 };

/* 35 years: nanoseconds fit int64. */
#define ALE_TURN_MOST_US (INT64_C(1) << 50)

/* Forgets the points. Constant time. */
void ale_turn_begin(ale_turn_t *turn);

/* Adds a point; of more than ALE_MAX_TURN_POINTS only the number is kept. Constant time, no error. */
void ale_turn_add(ale_turn_t *turn, uint32_t bearing_bam, int32_t range_um, ale_beam_flag_t flag);

/* Writes all of the scan but range_min_um and range_max_um, which are read: they must be set. Its stamp is
 * the time at which the mirror looked at the middle of its beams (stamp_beam). The way the mirror turns is
 * that of most steps from point to point. Anything but ALE_TURN_FINE: the scan is as it was. The turn's
 * points are left sorted. */
ale_turn_status_t ale_turn_to_scan(ale_turn_t *turn, ale_scan_t *scan);

/* What to tell a person: "fewer than 8 points a turn", ... A static string. */
const char *ale_turn_status_text(ale_turn_status_t status);

#endif
