#include <stdio.h>
#include <string.h>

#include "base/fixed.h"
#include "scanner/urg/baud.h"
#include "scanner/urg/scip_request.h"
#include "scanner/urg/urg_internal.h"

enum {
    REPLY_MS = 400, /* the real firmware answers once a turn of 100 ms */
    PROVED_TRIES = 6,
    BAUD_SETTLES_MS = 150,
    SPEED_ATTEMPTS = 3
};

int64_t ale_urg_deadline(const ale_urg_t *urg, int32_t ms)
{
    return ale_urg_now_us(urg) + ale_urg_timeout_us(urg, ms);
}

/* Time-out of a reply: on a slow line a frame may have to pass first. */
static int64_t reply_deadline(const ale_urg_t *urg)
{
    int32_t ms = REPLY_MS;
    if (ale_port_has_baud(urg->port)) {
        const ale_scip_request_t full = {.last_step = 768, .characters = 3, .stream = true, .protocol = 2};
        ms += (int32_t)(ale_baud_time_us(urg->health.baud, ale_scip_request_frame_bytes(&full)) / 1000);
    }
    return ale_urg_deadline(urg, ms);
}

static void send_command(ale_urg_t *urg)
{
    char line[ALE_URG_COMMAND + 3];
    /* A line end before the probe closes whatever half command the device may have received. */
    snprintf(line, sizeof line, "%s%s\n", urg->phase == ALE_PHASE_PROBE ? "\n" : "", urg->command);
    urg->deadline_us = reply_deadline(urg);
    ale_urg_send(urg, line);
}

static void enter(ale_urg_t *urg, ale_urg_phase_t phase, const char *command)
{
    urg->phase = phase;
    urg->tries = 1;
    snprintf(urg->command, sizeof urg->command, "%s", command);
    send_command(urg);
}

void ale_urg_probe(ale_urg_t *urg)
{
    ale_urg_set_state(urg, ALE_URG_DETECTING);
    ale_urg_stream_interrupt(&urg->stream);
    enter(urg, ALE_PHASE_PROBE, "QT");
}

void ale_urg_dialogue_begin(ale_urg_t *urg)
{
    ale_scip_parser_reset(&urg->parser);
    urg->port_proved = false;
    urg->due |= ALE_DUE_PARAMETERS;
    if (!urg->identified) {
        /* RS would set the rate of a real line back to what nobody knows: there it is for emergencies. */
        urg->due |= ALE_DUE_VERSION | ALE_DUE_STATUS | (ale_port_has_baud(urg->port) ? 0 : ALE_DUE_RESET);
    }
    if (urg->config.serial != NULL) {
        urg->due |= ALE_DUE_VERSION;
    }
    ale_urg_probe(urg);
}

/* The stream that the configuration wishes for, within what the sensor and the line can do. */
static ale_scip_request_t stream_request(const ale_urg_t *urg, uint8_t protocol)
{
    const ale_urg_geometry_t *g = &urg->identity.geometry;
    const ale_urg_config_t *c = &urg->config;
    const bool window = c->first_step != 0 || c->last_step != 0;
    ale_scip_request_t request = {.protocol = protocol, .stream = protocol == 2, .cluster = c->cluster};
    request.first_step = (uint16_t)(window ? ale_max64(c->first_step, 0) : g->first_step);
    request.last_step = (uint16_t)(window ? ale_min64(c->last_step, g->last_step) : g->last_step);
    request.skip = protocol == 2 ? c->skip : 0;
    request.characters = protocol == 2 && !c->two_character ? 3 : 2;
    while (ale_scip_request_values(&request) > ALE_MAX_BEAMS && request.cluster < 99) {
        request.cluster = (uint8_t)(request.cluster < 1 ? 2 : request.cluster + 1);
    }
    if (protocol == 2 && ale_port_has_baud(urg->port)) {
        ale_baud_fit(&request, urg->health.baud, ale_urg_period_us(g));
    }
    request.cluster = request.cluster < 1 ? 1 : request.cluster;
    return request;
}

