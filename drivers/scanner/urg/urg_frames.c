#include <stdio.h>
#include <string.h>

#include "base/fixed.h"
#include "scanner/urg/urg_internal.h"

enum { SILENT_TURNS = 5, SILENT_MS = 400, BAD_FRAMES = 3, FROZEN_FRAMES = 3, GOOD_SERIES = 10, RESTARTS = 3 };

/* Least status of a stream frame that says why it has no ranges; smaller ones acknowledge or refuse MD. */
#define CHECKING "21"

void ale_urg_fail(ale_urg_t *urg, const char *reason)
{
    ale_urg_say(urg, reason);
    urg->failures++;
    urg->bad_frames = 0;
    urg->frozen = 0;
    urg->good_frames = 0;
    if (urg->failures > RESTARTS + 1) {
        ale_urg_reopen(urg, reason);
        return;
    }
    if (urg->failures > RESTARTS) {
        urg->due |= ALE_DUE_RESET | ALE_DUE_PARAMETERS;
    } else {
        urg->health.stream_restarts++;
    }
    ale_urg_probe(urg);
}

void ale_urg_stream_status(ale_urg_t *urg, const ale_scip_event_t *event)
{
    char reason[64];
    if (strcmp(event->status, CHECKING) < 0) {
        return;
    }
    if (event->status[0] >= '5' && strcmp(event->status, "98") < 0) {
        urg->health.hardware_faults++;
        snprintf(reason, sizeof reason, "hardware fault of the sensor: status %s", event->status);
        urg->failures = (uint32_t)ale_max64(urg->failures, RESTARTS);
        ale_urg_fail(urg, reason);
    } else {
        snprintf(reason, sizeof reason, "the sensor checks itself: status %s", event->status);
        ale_urg_say(urg, reason);
        urg->deadline_us = ale_urg_deadline(urg, ALE_URG_FIRST_SCAN_MS);
    }
}

/* Time without a scan after which the stream counts as dead. */
static int32_t silence_ms(const ale_urg_t *urg)
{
    const int64_t turns_ms = SILENT_TURNS * ale_urg_stream_turn_us(&urg->stream) / 1000;
    return (int32_t)ale_max64(turns_ms, SILENT_MS);
}

static void on_good_frame(ale_urg_t *urg, const ale_scip_event_t *event)
{
    ale_urg_health_t *h = &urg->health;
    urg->port_proved = true;
    urg->bad_frames = 0;
    urg->frozen = 0;
    h->last_scan_us = urg->stream.last_stamp_us;
    h->arrival_us = event->last_us;
    h->clock_offset_us = urg->stream.clock.offset_us;
    h->clock_rate_ppb = urg->stream.clock.rate_ppb;
    h->scan_period_us = urg->stream.period_us;
    if (++urg->good_frames >= GOOD_SERIES) {
        urg->failures = 0;
        urg->open_failures = 0;
        urg->speed_attempts = 0;
    }
    /* A scan says as much as the acknowledgement that may have been lost. */
    if (urg->phase == ALE_PHASE_STREAM || urg->phase == ALE_PHASE_START) {
        urg->phase = ALE_PHASE_STREAM;
        ale_urg_set_state(urg, ALE_URG_STREAMING);
        urg->deadline_us = ale_urg_deadline(urg, silence_ms(urg));
    }
}

static void on_bad_frame(ale_urg_t *urg, const ale_scip_event_t *event)
{
    urg->health.bad_checksum += event->loss == ALE_SCIP_BAD_SUM;
    urg->health.bad_frame += event->loss != ALE_SCIP_BAD_SUM;
    urg->good_frames = 0;
    if (++urg->bad_frames >= BAD_FRAMES && urg->phase == ALE_PHASE_STREAM) {
        ale_urg_fail(urg, "three damaged scans in a row");
    }
}

static void on_repeated_frame(ale_urg_t *urg)
{
    urg->health.repeated++;
    if (++urg->frozen >= FROZEN_FRAMES && urg->phase == ALE_PHASE_STREAM) {
        ale_urg_fail(urg, "the sensor's clock stands still");
    }
}

/* Scans count in every phase that follows a stream of ours; before that they are another program's. */
void ale_urg_frame(ale_urg_t *urg, const ale_scip_event_t *event)
{
    if (urg->stream.request.protocol == 0) {
        return;
    }
    switch (ale_urg_stream_take(&urg->stream, event)) {
    case ALE_FRAME_SCAN:
        on_good_frame(urg, event);
        break;
    case ALE_FRAME_LOST:
        on_bad_frame(urg, event);
        break;
    case ALE_FRAME_REPEATED:
        on_repeated_frame(urg);
        break;
    case ALE_FRAME_FOREIGN:
        urg->health.bad_frame++;
        break;
    }
    if (urg->phase == ALE_PHASE_POLL) {
        urg->tries = 0;
        urg->poll_at_us = event->first_us + ale_urg_period_us(&urg->identity.geometry);
    }
}
