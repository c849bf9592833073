/* The URG-04LX over a serial port. The device owns port, stream and health, and is alone in changing them: it
 * hands what is read to the dialogue and to the judge of frames, and does what they return. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scanner/connection.h"
#include "scanner/scanner_family.h"
#include "scanner/urg/baud.h"
#include "scanner/urg/scip_parse.h"
#include "scanner/urg/urg_action.h"
#include "scanner/urg/urg_dialogue.h"
#include "scanner/urg/urg_frames.h"
#include "scanner/urg/urg_stream.h"

typedef struct {
    ale_scanner_t scanner; /* first */
    ale_scanner_config_t config;
    ale_scanner_health_t health;
    bool changed;

    ale_connection_t connection;
    int64_t deadline_us;

    ale_scip_parser_t parser;
    ale_urg_dialogue_t dialogue;
    ale_urg_frames_t frames;
    ale_urg_stream_t stream;
} ale_urg_t;

static void set_deadline(ale_urg_t *urg, int32_t ms)
{
    urg->deadline_us = ale_connection_deadline_us(&urg->connection, ms);
}

/* Status in plain words; tells the caller of the step if it is news. */
static void say(ale_urg_t *urg, const char *text)
{
    if (strcmp(urg->health.status, text) != 0) {
        snprintf(urg->health.status, sizeof urg->health.status, "%s", text);
        urg->changed = true;
    }
}

static void tell_state(ale_urg_t *urg)
{
    const ale_scanner_state_t state = ale_urg_dialogue_state(&urg->dialogue);
    urg->changed = urg->changed || urg->health.state != state;
    urg->health.state = state;
}

static void close_port(ale_urg_t *urg)
{
    ale_connection_close(&urg->connection);
    ale_urg_dialogue_close(&urg->dialogue);
    ale_urg_frames_close(&urg->frames);
    tell_state(urg);
}

static void reopen(ale_urg_t *urg, const char *reason)
{
    say(urg, reason);
    urg->health.reopens++;
    close_port(urg);
}

/* Bytes to the port, through the tap; trouble closes the port. */
static void send_line(ale_urg_t *urg, const char *text)
{
    const int status = ale_connection_send(&urg->connection, (const uint8_t *)text, (uint32_t)strlen(text));
    if (status < 0) {
        reopen(urg, ale_port_strerror(status));
    }
}

static ale_urg_action_t set_baud(ale_urg_t *urg, int32_t baud)
{
    const bool set = ale_port_set_baud(urg->connection.port, baud) == ALE_PORT_OK;
    ale_scip_parser_reset(&urg->parser);
    return ale_urg_dialogue_baud_set(&urg->dialogue, baud, set);
}

static void tell_stream(ale_urg_t *urg, uint32_t what)
{
    if ((what & ALE_URG_STREAM_DESCRIBE) != 0) {
        ale_urg_played_t played = urg->dialogue.identity.played;
        played.zero_us -= urg->config.utime_offset_us;
        ale_urg_stream_describe(&urg->stream, &urg->dialogue.geometry, &played);
    }
    if ((what & ALE_URG_STREAM_FORGET_CLOCK) != 0) {
        ale_urg_stream_forget_clock(&urg->stream);
    }
    if ((what & ALE_URG_STREAM_INTERRUPT) != 0) {
        ale_urg_stream_interrupt(&urg->stream);
    }
    if ((what & ALE_URG_STREAM_BEGIN) != 0) {
        ale_urg_stream_begin(&urg->stream, &urg->dialogue.request);
        ale_urg_frames_begin(&urg->frames);
    }
}

/* All of an action but its deed. */
static void prepare(ale_urg_t *urg, const ale_urg_action_t *action)
{
    if (action->reason != NULL) {
        say(urg, action->reason);
    }
    tell_stream(urg, action->stream);
    urg->changed = urg->changed || action->identified;
    tell_state(urg);
    if (action->wait_ms > 0) {
        set_deadline(urg, action->wait_ms);
    }
}

