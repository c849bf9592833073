/* The URG-04LX over a serial port. The device owns port, stream and health, and is alone in changing them: it
 * hands what is read to the dialogue and to the judge of frames, and does what they return. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "base/fixed.h"
#include "scanner/scanner_family.h"
#include "scanner/urg/baud.h"
#include "scanner/urg/scip_parse.h"
#include "scanner/urg/urg_action.h"
#include "scanner/urg/urg_dialogue.h"
#include "scanner/urg/urg_frames.h"
#include "scanner/urg/urg_stream.h"
#include "serial/port.h"
#include "serial/port_candidates.h"

enum {
    READ_BYTES = 4096,
    STEP_MS = 50,
    WRITE_MS = 200,
    REOPEN_MS = 100, /* first pause before the port is opened again; doubled up to the longest */
    LONGEST_REOPEN_MS = 400,
    LEAST_WALL_US = 100000 /* a simulator may run fast, but this computer's scheduler does not */
};

typedef struct {
    ale_scanner_t scanner; /* first */
    ale_scanner_config_t config;
    ale_scanner_health_t health;
    bool changed;

    ale_port_t *port;
    char candidates[ALE_PORT_CANDIDATES][ALE_PORT_PATH];
    uint32_t candidate_count;
    uint32_t candidate; /* next one to try */
    int64_t open_at_us;
    uint32_t open_failures;
    uint8_t bytes[READ_BYTES]; /* as read */
    uint32_t byte_count;
    uint32_t bytes_used;
    int64_t read_us;
    int64_t deadline_us;

    ale_scip_parser_t parser;
    ale_urg_dialogue_t dialogue;
    ale_urg_frames_t frames;
    ale_urg_stream_t stream;
} ale_urg_t;

static double scale(const ale_urg_t *urg)
{
    return urg->config.time_scale > 0 ? urg->config.time_scale : 1;
}

static int64_t now_us(const ale_urg_t *urg)
{
    if (urg->config.now_us != NULL) {
        return urg->config.now_us(urg->config.now_user);
    }
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    const int64_t host_us = (int64_t)now.tv_sec * 1000000 + now.tv_nsec / 1000;
    return (int64_t)((double)host_us * scale(urg));
}

static void set_deadline(ale_urg_t *urg, int32_t ms)
{
    const int64_t floor_us = (int64_t)((double)LEAST_WALL_US * scale(urg));
    urg->deadline_us = now_us(urg) + ale_max64((int64_t)ms * 1000, floor_us);
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
    ale_port_close(urg->port);
    urg->port = NULL;
    urg->byte_count = 0;
    urg->bytes_used = 0;
    ale_urg_dialogue_close(&urg->dialogue);
    ale_urg_frames_close(&urg->frames);
    tell_state(urg);
}

static void schedule_open(ale_urg_t *urg)
{
    const uint32_t doublings = urg->open_failures < 4 ? urg->open_failures : 4;
    const int32_t pause_ms = REOPEN_MS << doublings;
    urg->open_failures++;
    urg->open_at_us =
        now_us(urg) + (int64_t)1000 * (pause_ms < LONGEST_REOPEN_MS ? pause_ms : LONGEST_REOPEN_MS);
}

static void reopen(ale_urg_t *urg, const char *reason)
{
    say(urg, reason);
    urg->health.reopens++;
    close_port(urg);
    schedule_open(urg);
}

/* Bytes to the port, through the tap; trouble closes the port. */
static void send_line(ale_urg_t *urg, const char *text)
{
    const uint32_t count = (uint32_t)strlen(text);
    const int status = ale_port_write(urg->port, (const uint8_t *)text, count, WRITE_MS);
    if (status < 0) {
        reopen(urg, ale_port_strerror(status));
        return;
    }
    if (urg->config.tap != NULL) {
        urg->config.tap(urg->config.tap_user, true, (const uint8_t *)text, count, now_us(urg));
    }
}

static ale_urg_action_t set_baud(ale_urg_t *urg, int32_t baud)
{
    const bool set = ale_port_set_baud(urg->port, baud) == ALE_PORT_OK;
    ale_scip_parser_reset(&urg->parser);
    return ale_urg_dialogue_baud_set(&urg->dialogue, baud, set);
}

