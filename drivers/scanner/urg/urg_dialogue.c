#include "scanner/urg/urg_dialogue.h"

#include <stdio.h>
#include <string.h>

#include "base/fixed.h"
#include "base/limits.h"
#include "scanner/urg/baud.h"

enum {
    REPLY_MS = 400, /* the real firmware answers once a turn of 100 ms */
    PROVED_TRIES = 6,
    BAUD_SETTLES_MS = 150,
    SPEED_ATTEMPTS = 3,
    MOST_CLUSTER = 99
};

/* What is still to be asked before the stream starts. */
enum { DUE_RESET = 1, DUE_PARAMETERS = 2, DUE_VERSION = 4, DUE_STATUS = 8 };

void ale_urg_dialogue_init(ale_urg_dialogue_t *d, const ale_scanner_config_t *config)
{
    memset(d, 0, sizeof *d);
    d->config = config;
    ale_urg_identity_init(&d->identity);
    d->geometry = d->identity.geometry;
}

/* The rate that has worked, else the configured one; 0: none. */
static int32_t preferred_baud(const ale_urg_dialogue_t *d)
{
    return d->good_baud > 0 ? d->good_baud : d->config->baud;
}

int32_t ale_urg_dialogue_first_baud(const ale_urg_dialogue_t *d)
{
    return ale_baud_candidate(preferred_baud(d), 0);
}

void ale_urg_dialogue_close(ale_urg_dialogue_t *d)
{
    d->phase = ALE_PHASE_CLOSED;
}

bool ale_urg_dialogue_streams(const ale_urg_dialogue_t *d)
{
    return d->phase == ALE_PHASE_WARM_UP || d->phase == ALE_PHASE_STREAM;
}

ale_scanner_state_t ale_urg_dialogue_state(const ale_urg_dialogue_t *d)
{
    switch (d->phase) {
    case ALE_PHASE_CLOSED:
        return ALE_SCANNER_CLOSED;
    case ALE_PHASE_PROBE:
    case ALE_PHASE_LEAVE_TM:
    case ALE_PHASE_SWITCH:
    case ALE_PHASE_VERSION_1:
        return ALE_SCANNER_DETECTING;
    case ALE_PHASE_STREAM:
        return ALE_SCANNER_STREAMING;
    case ALE_PHASE_POLL:
        return ALE_SCANNER_POLLING;
    default:
        return ALE_SCANNER_STARTING;
    }
}

static ale_urg_action_t act(ale_urg_deed_t deed, const char *reason)
{
    return (ale_urg_action_t){.deed = deed, .reason = reason};
}

/* Time-out of a reply: on a slow line a frame may have to pass first. */
static int32_t reply_ms(const ale_urg_dialogue_t *d)
{
    if (!d->has_baud) {
        return REPLY_MS;
    }
    const ale_scip_request_t full = {.last_step = 768, .characters = 3, .stream = true, .protocol = 2};
    return REPLY_MS + (int32_t)(ale_baud_time_us(d->baud, ale_scip_request_frame_bytes(&full)) / 1000);
}

/* Sends the present command, for the first time or again. */
static ale_urg_action_t ask(const ale_urg_dialogue_t *d)
{
    ale_urg_action_t action = {.deed = ALE_URG_SEND, .wait_ms = reply_ms(d)};
    /* A line end before the probe closes whatever half command the device may have received. */
    snprintf(action.line, sizeof action.line, "%s%s\n", d->phase == ALE_PHASE_PROBE ? "\n" : "", d->command);
    return action;
}

static ale_urg_action_t enter(ale_urg_dialogue_t *d, ale_urg_phase_t phase, const char *command)
{
    d->phase = phase;
    d->tries = 1;
    strncpy(d->command, command, sizeof d->command - 1);
    return ask(d);
}

static ale_urg_action_t probe(ale_urg_dialogue_t *d)
{
    ale_urg_action_t action = enter(d, ALE_PHASE_PROBE, "QT");
    action.stream = ALE_URG_STREAM_INTERRUPT;
    return action;
}