/* The rate that the line should run at: the one wished for, else at least the usual one. */
static int32_t wished_baud(const ale_urg_t *urg)
{
    if (urg->config.baud > 0) {
        return urg->config.baud;
    }
    return urg->health.baud < ALE_BAUD_USUAL ? ALE_BAUD_USUAL : urg->health.baud;
}

static bool speed_due(const ale_urg_t *urg)
{
    return ale_port_has_baud(urg->port) && urg->speed_attempts < SPEED_ATTEMPTS &&
           urg->health.baud != wished_baud(urg);
}

static void start_stream(ale_urg_t *urg)
{
    ale_scip_request_t request = stream_request(urg, 2);
    char text[ALE_SCIP_REQUEST_TEXT];
    ale_scip_request_format(&request, text);
    ale_urg_stream_begin(&urg->stream, &request);
    urg->bad_frames = 0;
    urg->frozen = 0;
    ale_urg_set_state(urg, ALE_URG_STARTING);
    enter(urg, ALE_PHASE_START, text);
}

static void start_polling(ale_urg_t *urg)
{
    ale_scip_request_t request = stream_request(urg, 1);
    char text[ALE_SCIP_REQUEST_TEXT];
    ale_scip_request_format(&request, text);
    ale_urg_stream_describe(&urg->stream, &urg->identity.geometry);
    ale_urg_stream_begin(&urg->stream, &request);
    ale_urg_set_state(urg, ALE_URG_POLLING);
    urg->poll_at_us = 0;
    enter(urg, ALE_PHASE_POLL, text);
}

/* The next question that is due, and the stream when there is none. */
static void advance(ale_urg_t *urg)
{
    ale_urg_set_state(urg, ALE_URG_STARTING);
    if ((urg->due & ALE_DUE_RESET) != 0) {
        enter(urg, ALE_PHASE_RESET, "RS");
    } else if (speed_due(urg)) {
        char text[ALE_URG_COMMAND];
        snprintf(text, sizeof text, "SS%06d", (int)wished_baud(urg));
        urg->speed_attempts++;
        enter(urg, ALE_PHASE_SPEED, text);
    } else if ((urg->due & ALE_DUE_PARAMETERS) != 0) {
        urg->identity.warnings = 0;
        enter(urg, ALE_PHASE_PARAMETERS, "PP");
    } else if ((urg->due & ALE_DUE_VERSION) != 0) {
        urg->identity.serial[0] = '\0';
        enter(urg, ALE_PHASE_VERSION, "VV");
    } else if ((urg->due & ALE_DUE_STATUS) != 0) {
        enter(urg, ALE_PHASE_STATUS, "II");
    } else {
        start_stream(urg);
    }
}

static void done(ale_urg_t *urg, uint32_t what)
{
    urg->due &= ~what;
    advance(urg);
}

/* A reply to QT tells the protocol. */
static void on_probe(ale_urg_t *urg, const ale_scip_event_t *reply)
{
    urg->health.protocol = reply->protocol;
    urg->good_baud = urg->health.baud;
    if (reply->protocol == 1) {
        ale_urg_stream_forget_clock(&urg->stream);
        enter(urg, ALE_PHASE_SWITCH, "SCIP2.0");
    } else if (strcmp(reply->status, "00") == 0) {
        urg->led_out = false;
        advance(urg);
    } else if (!urg->led_out) {
        urg->led_out = true;
        enter(urg, ALE_PHASE_LEAVE_TM, "TM2");
    } else {
        urg->led_out = false;
        ale_urg_fail(urg, "the sensor refuses to stop measuring");
    }
}

static void on_switch(ale_urg_t *urg, const ale_scip_event_t *reply)
{
    const bool switched = strcmp(reply->status, "0") == 0;
    if (switched || reply->protocol == 2) {
        urg->health.protocol = 2;
        advance(urg);
    } else {
        enter(urg, ALE_PHASE_VERSION_1, "V");
    }
}

