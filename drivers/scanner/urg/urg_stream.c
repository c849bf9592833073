#include "scanner/urg/urg_stream.h"

#include <string.h>

#include "base/fixed.h"
#include "scanner/urg/scan_fill.h"

enum {
    REGULAR_US = 3000,  /* the motor's turns differ by a millisecond; more is no whole turn */
    REGULAR_ENOUGH = 3, /* intervals in a row before a gap is taken for lost scans */
    IRREGULAR = -20,    /* recorded logs that are played back have other intervals: there no gap is a loss */
    MOST_GAPS = 30,     /* more than that is an interruption */
    LOST_AT_ONCE = 32, /* damaged frames that may come in one go, as after a line that was held up; then one a
                        * turn, because a scanner sends no more */
    PERIOD_SMOOTHING = 32,       /* scans over which the period is averaged: the stamps count in whole ms */
    LONGEST_PERIOD_US = 60000000 /* one turn a minute, the slowest that a sensor may say of itself */
};

void ale_urg_stream_init(ale_urg_stream_t *stream, bool reversed)
{
    memset(stream, 0, sizeof *stream);
    stream->reversed = reversed;
    stream->losses_until_us = INT64_MIN;
    ale_urg_identity_t identity;
    ale_urg_identity_init(&identity);
    ale_urg_stream_describe(stream, &identity.geometry, &identity.played);
}

void ale_urg_stream_describe(ale_urg_stream_t *stream, const ale_urg_geometry_t *geometry,
                             const ale_urg_played_t *played)
{
    stream->played = *played;
    const bool known = memcmp(&stream->geometry, geometry, sizeof *geometry) == 0;
    if (!known) {
        stream->geometry = *geometry;
        stream->regular = 0;
        stream->period_us = ale_urg_period_us(geometry);
        ale_urg_stream_forget_clock(stream);
    }
}

void ale_urg_stream_forget_clock(ale_urg_stream_t *stream)
{
    ale_sensor_clock_reset(&stream->clock, ale_urg_period_us(&stream->geometry));
    stream->continuous = false;
}

void ale_urg_stream_begin(ale_urg_stream_t *stream, const ale_scip_request_t *request)
{
    stream->request = *request;
    ale_urg_stream_interrupt(stream);
}

void ale_urg_stream_interrupt(ale_urg_stream_t *stream)
{
    stream->continuous = false;
    stream->losses = 0;
}

int64_t ale_urg_stream_turn_us(const ale_urg_stream_t *stream)
{
    return (int64_t)stream->period_us * (stream->request.skip + 1);
}

/* Whole turns between two scans, or 0 when the interval is not made of whole turns. */
static int64_t whole_turns(const ale_urg_stream_t *stream, int64_t interval_us)
{
    const int64_t turn_us = ale_urg_stream_turn_us(stream);
    const int64_t turns = ale_round_div(interval_us, turn_us);
    const int64_t off_us = ale_abs64(interval_us - turns * turn_us);
    return off_us <= REGULAR_US ? turns : 0;
}

static void follow_period(ale_urg_stream_t *stream, int64_t interval_us, int64_t turns)
{
    const int64_t measured_us = ale_round_div(interval_us, turns * (stream->request.skip + 1));
    const int64_t change_us = ale_round_div(measured_us - stream->period_us, PERIOD_SMOOTHING);
    stream->period_us = (int32_t)ale_clamp64(stream->period_us + change_us, 1, LONGEST_PERIOD_US);
}

/* Counts the scans that are missing between the last one and this one. */
static void account_for_gap(ale_urg_stream_t *stream, int64_t interval_us)
{
    const int64_t turns = whole_turns(stream, interval_us);
    stream->gaps_owed = 0;
    if (turns <= 0) {
        stream->regular = IRREGULAR;
        return;
    }
    const int64_t missing = turns - 1 - stream->losses;
    if (stream->regular >= REGULAR_ENOUGH && missing > 0 && missing <= MOST_GAPS) {
        stream->gaps_owed = (uint32_t)missing;
        const int64_t whole_us = interval_us - interval_us % turns;
        stream->turn_us = whole_us / turns;
        stream->gap_us = stream->last_stamp_us + whole_us - missing * stream->turn_us;
    }
    stream->regular += stream->regular < REGULAR_ENOUGH;
    follow_period(stream, interval_us, turns);
}

static bool is_played(const ale_urg_stream_t *stream)
{
    return stream->played.silence_ms > 0;
}

/* Best known time of a frame that cannot be used. */
static int64_t time_of_lost(const ale_urg_stream_t *stream, const ale_scip_event_t *event)
{
    const bool clock_known = stream->played.zero_us != ALE_URG_PLAYED_ZERO_UNKNOWN;
    if (is_played(stream) && event->stamp_known && clock_known) {
        return ale_urg_played_us(&stream->played, event->stamp_ms, event->first_us);
    }
    return event->stamp_known && stream->clock.started
               ? ale_sensor_clock_host_us(&stream->clock, event->stamp_ms)
               : event->first_us - ale_urg_period_us(&stream->geometry);
}

/* Whether so many scans can have been sent as would be lost with this one: noise, or whoever writes on the
 * line, makes beginnings of frames as fast as the line takes them. */