/* Does the deed; returns the action that follows from it. */
static ale_urg_action_t carry_out(ale_urg_t *urg, const ale_urg_action_t *action)
{
    switch (action->deed) {
    case ALE_URG_REST:
        break;
    case ALE_URG_SEND:
        send_line(urg, action->line);
        break;
    case ALE_URG_SET_BAUD:
        return set_baud(urg, action->baud);
    case ALE_URG_FAIL:
        return ale_urg_frames_fail(&urg->frames, action->reason);
    case ALE_URG_RESTART:
        urg->health.stream_restarts++;
        return ale_urg_dialogue_restart(&urg->dialogue, false);
    case ALE_URG_RESET:
        return ale_urg_dialogue_restart(&urg->dialogue, true);
    case ALE_URG_REOPEN:
        reopen(urg, action->reason);
        break;
    }
    return (ale_urg_action_t){0};
}

/* At most four in a row: FAIL, RESTART, SEND, and the rest. */
static void perform(ale_urg_t *urg, ale_urg_action_t action)
{
    prepare(urg, &action);
    while (action.deed != ALE_URG_REST) {
        action = carry_out(urg, &action);
        prepare(urg, &action);
    }
}

static void step_closed(ale_urg_t *urg)
{
    const int32_t baud = ale_urg_dialogue_first_baud(&urg->dialogue);
    char words[sizeof urg->health.status];
    if (!ale_connection_open(&urg->connection, baud, urg->health.port, words)) {
        return;
    }
    if (urg->connection.port == NULL) {
        say(urg, words);
        return;
    }
    ale_scip_parser_reset(&urg->parser);
    ale_urg_frames_open(&urg->frames);
    perform(urg, ale_urg_dialogue_open(&urg->dialogue, baud, ale_port_has_baud(urg->connection.port)));
}

static void receive(ale_urg_t *urg)
{
    const int status = ale_connection_receive(&urg->connection, urg->deadline_us);
    if (status < 0) {
        reopen(urg, ale_port_strerror(status));
        return;
    }
    ale_urg_dialogue_overhear(&urg->dialogue, urg->connection.bytes, urg->connection.count);
}

/* Time without a scan after which the stream counts as dead. */
static int32_t silence_ms(const ale_urg_t *urg)
{
    const int32_t played_ms = urg->stream.played.silence_ms;
    return played_ms > 0 ? played_ms : ale_urg_frames_silence_ms(ale_urg_stream_turn_us(&urg->stream));
}

static void take_scan(ale_urg_t *urg, const ale_scip_event_t *event)
{
    ale_scanner_health_t *h = &urg->health;
    h->last_scan_us = urg->stream.last_stamp_us;
    h->arrival_us = event->last_us;
    h->clock_offset_us = urg->stream.clock.offset_us;
    h->clock_rate_ppb = urg->stream.clock.rate_ppb;
    h->scan_period_us = urg->stream.period_us;
    h->silence_ms = silence_ms(urg);
    if (ale_urg_frames_proved(&urg->frames)) {
        ale_connection_proved(&urg->connection);
        ale_urg_dialogue_proved(&urg->dialogue);
    }
    if (ale_urg_dialogue_scan(&urg->dialogue)) {
        set_deadline(urg, h->silence_ms);
    }
    tell_state(urg);
}

/* Scans count in every phase that follows a stream of ours; before that they are another program's. */
static void take_frame(ale_urg_t *urg, const ale_scip_event_t *event)
{
    if (urg->stream.request.protocol == 0) {
        return;
    }
    const ale_frame_t frame = ale_urg_stream_take(&urg->stream, event);
    const bool streams = ale_urg_dialogue_streams(&urg->dialogue);
    perform(urg, ale_urg_frames_take(&urg->frames, frame, event->loss, streams));
    if (frame == ALE_FRAME_SCAN) {
        take_scan(urg, event);
    }
    if (ale_urg_dialogue_polled(&urg->dialogue)) {
        urg->deadline_us = event->first_us + ale_urg_period_us(&urg->dialogue.geometry);
    }
}

static void take_reply(ale_urg_t *urg, const ale_scip_event_t *event)
{
    if (event->kind == ALE_SCIP_REPLY && event->has_request && event->request.stream &&
        ale_urg_dialogue_streams(&urg->dialogue)) {
        perform(urg, ale_urg_frames_status(&urg->frames, event->status, ALE_URG_FIRST_SCAN_MS));
    } else {
        perform(urg, ale_urg_dialogue_hear(&urg->dialogue, event));
    }
}

static void take_event(ale_urg_t *urg, const ale_scip_event_t *event)
{
    switch (event->kind) {
    case ALE_SCIP_LINE_READ:
    case ALE_SCIP_REPLY:
        take_reply(urg, event);
        break;
    case ALE_SCIP_SCAN:
    case ALE_SCIP_LOST:
        take_frame(urg, event);
        break;
    case ALE_SCIP_NONE:
        break;
    }
}