static void on_reset(ale_urg_t *urg)
{
    urg->health.resets++;
    urg->due &= ~(uint32_t)ALE_DUE_RESET;
    ale_urg_stream_forget_clock(&urg->stream);
    if (ale_port_has_baud(urg->port)) {
        ale_urg_probe(urg);
    } else {
        advance(urg);
    }
}

static void on_speed(ale_urg_t *urg, const ale_scip_event_t *reply)
{
    const int32_t baud = wished_baud(urg);
    if (strcmp(reply->status, "00") != 0 || ale_port_set_baud(urg->port, baud) != ALE_PORT_OK) {
        urg->speed_attempts = SPEED_ATTEMPTS;
        advance(urg);
        return;
    }
    urg->health.baud = baud;
    /* The device needs a moment: the next question is asked when this phase is over. */
    urg->deadline_us = ale_urg_deadline(urg, BAUD_SETTLES_MS);
    urg->command[0] = '\0';
}

static void adopt_identity(ale_urg_t *urg)
{
    ale_urg_health_t *h = &urg->health;
    snprintf(h->model, sizeof h->model, "%s", urg->identity.model);
    snprintf(h->firmware, sizeof h->firmware, "%s", urg->identity.firmware);
    snprintf(h->serial, sizeof h->serial, "%s", urg->identity.serial);
    h->identity_warnings += urg->identity.warnings;
    urg->identity.warnings = 0;
    urg->changed = true;
}

static void on_parameters(ale_urg_t *urg)
{
    if (!ale_urg_geometry_valid(&urg->identity.geometry)) {
        ale_urg_identity_t standard;
        ale_urg_identity_init(&standard);
        urg->identity.geometry = standard.geometry;
        urg->health.identity_warnings++;
        ale_urg_say(urg, "the sensor's parameters make no sense: those of the data sheet are used");
    }
    ale_urg_stream_describe(&urg->stream, &urg->identity.geometry);
    adopt_identity(urg);
    done(urg, ALE_DUE_PARAMETERS);
}

static void on_version(ale_urg_t *urg)
{
    adopt_identity(urg);
    if (urg->config.serial != NULL && strcmp(urg->config.serial, urg->identity.serial) != 0) {
        ale_urg_reopen(urg, "this is another sensor: its serial number differs from the one wished for");
        return;
    }
    urg->identified = true;
    done(urg, ALE_DUE_VERSION);
}

static void on_start(ale_urg_t *urg, const ale_scip_event_t *reply)
{
    if (strcmp(reply->status, "00") == 0) {
        urg->phase = ALE_PHASE_STREAM;
        urg->deadline_us = ale_urg_deadline(urg, ALE_URG_FIRST_SCAN_MS);
        return;
    }
    char reason[64];
    snprintf(reason, sizeof reason, "the sensor refuses to measure: status %s", reply->status);
    ale_urg_fail(urg, reason);
}

static void on_reply(ale_urg_t *urg, const ale_scip_event_t *reply)
{
    switch (urg->phase) {
    case ALE_PHASE_PROBE:
        on_probe(urg, reply);
        break;
    case ALE_PHASE_LEAVE_TM:
        ale_urg_probe(urg);
        break;
    case ALE_PHASE_SWITCH:
        on_switch(urg, reply);
        break;
    case ALE_PHASE_VERSION_1:
        adopt_identity(urg);
        start_polling(urg);
        break;
    case ALE_PHASE_RESET:
        on_reset(urg);
        break;
    case ALE_PHASE_SPEED:
        on_speed(urg, reply);
        break;
    case ALE_PHASE_PARAMETERS:
        on_parameters(urg);
        break;
    case ALE_PHASE_VERSION:
        on_version(urg);
        break;
    case ALE_PHASE_STATUS:
        urg->health.hardware_faults += strncmp(urg->identity.status, "Trouble", strlen("Trouble")) == 0;
        ale_urg_say(urg, urg->identity.status);
        adopt_identity(urg);
        done(urg, ALE_DUE_STATUS);
        break;
    case ALE_PHASE_START:
        on_start(urg, reply);
        break;
    default:
        ale_urg_fail(urg, "the sensor stopped measuring");
        break;
    }
}

