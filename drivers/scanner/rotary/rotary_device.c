#include "scanner/rotary/rotary_device.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/fixed.h"
#include "scanner/connection.h"
#include "scanner/rotary/diagnosis.h"
#include "scanner/rotary/rotary_stream.h"

enum {
    FIRST_SCAN_MS = 1000, /* from the beginning of listening to the first whole turn */
    RESTARTS = 2          /* of the stream without a scan, before the port is opened anew */
};

typedef struct {
    ale_scanner_t scanner; /* first */
    ale_scanner_config_t config;
    const ale_rotary_protocol_t *protocol;
    void *state; /* of the protocol */
    ale_scanner_health_t health;
    bool changed;
    ale_connection_t connection;
    bool asking; /* an answer is waited for */
    int64_t deadline_us;
    uint32_t restarts; /* since the last scan */
    uint32_t rate;     /* of the protocol's, that is tried */
    bool rate_proved;  /* a packet came at it since the last try to open */
    bool learned;      /* what the sensor is */
    ale_line_seen_t seen;
    uint32_t last_bearing_bam;
    bool slow;
    ale_rotary_facts_t facts;
    ale_rotary_stream_t stream;
    ale_rotary_packet_t packet;
} ale_rotary_t;

static int32_t baud_of(const ale_rotary_t *r)
{
    return r->config.baud > 0 ? r->config.baud : r->protocol->bauds[r->rate];
}

static void set_deadline(ale_rotary_t *r, int32_t ms)
{
    r->deadline_us = ale_connection_deadline_us(&r->connection, ms);
}

/* Status in plain words; tells the caller of the step if it is news. */
static void say(ale_rotary_t *r, const char *text)
{
    if (strcmp(r->health.status, text) != 0) {
        snprintf(r->health.status, sizeof r->health.status, "%s", text);
        r->changed = true;
    }
}

static void enter(ale_rotary_t *r, ale_scanner_state_t state)
{
    r->changed = r->changed || r->health.state != state;
    r->health.state = state;
}

static void next_rate(ale_rotary_t *r)
{
    r->rate++;
    if (r->rate == ALE_ROTARY_BAUDS || r->protocol->bauds[r->rate] == 0) {
        r->rate = 0;
    }
}

static void reopen(ale_rotary_t *r, const char *reason)
{
    say(r, reason);
    r->health.reopens++;
    if (!r->rate_proved) {
        next_rate(r);
    }
    r->rate_proved = false;
    ale_connection_close(&r->connection);
    enter(r, ALE_SCANNER_CLOSED);
}

/* Does what the protocol wants; trouble closes the port. */
static void perform(ale_rotary_t *r, const ale_rotary_request_t *request)
{
    if (request->dtr != ALE_DTR_KEEP) {
        (void)ale_port_set_dtr(r->connection.port, request->dtr == ALE_DTR_ON);
    }
    if (request->gives_up) {
        char words[ALE_DIAGNOSIS_WORDS];
        ale_diagnosis_no_scan(r->protocol, &r->seen, baud_of(r), words);
        reopen(r, r->facts.words[0] != '\0' ? r->facts.words : words);
        return;
    }
    const int status =
        request->count > 0 ? ale_connection_send(&r->connection, request->bytes, request->count) : 0;
    if (status < 0) {
        reopen(r, ale_port_strerror(status));
        return;
    }
    r->asking = !request->streams;
    set_deadline(r, request->wait_ms);
    enter(r, r->asking ? ALE_SCANNER_DETECTING : ALE_SCANNER_STARTING);
}

static void learn(ale_rotary_t *r)
{
    r->protocol->facts(r->state, &r->facts);
    r->health.hardware_faults = r->facts.hardware_faults;
    ale_turns_range(&r->stream.turns, r->facts.range_min_um, r->facts.range_max_um);
    if (memcmp(&r->health.identity, &r->facts.identity, sizeof r->facts.identity) != 0) {
        r->health.identity = r->facts.identity;
        r->changed = true;
    }
}

static void ask(ale_rotary_t *r, bool late)
{
    const ale_rotary_request_t request = r->protocol->next(r->state, late);
    learn(r);
    perform(r, &request);
}