ale_urg_action_t ale_urg_dialogue_restart(ale_urg_dialogue_t *d, bool reset)
{
    d->due |= reset ? DUE_RESET | DUE_PARAMETERS : 0U;
    return probe(d);
}

ale_urg_action_t ale_urg_dialogue_open(ale_urg_dialogue_t *d, int32_t baud, bool has_baud)
{
    d->baud = baud;
    d->has_baud = has_baud;
    d->baud_attempt = 0;
    d->port_proved = false;
    d->stranger = (ale_stranger_t){0};
    d->due |= DUE_PARAMETERS;
    if (!d->identified) {
        /* RS would set the rate of a real line back to what nobody knows: there it is for emergencies. */
        d->due |= DUE_VERSION | DUE_STATUS | (has_baud ? 0U : DUE_RESET);
    }
    if (d->config->serial != NULL) {
        d->due |= DUE_VERSION;
    }
    return probe(d);
}

/* The configured window, within what the sensor measures. */
static void set_window(const ale_urg_dialogue_t *d, ale_scip_request_t *request)
{
    const ale_urg_geometry_t *g = &d->geometry;
    const ale_scanner_config_t *c = d->config;
    const bool window = c->first_step != 0 || c->last_step != 0;
    request->first_step = (uint16_t)(window ? c->first_step : g->first_step);
    request->last_step = (uint16_t)(window ? ale_min64(c->last_step, g->last_step) : g->last_step);
}

/* Merges beams until a scan can hold them. */
static void set_cluster(const ale_urg_dialogue_t *d, ale_scip_request_t *request)
{
    request->cluster = d->config->cluster;
    while (ale_scip_request_values(request) > ALE_MAX_BEAMS && request->cluster < MOST_CLUSTER) {
        request->cluster = (uint8_t)(request->cluster < 1 ? 2 : request->cluster + 1);
    }
}

/* The scans that the configuration wishes for, within what the sensor and the line can do. */
static void set_request(ale_urg_dialogue_t *d, uint8_t protocol)
{
    ale_scip_request_t *request = &d->request;
    *request = (ale_scip_request_t){
        .protocol = protocol, .stream = protocol == 2, .characters = protocol == 2 ? 3 : 2};
    set_window(d, request);
    set_cluster(d, request);
    if (request->stream && d->has_baud) {
        ale_baud_fit(request, d->baud, ale_urg_period_us(&d->geometry));
    }
    request->cluster = request->cluster < 1 ? 1 : request->cluster;
}

/* Asks for the scans of the request: MD, or the first G. */
static ale_urg_action_t ask_for_scans(ale_urg_dialogue_t *d, ale_urg_phase_t phase, uint8_t protocol)
{
    char text[ALE_SCIP_REQUEST_TEXT];
    set_request(d, protocol);
    ale_scip_request_format(&d->request, text);
    ale_urg_action_t action = enter(d, phase, text);
    action.stream = ALE_URG_STREAM_BEGIN;
    return action;
}

/* The rate that the line should run at: the one wished for, else at least the usual one. */
static int32_t wished_baud(const ale_urg_dialogue_t *d)
{
    if (d->config->baud > 0) {
        return d->config->baud;
    }
    return d->baud < ALE_BAUD_USUAL ? ALE_BAUD_USUAL : d->baud;
}

static bool speed_due(const ale_urg_dialogue_t *d)
{
    return d->has_baud && d->speed_attempts < SPEED_ATTEMPTS && d->baud != wished_baud(d);
}

static ale_urg_action_t ask_for_speed(ale_urg_dialogue_t *d)
{
    char text[sizeof "SS-2147483648"];
    snprintf(text, sizeof text, "SS%06d", (int)wished_baud(d));
    d->speed_attempts++;
    return enter(d, ALE_PHASE_SPEED, text);
}