static void tell_stream(ale_urg_t *urg, uint32_t what)
{
    if ((what & ALE_URG_STREAM_DESCRIBE) != 0) {
        ale_urg_played_t played = urg->dialogue.identity.played;
        played.zero_us -= urg->config.utime_offset_us;
        ale_urg_stream_describe(&urg->stream, &urg->dialogue.identity.geometry, &played);
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

/* The port to try now: the given one, or the next that a scanner may hang on; NULL when there is none. */
static const char *next_path(ale_urg_t *urg)
{
    if (urg->config.path != NULL) {
        return urg->config.path;
    }
    if (urg->candidate >= urg->candidate_count) {
        urg->candidate_count = ale_port_candidates("/dev", urg->candidates);
        urg->candidate = 0;
    }
    return urg->candidate_count > 0 ? urg->candidates[urg->candidate++] : NULL;
}

static void open_port(ale_urg_t *urg)
{
    const char *path = next_path(urg);
    if (path == NULL) {
        say(urg, "no serial device is there that could be a scanner");
        schedule_open(urg);
        return;
    }
    snprintf(urg->health.port, sizeof urg->health.port, "%s", path);
    const int32_t baud = ale_urg_dialogue_first_baud(&urg->dialogue);
    const int status = ale_port_open(&urg->port, path, baud);
    if (status < 0) {
        char words[ALE_PORT_WORDS];
        char text[sizeof urg->health.status];
        ale_port_explain(status, path, words);
        snprintf(text, sizeof text, "%.60s: %s", path, words);
        say(urg, text);
        schedule_open(urg);
        return;
    }
    ale_scip_parser_reset(&urg->parser);
    ale_urg_frames_open(&urg->frames);
    perform(urg, ale_urg_dialogue_open(&urg->dialogue, baud, ale_port_has_baud(urg->port)));
}

/* Milliseconds to wait for the port until a moment of the urg's clock, within what a step may take. */
static int32_t wait_ms(const ale_urg_t *urg, int64_t until_us)
{
    const int32_t most_ms = urg->config.step_ms > 0 ? urg->config.step_ms : STEP_MS;
    const int64_t left_us = (int64_t)((double)(until_us - now_us(urg)) / scale(urg));
    return (int32_t)ale_clamp64((left_us + 999) / 1000, 0, most_ms);
}

static void step_closed(ale_urg_t *urg)
{
    if (now_us(urg) < urg->open_at_us) {
        ale_port_wait(NULL, wait_ms(urg, urg->open_at_us));
    }
    if (now_us(urg) >= urg->open_at_us) {
        open_port(urg);
    }
}

static void receive(ale_urg_t *urg)
{
    int status = ale_port_wait(urg->port, wait_ms(urg, urg->deadline_us));
    if (status > 0) {
        status = ale_port_read(urg->port, urg->bytes, sizeof urg->bytes);
    }
    if (status < 0) {
        reopen(urg, ale_port_strerror(status));
        return;
    }
    urg->read_us = now_us(urg);
    urg->byte_count = (uint32_t)status;
    urg->bytes_used = 0;
    ale_urg_dialogue_overhear(&urg->dialogue, urg->bytes, urg->byte_count);
}

/* The bytes of one step of the parser: what is tapped ends where a scan does, though it was read in one go.
 */
static void tap_received(const ale_urg_t *urg, const uint8_t *bytes, uint32_t count)
{
    if (urg->config.tap != NULL) {
        urg->config.tap(urg->config.tap_user, false, bytes, count, urg->read_us);
    }
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
        urg->open_failures = 0;
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
        urg->deadline_us = event->first_us + ale_urg_period_us(&urg->dialogue.identity.geometry);
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

/* Parses until a frame yields something, or all bytes are used. An event may close the port. */
static void parse(ale_urg_t *urg)
{
    while (urg->bytes_used < urg->byte_count) {
        ale_scip_event_t event;
        const uint8_t *bytes = urg->bytes + urg->bytes_used;
        const uint32_t count = (uint32_t)ale_scip_parse(
            &urg->parser, bytes, urg->byte_count - urg->bytes_used, urg->read_us, &event);
        urg->bytes_used += count;
        tap_received(urg, bytes, count);
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
    if (urg->port == NULL) {
        step_closed(urg);
        return hand_out(urg, scan);
    }
    if (urg->bytes_used == urg->byte_count) {
        receive(urg);
    }
    parse(urg);
    const bool idle = urg->port != NULL && urg->bytes_used == urg->byte_count;
    if (idle && now_us(urg) >= urg->deadline_us) {
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
    urg->open_at_us = now_us(urg);
    return &urg->scanner;
}

static void close_scanner(ale_scanner_t *scanner)
{
    ale_urg_t *urg = (ale_urg_t *)scanner;
    if (urg->port != NULL) {
        send_line(urg, "\nQT\n");
    }
    if (urg->port != NULL) {
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
