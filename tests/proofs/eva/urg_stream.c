/* One frame to the judge of a URG's frames and to its clock, from any state that `unknown_stream` allows; the
 * state must be such a one again. Its stamp and the time at which it came are any: a recording may say what
 * it likes.
 *
 * proves: drivers/scanner/urg/urg_stream.c drivers/scanner/urg/sensor_clock.c
 * with: drivers/scanner/urg/identity.c drivers/scanner/urg/played.c drivers/scanner/urg/scan_fill.c
 *  drivers/scanner/urg/scip_request.c lib/base/scan.c lib/base/fixed.c
 * options: -eva-precision 0 -eva-auto-loop-unroll 20 -eva-split-return full -eva-slevel 20 -eva-plevel 40 */
#include "unknown.h"
#include "unknown_scan.h"
#include "unknown_urg.h"

#include "scanner/urg/urg_stream.h"

enum { MOST_VALUE = (1 << 18) - 1 }; /* three characters */

static ale_urg_stream_t stream;
static ale_scan_t scan;
static int32_t values[ALE_MAX_BEAMS];

static void unknown_event(ale_scip_event_t *event, ale_scip_kind_t kind)
{
    Frama_C_make_unknown((char *)event, sizeof *event);
    event->kind = kind;
    event->request = unknown_request();
    event->stamp_known = unknown(0, 1);
    event->stamp_ms = (uint32_t)unknown(0, (1 << 24) - 1);
    event->values = values;
    event->value_count = (uint32_t)unknown(0, ALE_MAX_BEAMS);
    event->first_us = unknown(-ALE_MAX_STAMP_US, ALE_MAX_STAMP_US);
}

static void hold_clock(const ale_sensor_clock_t *clock)
{
    //@ assert -ALE_CLOCK_RATE_PPB <= clock->rate_ppb <= ALE_CLOCK_RATE_PPB;
    //@ assert clock->stamp_ms < 16777216 && 0 <= clock->latency_us <= MOST_PERIOD_US;
    //@ assert -ALE_MAX_STAMP_US <= clock->arrival_us <= ALE_MAX_STAMP_US;
    //@ assert clock->offset_us <= MOST_OFFSET_US;
    //@ loop unroll 16;
    for (uint32_t k = 0; k < ALE_CLOCK_BLOCKS; k++) {
        //@ assert -MOST_SAMPLE_US <= clock->block[k].offset_us <= MOST_SAMPLE_US;
    }
    (void)clock;
}

static void take(ale_scip_kind_t kind)
{
    ale_scip_event_t event;
    unknown_stream(&stream);
    unknown_event(&event, kind);
    ale_urg_stream_take(&stream, &event);
    //@ assert 1 <= stream.period_us <= MOST_PERIOD_US && -20 <= stream.regular <= 3;
    //@ assert stream.gaps_owed <= 30 && -MOST_TURN_US <= stream.turn_us <= MOST_TURN_US;
    //@ assert -MOST_STREAM_US <= stream.last_stamp_us <= MOST_STREAM_US;
    //@ assert -MOST_GAP_US <= stream.gap_us <= MOST_GAP_US;
    //@ assert -MOST_STREAM_US <= stream.loss_stamp_us <= MOST_STREAM_US;
    //@ assert stream.losses_until_us <= MOST_STREAM_US;
    hold_clock(&stream.clock);
}

/* What a frame yielded is fetched, one after another. */
static void fetch(void)
{
    unknown_stream(&stream);
    stream.loss_waits = unknown(0, 1);
    stream.gaps_owed = (uint32_t)unknown(0, 30);
    stream.scan_waits = unknown(0, 1);
    ale_urg_stream_next(&stream, &scan);
    //@ assert stream.gaps_owed <= 30 && stream.gap_us <= MOST_GAP_US + MOST_TURN_US;
}

static void begin(void)
{
    const ale_scip_request_t request = unknown_request();
    const ale_urg_geometry_t geometry = unknown_geometry();
    const ale_urg_played_t played = unknown_played();
    unknown_stream(&stream);
    ale_urg_stream_describe(&stream, &geometry, &played);
    //@ assert 1 <= stream.period_us <= MOST_PERIOD_US && 0 <= stream.clock.latency_us <= MOST_PERIOD_US;
    ale_urg_stream_begin(&stream, &request);
    ale_urg_stream_turn_us(&stream);
}

void main(void)
{
    //@ loop unroll 1;
    for (uint32_t k = 0; k < ALE_MAX_BEAMS; k++) {
        values[k] = (int32_t)unknown(0, MOST_VALUE);
    }
    ale_urg_stream_init(&stream, unknown(0, 1));
    begin();
    take(ALE_SCIP_LOST);
    take(ALE_SCIP_SCAN);
    fetch();
}