/* The next question that is due, and the stream when there is none. */
static ale_urg_action_t advance(ale_urg_dialogue_t *d)
{
    if ((d->due & DUE_RESET) != 0) {
        return enter(d, ALE_PHASE_RESET, "RS");
    }
    if (speed_due(d)) {
        return ask_for_speed(d);
    }
    if ((d->due & DUE_PARAMETERS) != 0) {
        d->identity.warnings = 0;
        return enter(d, ALE_PHASE_PARAMETERS, "PP");
    }
    if ((d->due & DUE_VERSION) != 0) {
        d->identity.device.serial[0] = '\0';
        return enter(d, ALE_PHASE_VERSION, "VV");
    }
    if ((d->due & DUE_STATUS) != 0) {
        return enter(d, ALE_PHASE_STATUS, "II");
    }
    return ask_for_scans(d, ALE_PHASE_START, 2);
}

static ale_urg_action_t done(ale_urg_dialogue_t *d, uint32_t what)
{
    d->due &= ~what;
    return advance(d);
}

/* A reply to QT tells the protocol. */
static ale_urg_action_t on_probe(ale_urg_dialogue_t *d, const ale_scip_event_t *reply)
{
    d->protocol = reply->protocol;
    d->good_baud = d->baud;
    if (reply->protocol == 1) {
        ale_urg_action_t action = enter(d, ALE_PHASE_SWITCH, "SCIP2.0");
        action.stream = ALE_URG_STREAM_FORGET_CLOCK;
        return action;
    }
    const bool stopped = strcmp(reply->status, "00") == 0;
    const bool lead_out = !stopped && !d->led_out;
    d->led_out = lead_out;
    if (stopped) {
        return advance(d);
    }
    return lead_out ? enter(d, ALE_PHASE_LEAVE_TM, "TM2")
                    : act(ALE_URG_FAIL, "the sensor refuses to stop measuring");
}

static ale_urg_action_t on_switch(ale_urg_dialogue_t *d, const ale_scip_event_t *reply)
{
    const bool switched = strcmp(reply->status, "0") == 0;
    if (!switched && reply->protocol != 2) {
        return enter(d, ALE_PHASE_VERSION_1, "V");
    }
    d->protocol = 2;
    return advance(d);
}

static ale_urg_action_t on_reset(ale_urg_dialogue_t *d)
{
    d->resets++;
    d->due &= ~(uint32_t)DUE_RESET;
    ale_urg_action_t action = d->has_baud ? probe(d) : advance(d);
    action.stream |= ALE_URG_STREAM_FORGET_CLOCK;
    return action;
}

static ale_urg_action_t on_refused_speed(ale_urg_dialogue_t *d)
{
    d->speed_attempts = SPEED_ATTEMPTS;
    return advance(d);
}

static ale_urg_action_t on_speed(ale_urg_dialogue_t *d, const ale_scip_event_t *reply)
{
    if (strcmp(reply->status, "00") != 0) {
        return on_refused_speed(d);
    }
    return (ale_urg_action_t){.deed = ALE_URG_SET_BAUD, .baud = wished_baud(d)};
}

ale_urg_action_t ale_urg_dialogue_baud_set(ale_urg_dialogue_t *d, int32_t baud, bool set)
{
    d->baud = set ? baud : d->baud;
    if (d->phase == ALE_PHASE_PROBE) {
        return probe(d);
    }
    if (!set) {
        return on_refused_speed(d);
    }
    /* The device needs a moment: the next question is asked when this phase is over. */
    d->command[0] = '\0';
    return (ale_urg_action_t){.wait_ms = BAUD_SETTLES_MS};
}

/* What was read of the identity is complete. Numbers may come with any answer, and none that make no sense
 * are kept. */
static void adopt_identity(ale_urg_dialogue_t *d)
{
    if (ale_urg_geometry_valid(&d->identity.geometry)) {
        d->geometry = d->identity.geometry;
    } else {
        d->identity.geometry = d->geometry;
        d->identity_warnings++;
    }
    d->known = d->identity.device;
    d->identity_warnings += d->identity.warnings;
    d->identity.warnings = 0;
}

