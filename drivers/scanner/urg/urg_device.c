#include "scanner/urg/urg_device.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "base/fixed.h"
#include "scanner/urg/baud.h"
#include "scanner/urg/urg_internal.h"

enum {
    STEP_MS = 50,
    WRITE_MS = 200,
    REOPEN_MS = 100, /* first pause before the port is opened again; doubled up to the longest */
    LONGEST_REOPEN_MS = 400,
    LEAST_WALL_US = 100000 /* a simulator may run fast, but this computer's scheduler does not */
};

static double scale(const ale_urg_t *urg)
{
    return urg->config.time_scale > 0 ? urg->config.time_scale : 1;
}

int64_t ale_urg_now_us(const ale_urg_t *urg)
{
    if (urg->config.now_us != NULL) {
        return urg->config.now_us(urg->config.now_user);
    }
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    const int64_t host_us = (int64_t)now.tv_sec * 1000000 + now.tv_nsec / 1000;
    return (int64_t)((double)host_us * scale(urg));
}

int64_t ale_urg_timeout_us(const ale_urg_t *urg, int32_t ms)
{
    const int64_t floor_us = (int64_t)(LEAST_WALL_US * scale(urg));
    return ale_max64((int64_t)ms * 1000, floor_us);
}

void ale_urg_say(ale_urg_t *urg, const char *text)
{
    if (strcmp(urg->health.status, text) != 0) {
        snprintf(urg->health.status, sizeof urg->health.status, "%s", text);
        urg->changed = true;
    }
}

void ale_urg_set_state(ale_urg_t *urg, ale_urg_state_t state)
{
    urg->changed = urg->changed || urg->health.state != state;
    urg->health.state = state;
}

void ale_urg_close_port(ale_urg_t *urg)
{
    ale_port_close(urg->port);
    urg->port = NULL;
    urg->phase = ALE_PHASE_CLOSED;
    urg->byte_count = 0;
    urg->bytes_used = 0;
    urg->good_frames = 0;
    ale_urg_set_state(urg, ALE_URG_CLOSED);
}

static void schedule_open(ale_urg_t *urg)
{
    const uint32_t doublings = urg->open_failures < 4 ? urg->open_failures : 4;
    const int32_t pause_ms = REOPEN_MS << doublings;
    urg->open_failures++;
    urg->open_at_us =
        ale_urg_now_us(urg) + (int64_t)1000 * (pause_ms < LONGEST_REOPEN_MS ? pause_ms : LONGEST_REOPEN_MS);
}

void ale_urg_reopen(ale_urg_t *urg, const char *reason)
{
    ale_urg_say(urg, reason);
    urg->health.reopens++;
    ale_urg_close_port(urg);
    schedule_open(urg);
}

void ale_urg_send(ale_urg_t *urg, const char *text)
{
    const uint32_t count = (uint32_t)strlen(text);
    const int status = ale_port_write(urg->port, (const uint8_t *)text, count, WRITE_MS);
    if (status < 0) {
        ale_urg_reopen(urg, ale_port_strerror(status));
        return;
    }
    if (urg->config.tap != NULL) {
        urg->config.tap(urg->config.tap_user, true, (const uint8_t *)text, count, ale_urg_now_us(urg));
    }
}

/* The port to try now: the given one, or the next that a scanner may hang on; NULL when there is none. */
static const char *next_path(ale_urg_t *urg)
{
    if (urg->config.path != NULL) {
        return urg->config.path;
    }
    if (urg->candidate >= urg->candidate_count) {
        const char *directory = urg->config.device_directory;
        urg->candidate_count = ale_port_candidates(directory != NULL ? directory : "/dev", urg->candidates);
        urg->candidate = 0;
    }
    return urg->candidate_count > 0 ? urg->candidates[urg->candidate++] : NULL;
}

static void open_port(ale_urg_t *urg)
{
    const char *path = next_path(urg);
    if (path == NULL) {
        ale_urg_say(urg, "no serial device is there that could be a scanner");
        schedule_open(urg);
        return;
    }
    snprintf(urg->health.port, sizeof urg->health.port, "%s", path);
    const int32_t preferred = urg->good_baud > 0 ? urg->good_baud : urg->config.baud;
    const int32_t baud = ale_baud_candidate(preferred, 0);
    const int status = ale_port_open(&urg->port, path, baud);
    if (status < 0) {
        char text[sizeof urg->health.status];
        snprintf(text, sizeof text, "%.60s: %s", path, ale_port_strerror(status));
        ale_urg_say(urg, text);
        schedule_open(urg);
        return;
    }
    urg->health.baud = baud;
    urg->baud_attempt = 0;
    urg->failures = 0;
    ale_urg_dialogue_begin(urg);
}