/* The stream from its beginning, on a port that is open. */
static void begin(ale_rotary_t *r)
{
    r->protocol->begin(r->state);
    r->learned = false;
    r->seen = (ale_line_seen_t){0};
    ale_rotary_stream_begin(&r->stream);
    if (r->protocol->next != NULL) {
        ask(r, false);
    } else {
        perform(r, &(ale_rotary_request_t){.streams = true, .wait_ms = FIRST_SCAN_MS});
    }
}

static void step_closed(ale_rotary_t *r)
{
    char words[sizeof r->health.status] = "";
    if (!ale_connection_open(&r->connection, baud_of(r), r->health.port, words)) {
        return;
    }
    r->health.baud = baud_of(r);
    if (r->connection.port == NULL) {
        say(r, words);
        return;
    }
    r->restarts = 0;
    begin(r);
}

/* No answer in time, or no scan. */
static void time_out(ale_rotary_t *r)
{
    if (r->asking) {
        ask(r, true);
        return;
    }
    char words[ALE_DIAGNOSIS_WORDS];
    ale_diagnosis_no_scan(r->protocol, &r->seen, baud_of(r), words);
    const bool in_vain = r->protocol->next != NULL && ++r->restarts > RESTARTS;
    if (r->seen.packets == 0 || in_vain) {
        reopen(r, words);
        return;
    }
    say(r, words);
    r->health.stream_restarts++;
    begin(r);
}

static bool is_the_one(ale_rotary_t *r)
{
    const char *wanted = r->config.serial;
    return wanted == NULL || strcmp(wanted, r->facts.identity.serial) == 0;
}

static void refuse(ale_rotary_t *r)
{
    char words[sizeof r->health.status];
    snprintf(words, sizeof words, "the scanner there has the serial number \"%.31s\", not %.31s",
             r->facts.identity.serial, r->config.serial);
    reopen(r, words);
}

static void follow_bearing(ale_rotary_t *r)
{
    for (uint32_t k = 0; k < r->packet.count; k++) {
        const uint32_t bearing_bam = r->packet.points[k].bearing_bam;
        const int32_t ahead = (int32_t)(bearing_bam - r->last_bearing_bam);
        const int64_t turned = (int64_t)r->seen.turned + (r->learned ? ale_abs64(ahead) : 0);
        r->seen.turned = (uint32_t)ale_min64(turned, UINT32_MAX);
        r->last_bearing_bam = bearing_bam;
    }
}

static void take_points(ale_rotary_t *r)
{
    follow_bearing(r);
    r->seen.packets++;
    r->rate_proved = true;
    if (!r->learned) {
        r->learned = true;
        learn(r);
        if (!is_the_one(r)) {
            refuse(r);
            return;
        }
    }
    if (!ale_rotary_stream_take(&r->stream, &r->packet, r->connection.read_us, baud_of(r))) {
        r->health.resets++;
    }
}

static void take_packet(ale_rotary_t *r)
{
    r->health.garbage_bytes += r->packet.garbage;
    switch (r->packet.kind) {
    case ALE_PACKET_POINTS:
        take_points(r);
        break;
    case ALE_PACKET_DAMAGED:
        r->seen.damaged++;
        r->health.bad_checksum++;
        break;
    case ALE_PACKET_ANSWER:
        r->seen.answers++;
        r->rate_proved = true;
        ask(r, false);
        break;
    case ALE_PACKET_NONE:
        break;
    }
}

static bool yields(const ale_rotary_t *r)
{
    return r->stream.turns.scan_waits || r->stream.turns.losses_owed > 0;
}

/* Reads on until a turn is over, or all bytes are used. A packet may close the port. */
static void parse(ale_rotary_t *r)
{
    ale_connection_t *c = &r->connection;
    uint32_t run = 0;
    while (c->used + run < c->count && !yields(r)) {
        const uint8_t *bytes = c->bytes + c->used + run;
        const uint32_t count = r->protocol->parse(r->state, bytes, c->count - c->used - run, &r->packet);
        run += count;
        take_packet(r);
    }
    if (c->port != NULL) {
        ale_connection_use(c, run);
    }
}