static ale_urg_action_t on_version_1(ale_urg_dialogue_t *d)
{
    adopt_identity(d);
    d->poll_due = false;
    ale_urg_action_t action = ask_for_scans(d, ALE_PHASE_POLL, 1);
    action.stream |= ALE_URG_STREAM_DESCRIBE;
    action.identified = true;
    return action;
}

static ale_urg_action_t on_parameters(ale_urg_dialogue_t *d)
{
    const char *reason = NULL;
    if (!ale_urg_geometry_valid(&d->identity.geometry)) {
        ale_urg_identity_t standard;
        ale_urg_identity_init(&standard);
        d->identity.geometry = standard.geometry;
        d->identity_warnings++;
        reason = "the sensor's parameters make no sense: those of the data sheet are used";
    }
    adopt_identity(d);
    ale_urg_action_t action = done(d, DUE_PARAMETERS);
    action.stream |= ALE_URG_STREAM_DESCRIBE;
    action.identified = true;
    action.reason = reason;
    return action;
}

static ale_urg_action_t on_version(ale_urg_dialogue_t *d)
{
    adopt_identity(d);
    const char *wished = d->config->serial;
    const bool other = wished != NULL && strcmp(wished, d->identity.device.serial) != 0;
    d->identified = d->identified || !other;
    ale_urg_action_t action =
        other
            ? act(ALE_URG_REOPEN, "this is another sensor: its serial number differs from the one wished for")
            : done(d, DUE_VERSION);
    action.identified = true;
    return action;
}

static ale_urg_action_t on_status(ale_urg_dialogue_t *d)
{
    d->hardware_faults += strncmp(d->identity.status, "Trouble", strlen("Trouble")) == 0;
    adopt_identity(d);
    ale_urg_action_t action = done(d, DUE_STATUS);
    action.identified = true;
    action.reason = d->identity.status;
    return action;
}

static ale_urg_action_t on_start(ale_urg_dialogue_t *d, const ale_scip_event_t *reply)
{
    if (strcmp(reply->status, "00") == 0) {
        d->phase = ALE_PHASE_WARM_UP;
        const int64_t wait_ms = ale_max64(ALE_URG_FIRST_SCAN_MS, d->identity.played.silence_ms);
        return (ale_urg_action_t){.wait_ms = (int32_t)wait_ms};
    }
    snprintf(d->reason, sizeof d->reason, "the sensor refuses to measure: status %s", reply->status);
    return act(ALE_URG_FAIL, d->reason);
}

static ale_urg_action_t on_reply(ale_urg_dialogue_t *d, const ale_scip_event_t *reply)
{
    switch (d->phase) {
    case ALE_PHASE_PROBE:
        return on_probe(d, reply);
    case ALE_PHASE_LEAVE_TM:
        return probe(d);
    case ALE_PHASE_SWITCH:
        return on_switch(d, reply);
    case ALE_PHASE_VERSION_1:
        return on_version_1(d);
    case ALE_PHASE_RESET:
        return on_reset(d);
    case ALE_PHASE_SPEED:
        return on_speed(d, reply);
    case ALE_PHASE_PARAMETERS:
        return on_parameters(d);
    case ALE_PHASE_VERSION:
        return on_version(d);
    case ALE_PHASE_STATUS:
        return on_status(d);
    case ALE_PHASE_START:
        return on_start(d, reply);
    default:
        return act(ALE_URG_FAIL, "the sensor stopped measuring");
    }
}

ale_urg_action_t ale_urg_dialogue_hear(ale_urg_dialogue_t *d, const ale_scip_event_t *event)
{
    if (strcmp(event->echo, d->command) != 0) {
        return (ale_urg_action_t){0};
    }
    if (event->kind == ALE_SCIP_REPLY) {
        return on_reply(d, event);
    }
    ale_urg_identity_line(&d->identity, event->text, event->sum_right);
    return (ale_urg_action_t){0};
}