/* Milliseconds to wait for the port until a moment of the urg's clock, within what a step may take. */
static int32_t wait_ms(const ale_urg_t *urg, int64_t until_us)
{
    const int32_t most_ms = urg->config.step_ms > 0 ? urg->config.step_ms : STEP_MS;
    const int64_t left_us = (int64_t)((double)(until_us - ale_urg_now_us(urg)) / scale(urg));
    return (int32_t)ale_clamp64((left_us + 999) / 1000, 0, most_ms);
}

static void step_closed(ale_urg_t *urg)
{
    if (ale_urg_now_us(urg) < urg->open_at_us) {
        ale_port_wait(NULL, wait_ms(urg, urg->open_at_us));
    }
    if (ale_urg_now_us(urg) >= urg->open_at_us) {
        open_port(urg);
    }
}

static void receive(ale_urg_t *urg)
{
    int status = ale_port_wait(urg->port, wait_ms(urg, ale_urg_dialogue_deadline(urg)));
    if (status > 0) {
        status = ale_port_read(urg->port, urg->bytes, sizeof urg->bytes);
    }
    if (status < 0) {
        ale_urg_reopen(urg, ale_port_strerror(status));
        return;
    }
    urg->read_us = ale_urg_now_us(urg);
    urg->byte_count = (uint32_t)status;
    urg->bytes_used = 0;
}

/* The bytes of one step of the parser: what is tapped ends where a scan does, though it was read in one go.
 */
static void tap_received(const ale_urg_t *urg, const uint8_t *bytes, uint32_t count)
{
    if (urg->config.tap != NULL) {
        urg->config.tap(urg->config.tap_user, false, bytes, count, urg->read_us);
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
        ale_urg_dialogue_event(urg, &event);
        if (event.kind == ALE_SCIP_SCAN || event.kind == ALE_SCIP_LOST) {
            break;
        }
    }
    urg->health.garbage_bytes = ale_scip_counters(&urg->parser)->garbage_bytes;
}

static ale_urg_event_t hand_out(ale_urg_t *urg, ale_scan_t *scan)
{
    const ale_urg_event_t event = ale_urg_stream_next(&urg->stream, scan);
    if (event != ALE_URG_IDLE) {
        urg->health.scans += event == ALE_URG_SCAN;
        urg->health.scans_lost += event == ALE_URG_SCAN_LOST;
        return event;
    }
    if (urg->changed) {
        urg->changed = false;
        return ALE_URG_CHANGED;
    }
    return ALE_URG_IDLE;
}

ale_urg_event_t ale_urg_step(ale_urg_t *urg, ale_scan_t *scan)
{
    const ale_urg_event_t waiting = hand_out(urg, scan);
    if (waiting != ALE_URG_IDLE) {
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
    if (urg->port != NULL && urg->bytes_used == urg->byte_count) {
        ale_urg_dialogue_time(urg);
    }
    return hand_out(urg, scan);
}

const ale_urg_health_t *ale_urg_health(const ale_urg_t *urg)
{
    return &urg->health;
}

ale_urg_t *ale_urg_create(const ale_urg_config_t *config)
{
    ale_urg_t *urg = calloc(1, sizeof *urg);
    if (urg == NULL) {
        return NULL;
    }
    urg->config = *config;
    ale_scip_parser_init(&urg->parser);
    ale_urg_identity_init(&urg->identity);
    ale_urg_stream_init(&urg->stream, config->reversed);
    urg->open_at_us = ale_urg_now_us(urg);
    return urg;
}

void ale_urg_destroy(ale_urg_t *urg)
{
    if (urg == NULL) {
        return;
    }
    if (urg->port != NULL) {
        ale_urg_send(urg, "\nQT\n");
    }
    if (urg->port != NULL) {
        ale_urg_close_port(urg);
    }
    free(urg);
}