static void receive(ale_rotary_t *r)
{
    const int status = ale_connection_receive(&r->connection, r->deadline_us);
    if (status < 0) {
        reopen(r, ale_port_strerror(status));
        return;
    }
    r->seen.bytes = (uint32_t)ale_min64((int64_t)r->seen.bytes + r->connection.count, UINT32_MAX);
}

/* What is said of a scanner that works. */
static void say_how_it_runs(ale_rotary_t *r)
{
    char words[ALE_DIAGNOSIS_WORDS];
    r->slow = ale_diagnosis_slow(r->protocol, ale_turns_speed_mdeg_s(&r->stream.turns), r->slow, words);
    say(r, r->slow ? words : r->facts.words);
}

static void take_scan(ale_rotary_t *r, const ale_scan_t *scan)
{
    ale_scanner_health_t *h = &r->health;
    h->scans++;
    h->last_scan_us = scan->stamp_us;
    h->arrival_us = r->connection.read_us;
    h->clock_offset_us = r->stream.clock.host_us - r->stream.clock.sensor_us;
    h->clock_rate_ppb = r->stream.clock.slope_ppm * 1000;
    h->scan_period_us = r->stream.turns.period_us;
    h->silence_ms = (int32_t)ale_rotary_stream_silence_ms(&r->stream);
    r->restarts = 0;
    r->seen = (ale_line_seen_t){0};
    ale_connection_proved(&r->connection);
    set_deadline(r, h->silence_ms);
    enter(r, ALE_SCANNER_STREAMING);
    say_how_it_runs(r);
}

static ale_scanner_event_t hand_out(ale_rotary_t *r, ale_scan_t *scan)
{
    const ale_scanner_event_t event = ale_turns_next(&r->stream.turns, scan);
    if (event == ALE_SCANNER_SCAN) {
        take_scan(r, scan);
        return event;
    }
    if (event == ALE_SCANNER_SCAN_LOST) {
        r->health.scans_lost++;
        return event;
    }
    if (r->changed) {
        r->changed = false;
        return ALE_SCANNER_CHANGED;
    }
    return ALE_SCANNER_IDLE;
}

ale_scanner_event_t ale_rotary_step(ale_scanner_t *scanner, ale_scan_t *scan)
{
    ale_rotary_t *r = (ale_rotary_t *)scanner;
    const ale_scanner_event_t waiting = hand_out(r, scan);
    if (waiting != ALE_SCANNER_IDLE) {
        return waiting;
    }
    if (r->connection.port == NULL) {
        step_closed(r);
        return hand_out(r, scan);
    }
    if (r->connection.used == r->connection.count) {
        receive(r);
    }
    parse(r);
    const bool idle = r->connection.port != NULL && r->connection.used == r->connection.count;
    if (idle && ale_connection_now_us(&r->connection) >= r->deadline_us) {
        time_out(r);
    }
    return hand_out(r, scan);
}

const ale_scanner_health_t *ale_rotary_health(const ale_scanner_t *scanner)
{
    return &((const ale_rotary_t *)scanner)->health;
}

ale_scanner_t *ale_rotary_open(const ale_scanner_family_t *family, const ale_rotary_protocol_t *protocol,
                               const ale_scanner_config_t *config)
{
    ale_rotary_t *r = calloc(1, sizeof *r);
    void *state = calloc(1, protocol->state_bytes);
    if (r == NULL || state == NULL) {
        free(r);
        free(state);
        return NULL;
    }
    r->scanner.family = family;
    r->config = *config;
    r->protocol = protocol;
    r->state = state;
    ale_rotary_stream_init(&r->stream, protocol->clockwise, config->reversed);
    ale_connection_init(&r->connection, &r->config);
    return &r->scanner;
}

void ale_rotary_close(ale_scanner_t *scanner)
{
    ale_rotary_t *r = (ale_rotary_t *)scanner;
    if (r->connection.port != NULL && r->protocol->stop != NULL) {
        const ale_rotary_request_t request = r->protocol->stop(r->state);
        perform(r, &request);
    }
    if (r->connection.port != NULL) {
        ale_connection_close(&r->connection);
    }
    free(r->state);
    free(r);
}