void ale_urg_dialogue_overhear(ale_urg_dialogue_t *d, const uint8_t *bytes, uint32_t count)
{
    if (d->phase == ALE_PHASE_PROBE) {
        ale_stranger_hear(&d->stranger, bytes, count);
    }
}

/* The port is given up, and why. */
static ale_urg_action_t nobody(ale_urg_dialogue_t *d, const char *at)
{
    char words[ALE_STRANGER_WORDS];
    ale_stranger_words(&d->stranger, words);
    snprintf(d->reason, sizeof d->reason, "no answer from the sensor%s: %s", at, words);
    return act(ALE_URG_REOPEN, d->reason);
}

/* No answer to QT: other rates, then the port from the beginning. */
static ale_urg_action_t on_silent_probe(ale_urg_dialogue_t *d)
{
    ale_stranger_judge(&d->stranger);
    if (!d->has_baud) {
        return nobody(d, "");
    }
    const int32_t preferred = preferred_baud(d);
    if (++d->baud_attempt >= ALE_BAUD_RATES) {
        d->good_baud = 0;
        return nobody(d, " at any baud rate");
    }
    return (ale_urg_action_t){.deed = ALE_URG_SET_BAUD,
                              .baud = ale_baud_candidate(preferred, d->baud_attempt)};
}

static ale_urg_action_t on_silent_version(ale_urg_dialogue_t *d)
{
    if (d->config->serial != NULL) {
        return act(ALE_URG_REOPEN, "the sensor does not tell its serial number");
    }
    d->identified = true;
    d->identity_warnings++;
    return done(d, DUE_VERSION);
}

static uint32_t most_tries(const ale_urg_dialogue_t *d)
{
    switch (d->phase) {
    case ALE_PHASE_PROBE:
        /* What measured a moment ago on this very port may begin again: scans sent meanwhile would be lost
         * on a closed port. */
        return d->port_proved && !d->has_baud ? PROVED_TRIES : 2;
    case ALE_PHASE_VERSION: /* asked again, some units fall silent */
    case ALE_PHASE_STATUS:
    case ALE_PHASE_SPEED:
    case ALE_PHASE_WARM_UP:
    case ALE_PHASE_STREAM:
        return 1;
    default:
        return 2;
    }
}

static ale_urg_action_t on_silence(ale_urg_dialogue_t *d)
{
    switch (d->phase) {
    case ALE_PHASE_PROBE:
        return on_silent_probe(d);
    case ALE_PHASE_SPEED:
        return advance(d);
    case ALE_PHASE_VERSION:
        return on_silent_version(d);
    case ALE_PHASE_STATUS:
        d->identity_warnings++;
        return done(d, DUE_STATUS);
    case ALE_PHASE_WARM_UP:
    case ALE_PHASE_STREAM:
        return act(ALE_URG_FAIL, "the sensor fell silent");
    default:
        return act(ALE_URG_FAIL, "the sensor does not answer");
    }
}

ale_urg_action_t ale_urg_dialogue_time_out(ale_urg_dialogue_t *d)
{
    if (d->phase == ALE_PHASE_POLL && d->poll_due) {
        d->poll_due = false;
        d->tries = 1;
        return ask(d);
    }
    if (d->tries < most_tries(d)) {
        d->tries++;
        return ask(d);
    }
    return on_silence(d);
}

bool ale_urg_dialogue_scan(ale_urg_dialogue_t *d)
{
    d->port_proved = true;
    /* A scan says as much as the acknowledgement that may have been lost. */
    if (d->phase == ALE_PHASE_START || d->phase == ALE_PHASE_WARM_UP) {
        d->phase = ALE_PHASE_STREAM;
    }
    return d->phase == ALE_PHASE_STREAM;
}

void ale_urg_dialogue_proved(ale_urg_dialogue_t *d)
{
    d->speed_attempts = 0;
}

bool ale_urg_dialogue_polled(ale_urg_dialogue_t *d)
{
    const bool polls = d->phase == ALE_PHASE_POLL;
    d->poll_due = polls;
    d->tries = polls ? 0 : d->tries;
    return polls;
}