void ale_urg_dialogue_event(ale_urg_t *urg, const ale_scip_event_t *event)
{
    const bool ours = strcmp(event->echo, urg->command) == 0;
    switch (event->kind) {
    case ALE_SCIP_LINE_READ:
        if (ours) {
            ale_urg_identity_line(&urg->identity, event->text, event->sum_right);
        }
        break;
    case ALE_SCIP_REPLY:
        if (urg->phase == ALE_PHASE_STREAM && event->has_request && event->request.stream) {
            ale_urg_stream_status(urg, event);
        } else if (ours) {
            on_reply(urg, event);
        }
        break;
    case ALE_SCIP_SCAN:
    case ALE_SCIP_LOST:
        ale_urg_frame(urg, event);
        break;
    default:
        break;
    }
}

int64_t ale_urg_dialogue_deadline(const ale_urg_t *urg)
{
    return urg->poll_at_us > 0 && urg->phase == ALE_PHASE_POLL ? urg->poll_at_us : urg->deadline_us;
}

/* No answer to QT: try again, then other rates, then the port from the beginning. */
static void on_silent_probe(ale_urg_t *urg)
{
    if (!ale_port_has_baud(urg->port)) {
        ale_urg_reopen(urg, "no answer from the sensor");
        return;
    }
    const int32_t preferred = urg->good_baud > 0 ? urg->good_baud : urg->config.baud;
    if (++urg->baud_attempt >= ALE_BAUD_RATES) {
        urg->good_baud = 0;
        ale_urg_reopen(urg, "no answer from the sensor at any baud rate");
        return;
    }
    const int32_t baud = ale_baud_candidate(preferred, urg->baud_attempt);
    if (ale_port_set_baud(urg->port, baud) == ALE_PORT_OK) {
        urg->health.baud = baud;
    }
    ale_scip_parser_reset(&urg->parser);
    ale_urg_probe(urg);
}

static uint32_t most_tries(const ale_urg_t *urg)
{
    switch (urg->phase) {
    case ALE_PHASE_PROBE:
        /* What measured a moment ago on this very port may begin again: scans sent meanwhile would be lost
         * on a closed port. */
        return urg->port_proved && !ale_port_has_baud(urg->port) ? PROVED_TRIES : 2;
    case ALE_PHASE_VERSION: /* asked again, some units fall silent */
    case ALE_PHASE_STATUS:
    case ALE_PHASE_SPEED:
    case ALE_PHASE_STREAM:
        return 1;
    default:
        return 2;
    }
}

static void on_silence(ale_urg_t *urg)
{
    switch (urg->phase) {
    case ALE_PHASE_PROBE:
        on_silent_probe(urg);
        break;
    case ALE_PHASE_SPEED:
        advance(urg);
        break;
    case ALE_PHASE_VERSION:
        if (urg->config.serial != NULL) {
            ale_urg_reopen(urg, "the sensor does not tell its serial number");
        } else {
            urg->identified = true;
            urg->health.identity_warnings++;
            done(urg, ALE_DUE_VERSION);
        }
        break;
    case ALE_PHASE_STATUS:
        urg->health.identity_warnings++;
        done(urg, ALE_DUE_STATUS);
        break;
    case ALE_PHASE_STREAM:
        ale_urg_fail(urg, "the sensor fell silent");
        break;
    default:
        ale_urg_fail(urg, "the sensor does not answer");
        break;
    }
}

void ale_urg_dialogue_time(ale_urg_t *urg)
{
    const int64_t now_us = ale_urg_now_us(urg);
    if (now_us < ale_urg_dialogue_deadline(urg)) {
        return;
    }
    if (urg->phase == ALE_PHASE_POLL && urg->poll_at_us > 0) {
        urg->poll_at_us = 0;
        urg->tries = 1;
        send_command(urg);
    } else if (urg->tries < most_tries(urg)) {
        urg->tries++;
        send_command(urg);
    } else {
        on_silence(urg);
    }
}
