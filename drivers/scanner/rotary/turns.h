/* From packets of points to scans: a scan is a turn of the head, from the point where it passes straight
 * ahead to the next such point, however many points it has.
 *
 *   ale_turns_begin(&turns);                                        when the stream is (re)started
 *   ale_turns_take(&turns, &packet, last_us);                       for each packet of points
 *   while ((kind = ale_turns_next(&turns, &scan)) != ALE_SCANNER_IDLE) ...
 *
 * Each turn that the sensor measured since the stream began comes out once. One of which packets were lost is
 * a scan with bearings of which nothing is known, as long as half of it came; else, and where nothing came,
 * it is a loss. Pure. */
#ifndef ALE_SCANNER_ROTARY_TURNS_H
#define ALE_SCANNER_ROTARY_TURNS_H

#include <stdbool.h>
#include <stdint.h>

#include "base/scan.h"
#include "base/turn.h"
#include "scanner/rotary/packet.h"
#include "scanner/scanner_types.h"

/* Fields are private, but for reading. */
typedef struct {
    bool clockwise;
    bool reversed;
    int32_t range_min_um;
    int32_t range_max_um;

    ale_turn_t turn;  /* under way */
    int64_t first_us; /* of its first point */
    int64_t begun_us;
    bool whole;      /* it was seen from its beginning */
    uint32_t phase;  /* of the last point: bearing in the sense of turning, 2^32 a turn */
    uint32_t swept;  /* in this turn, without what was lost; at most 2^32 - 1 */
    bool goes_on;    /* there was a point before */
    int64_t last_us; /* of that point */

    int64_t sensor_us; /* of that point, on the sensor's clock */
    int64_t sum_us;    /* of the last packets that followed one another, */
    int64_t sum_bam;   /* and how far the head turned meanwhile */
    int32_t period_us; /* of a turn, measured; 0: not known yet */
    int32_t point_ns;  /* from point to point, measured; 0: not known yet */

    uint32_t losses_owed; /* before the scan that waits */
    int64_t loss_us;      /* time of the next one of them */
    bool scan_waits;
    ale_scan_t scan;
} ale_turns_t;

/* Zeroes all. */
void ale_turns_init(ale_turns_t *turns, bool clockwise, bool reversed);

/* What the sensor measures at least and at most. */
void ale_turns_range(ale_turns_t *turns, int32_t range_min_um, int32_t range_max_um);

/* The stream begins: the turn under way was not seen whole, and what was missed is no loss. */
void ale_turns_begin(ale_turns_t *turns);

/* Takes a packet of points; last_us: when the last of them was measured, on any clock that does not step back
 * by more than a packet takes. What it yields must be fetched before the next one. */
void ale_turns_take(ale_turns_t *turns, const ale_rotary_packet_t *packet, int64_t last_us);

/* ALE_SCANNER_SCAN_LOST (scan->stamp_us only; 0 beams), ALE_SCANNER_SCAN, or ALE_SCANNER_IDLE when all is
 * fetched. */
ale_scanner_event_t ale_turns_next(ale_turns_t *turns, ale_scan_t *scan);

/* Turns a second as measured, thousandths of a degree a second; 0: not known. */
int32_t ale_turns_speed_mdeg_s(const ale_turns_t *turns);

#endif
