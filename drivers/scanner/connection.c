#include "scanner/connection.h"

#include <stdio.h>
#include <string.h>
#include <time.h>

#include "base/fixed.h"

enum {
    STEP_MS = 50,
    WRITE_MS = 200,
    REOPEN_MS = 100, /* first pause before the port is opened again; doubled up to the longest */
    LONGEST_REOPEN_MS = 400,
    LEAST_WALL_US = 100000 /* a simulator may run fast, but this computer's scheduler does not */
};

static double scale(const ale_connection_t *c)
{
    return c->config->time_scale > 0 ? c->config->time_scale : 1;
}

int64_t ale_connection_now_us(const ale_connection_t *c)
{
    if (c->config->now_us != NULL) {
        return c->config->now_us(c->config->now_user);
    }
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    const int64_t host_us = (int64_t)now.tv_sec * 1000000 + now.tv_nsec / 1000;
    return (int64_t)((double)host_us * scale(c));
}

int64_t ale_connection_deadline_us(const ale_connection_t *c, int32_t ms)
{
    const int64_t least_us = (int64_t)((double)LEAST_WALL_US * scale(c));
    return ale_connection_now_us(c) + ale_max64((int64_t)ms * 1000, least_us);
}

void ale_connection_init(ale_connection_t *c, const ale_scanner_config_t *config)
{
    memset(c, 0, sizeof *c);
    c->config = config;
    c->open_at_us = ale_connection_now_us(c);
}

/* Milliseconds to wait for the port until a moment of the config's clock, within what a step may take. */
static int32_t wait_ms(const ale_connection_t *c, int64_t until_us)
{
    const int32_t most_ms = c->config->step_ms > 0 ? c->config->step_ms : STEP_MS;
    const int64_t left_us = (int64_t)((double)(until_us - ale_connection_now_us(c)) / scale(c));
    return (int32_t)ale_clamp64((left_us + 999) / 1000, 0, most_ms);
}

/* The port to try now: the given one, or the next that a scanner may hang on; NULL when there is none. */
static const char *next_path(ale_connection_t *c)
{
    if (c->config->path != NULL) {
        return c->config->path;
    }
    if (c->candidate >= c->candidate_count) {
        c->candidate_count = ale_port_candidates("/dev", c->candidates);
        c->candidate = 0;
    }
    return c->candidate_count > 0 ? c->candidates[c->candidate++] : NULL;
}

static void schedule_open(ale_connection_t *c)
{
    const uint32_t doublings = c->failures < 4 ? c->failures : 4;
    const int32_t pause_ms = REOPEN_MS << doublings;
    c->failures++;
    c->open_at_us = ale_connection_now_us(c) +
                    (int64_t)1000 * (pause_ms < LONGEST_REOPEN_MS ? pause_ms : LONGEST_REOPEN_MS);
}

static void try_to_open(ale_connection_t *c, int32_t baud, char path[128], char words[168])
{
    const char *next = next_path(c);
    if (next == NULL) {
        snprintf(words, 168, "no serial device is there that could be a scanner");
        schedule_open(c);
        return;
    }
    snprintf(path, 128, "%s", next);
    const int status = ale_port_open(&c->port, next, baud);
    if (status < 0) {
        char why[ALE_PORT_WORDS];
        ale_port_explain(status, next, why);
        snprintf(words, 168, "%.60s: %s", next, why);
        schedule_open(c);
    }
}

bool ale_connection_open(ale_connection_t *c, int32_t baud, char path[128], char words[168])
{
    if (ale_connection_now_us(c) < c->open_at_us) {
        ale_port_wait(NULL, wait_ms(c, c->open_at_us));
    }
    if (ale_connection_now_us(c) < c->open_at_us) {
        return false;
    }
    try_to_open(c, baud, path, words);
    return true;
}

void ale_connection_close(ale_connection_t *c)
{
    ale_port_close(c->port);
    c->port = NULL;
    c->count = 0;
    c->used = 0;
    schedule_open(c);
}

void ale_connection_proved(ale_connection_t *c)
{
    c->failures = 0;
}

int ale_connection_receive(ale_connection_t *c, int64_t until_us)
{
    int status = ale_port_wait(c->port, wait_ms(c, until_us));
    if (status > 0) {
        status = ale_port_read(c->port, c->bytes, sizeof c->bytes);
    }
    c->read_us = ale_connection_now_us(c);
    c->count = status > 0 ? (uint32_t)status : 0;
    c->used = 0;
    return status < 0 ? status : ALE_PORT_OK;
}

void ale_connection_use(ale_connection_t *c, uint32_t count)
{
    if (c->config->tap != NULL) {
        c->config->tap(c->config->tap_user, false, c->bytes + c->used, count, c->read_us);
    }
    c->used += count;
}

int ale_connection_send(ale_connection_t *c, const uint8_t *bytes, uint32_t count)
{
    const int status = ale_port_write(c->port, bytes, count, WRITE_MS);
    if (status == ALE_PORT_OK && c->config->tap != NULL) {
        c->config->tap(c->config->tap_user, true, bytes, count, ale_connection_now_us(c));
    }
    return status < 0 ? status : ALE_PORT_OK;
}