static bool can_be_lost(ale_urg_stream_t *stream, int64_t arrival_us)
{
    const int64_t turn_us = ale_urg_stream_turn_us(stream);
    const int64_t least_us = arrival_us - LOST_AT_ONCE * turn_us;
    if (stream->losses_until_us < least_us || stream->losses_until_us > arrival_us + turn_us) {
        stream->losses_until_us = least_us;
    }
    if (stream->losses_until_us > arrival_us) {
        stream->losses_too_fast++;
        return false;
    }
    stream->losses_until_us += turn_us;
    return true;
}

static ale_frame_t lose(ale_urg_stream_t *stream, const ale_scip_event_t *event)
{
    const bool timed = event->stamp_known && stream->clock.started;
    if (timed && ale_stamp_difference_ms(event->stamp_ms, stream->clock.stamp_ms) == 0) {
        return ALE_FRAME_REPEATED;
    }
    if (!can_be_lost(stream, event->first_us)) {
        return ALE_FRAME_LOST;
    }
    stream->losses++;
    stream->loss_waits = true;
    stream->loss_stamp_us = time_of_lost(stream, event);
    return ALE_FRAME_LOST;
}

/* SCIP 1.1 has no stamp: what arrives now was measured during the turn before. */
static int64_t time_of_unstamped(ale_urg_stream_t *stream, const ale_scip_event_t *event)
{
    return event->first_us - ale_urg_period_us(&stream->geometry);
}

/* Host time of a stamped frame; false when the stamp was there before. */
static bool time_of_stamped(ale_urg_stream_t *stream, const ale_scip_event_t *event, int64_t *stamp_us)
{
    const ale_stamp_kind_t kind = ale_sensor_clock_judge(&stream->clock, event->stamp_ms, event->first_us);
    if (kind == ALE_STAMP_REPEATED) {
        return false;
    }
    if (kind == ALE_STAMP_JUMPED) {
        stream->clock_jumps++;
        ale_urg_stream_forget_clock(stream);
    }
    const int64_t interval_us =
        (int64_t)ale_stamp_difference_ms(event->stamp_ms, stream->clock.stamp_ms) * 1000;
    *stamp_us = ale_sensor_clock_update(&stream->clock, event->stamp_ms, event->first_us);
    if (stream->continuous) {
        account_for_gap(stream, interval_us);
    }
    return true;
}

/* The same of a frame of a recording. Its scans keep a distance of a tick: the same stamp is the same scan.
 */
static bool time_of_played(ale_urg_stream_t *stream, const ale_scip_event_t *event, int64_t *stamp_us)
{
    ale_urg_played_t *played = &stream->played;
    if (played->zero_us == ALE_URG_PLAYED_ZERO_UNKNOWN) {
        const int64_t counted_us = (int64_t)event->stamp_ms * played->tick_us;
        played->zero_us = event->first_us - ale_urg_period_us(&stream->geometry) - counted_us;
    }
    *stamp_us = ale_urg_played_us(played, event->stamp_ms, event->first_us);
    return !stream->continuous || *stamp_us != stream->last_stamp_us;
}

static bool time_of(ale_urg_stream_t *stream, const ale_scip_event_t *event, int64_t *stamp_us)
{
    if (!event->stamp_known) {
        *stamp_us = time_of_unstamped(stream, event);
        return true;
    }
    return is_played(stream) ? time_of_played(stream, event, stamp_us)
                             : time_of_stamped(stream, event, stamp_us);
}

static void fill(ale_urg_stream_t *stream, const ale_scip_event_t *event, int64_t stamp_us)
{
    ale_urg_fill_scan(&stream->geometry, event, stamp_us, stream->period_us, stream->reversed, &stream->scan);
    if (is_played(stream) && event->stamp_known) {
        ale_urg_played_place(&stream->played, &event->request, stamp_us, stream->reversed, &stream->scan);
    }
}

ale_frame_t ale_urg_stream_take(ale_urg_stream_t *stream, const ale_scip_event_t *event)
{
    if (event->kind == ALE_SCIP_LOST) {
        return lose(stream, event);
    }
    if (!ale_scip_request_same_ranges(&event->request, &stream->request)) {
        return ALE_FRAME_FOREIGN;
    }
    int64_t stamp_us = 0;
    if (!time_of(stream, event, &stamp_us)) {
        return ALE_FRAME_REPEATED;
    }
    stream->continuous = event->stamp_known;
    stream->losses = 0;
    stream->last_stamp_us = stamp_us;
    fill(stream, event, stamp_us);
    stream->scan_waits = true;
    return ALE_FRAME_SCAN;
}

static ale_scanner_event_t yield_loss(ale_scan_t *scan, int64_t stamp_us)
{
    memset(scan, 0, sizeof *scan);
    scan->stamp_us = stamp_us;
    return ALE_SCANNER_SCAN_LOST;
}

ale_scanner_event_t ale_urg_stream_next(ale_urg_stream_t *stream, ale_scan_t *scan)
{
    if (stream->loss_waits) {
        stream->loss_waits = false;
        return yield_loss(scan, stream->loss_stamp_us);
    }
    if (stream->gaps_owed > 0) {
        stream->gaps_owed--;
        stream->gap_us += stream->turn_us;
        return yield_loss(scan, stream->gap_us - stream->turn_us);
    }
    if (stream->scan_waits) {
        stream->scan_waits = false;
        *scan = stream->scan;
        return ALE_SCANNER_SCAN;
    }
    return ALE_SCANNER_IDLE;
}