/* Parses until a frame yields something, or all bytes are used: what is tapped ends where a scan does, though
 * it was read in one go. An event may close the port. */
static void parse(ale_urg_t *urg)
{
    const ale_connection_t *c = &urg->connection;
    while (c->used < c->count) {
        ale_scip_event_t event;
        const size_t count =
            ale_scip_parse(&urg->parser, c->bytes + c->used, c->count - c->used, c->read_us, &event);
        ale_connection_use(&urg->connection, (uint32_t)count);
        take_event(urg, &event);
        if (event.kind == ALE_SCIP_SCAN || event.kind == ALE_SCIP_LOST) {
            break;
        }
    }
}

/* What dialogue, frames and parser have counted. */
static void fill_health(ale_urg_t *urg)
{
    ale_scanner_health_t *h = &urg->health;
    const ale_urg_dialogue_t *d = &urg->dialogue;
    h->identity = d->known;
    h->baud = d->baud;
    h->protocol = d->protocol;
    h->resets = d->resets;
    h->identity_warnings = d->identity_warnings;
    h->hardware_faults = d->hardware_faults + urg->frames.hardware_faults;
    h->bad_checksum = urg->frames.bad_checksum;
    h->bad_frame = urg->frames.bad_frame;
    h->repeated = urg->frames.repeated;
    h->losses_too_fast = urg->stream.losses_too_fast;
    h->garbage_bytes = ale_scip_counters(&urg->parser)->garbage_bytes;
}

static ale_scanner_event_t hand_out(ale_urg_t *urg, ale_scan_t *scan)
{
    fill_health(urg);
    const ale_scanner_event_t event = ale_urg_stream_next(&urg->stream, scan);
    if (event != ALE_SCANNER_IDLE) {
        urg->health.scans += event == ALE_SCANNER_SCAN;
        urg->health.scans_lost += event == ALE_SCANNER_SCAN_LOST;
        return event;
    }
    if (urg->changed) {
        urg->changed = false;
        return ALE_SCANNER_CHANGED;
    }
    return ALE_SCANNER_IDLE;
}

static ale_scanner_event_t step(ale_scanner_t *scanner, ale_scan_t *scan)
{
    ale_urg_t *urg = (ale_urg_t *)scanner;
    const ale_scanner_event_t waiting = hand_out(urg, scan);
    if (waiting != ALE_SCANNER_IDLE) {
        return waiting;
    }
    const ale_connection_t *c = &urg->connection;
    if (c->port == NULL) {
        step_closed(urg);
        return hand_out(urg, scan);
    }
    if (c->used == c->count) {
        receive(urg);
    }
    parse(urg);
    const bool idle = c->port != NULL && c->used == c->count;
    if (idle && ale_connection_now_us(c) >= urg->deadline_us) {
        perform(urg, ale_urg_dialogue_time_out(&urg->dialogue));
    }
    return hand_out(urg, scan);
}

static const ale_scanner_health_t *health(const ale_scanner_t *scanner)
{
    return &((const ale_urg_t *)scanner)->health;
}

static ale_scanner_t *open_scanner(const ale_scanner_config_t *config)
{
    ale_urg_t *urg = calloc(1, sizeof *urg);
    if (urg == NULL) {
        return NULL;
    }
    urg->scanner.family = &ale_scanner_urg;
    urg->config = *config;
    ale_scip_parser_init(&urg->parser);
    ale_urg_dialogue_init(&urg->dialogue, &urg->config);
    ale_urg_stream_init(&urg->stream, config->reversed);
    ale_connection_init(&urg->connection, &urg->config);
    return &urg->scanner;
}

static void close_scanner(ale_scanner_t *scanner)
{
    ale_urg_t *urg = (ale_urg_t *)scanner;
    if (urg->connection.port != NULL) {
        send_line(urg, "\nQT\n");
    }
    if (urg->connection.port != NULL) {
        close_port(urg);
    }
    free(urg);
}

const ale_scanner_family_t ale_scanner_urg = {.name = "urg",
                                              .tries = 1,
                                              .has_baud = ale_baud_is_known,
                                              .open = open_scanner,
                                              .step = step,
                                              .health = health,
                                              .close = close_scanner};
