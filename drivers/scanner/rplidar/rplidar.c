/* The conversation with an RPLIDAR, and its family: stop, who are you, how are you, which scans do you offer,
 * motor, scan. Pure but for the family's functions, which are the rotary device's. */
#include "scanner/rplidar/rplidar.h"

#include <stdio.h>
#include <string.h>

#include "base/fixed.h"
#include "file/little_endian.h"
#include "scanner/rotary/rotary_device.h"
#include "scanner/scanner_family.h"

enum {
    SYNC = 0xa5,
    STOP = 0x25,
    RESET = 0x40,
    SCAN = 0x20,
    EXPRESS_SCAN = 0x82,
    GET_INFO = 0x50,
    GET_HEALTH = 0x52,
    GET_RATES = 0x59,
    GET_CONF = 0x84,
    MOTOR_SPEED = 0xa8,
    MOTOR_PWM = 0xf0,
    CONF_SAMPLE_US = 0x71, /* of a mode, in 1/256 us */
    CONF_ANSWER_TYPE = 0x75,
    CONF_TYPICAL = 0x7c,
    USUAL_RPM = 600,
    USUAL_PWM = 660, /* of an A2 or A3, 10 turns a second */
    QUIET_MS = 100,  /* after STOP what was under way comes in */
    ANSWER_MS = 300,
    RESET_MS = 1500,
    SPIN_UP_MS = 200,
    FIRST_SCAN_MS = 3000, /* a motor that stood comes to speed */
    TRIES = 3,
    EXPRESS_MODE = 1,
    MOST_POINT_NS = 10000000, /* a slower scanner there is not: years of points fit int64 */
    CONF_FIRMWARE = 0x0118,   /* 1.24 has GET_CONF, */
    RATES_FIRMWARE = 0x0111   /* 1.17 the express scan */
};

/* Of the upper half of the model's byte. */
enum { SERIES_A1 = 1, SERIES_A3 = 3, SERIES_C1 = 4, SERIES_S1 = 6, SERIES_S2 = 7 };

static ale_rotary_request_t request(uint8_t command, int32_t wait_ms)
{
    return (ale_rotary_request_t){.bytes = {SYNC, command}, .count = 2, .wait_ms = wait_ms};
}

static ale_rotary_request_t request_with(uint8_t command, const uint8_t *payload, uint32_t count,
                                         int32_t wait_ms)
{
    ale_rotary_request_t r = request(command, wait_ms);
    r.bytes[r.count++] = (uint8_t)count;
    memcpy(r.bytes + r.count, payload, count);
    r.count += count;
    uint8_t sum = 0;
    for (uint32_t k = 0; k < r.count; k++) {
        sum ^= r.bytes[k];
    }
    r.bytes[r.count++] = sum;
    return r;
}

/* Of a mode; of the typical one no mode is told. */
static ale_rotary_request_t ask_conf(const ale_rplidar_t *l, uint32_t entry)
{
    uint8_t payload[6];
    ale_put_u32(payload, entry);
    ale_put_u16(payload + 4, l->mode);
    return request_with(GET_CONF, payload, entry == CONF_TYPICAL ? 4 : 6, ANSWER_MS);
}

static uint8_t series(const ale_rplidar_t *l)
{
    return l->model >> 4;
}

static ale_rotary_request_t ask_to_turn(const ale_rplidar_t *l)
{
    const bool by_speed = series(l) >= SERIES_S1;
    uint8_t word[2];
    ale_put_u16(word, by_speed ? USUAL_RPM : USUAL_PWM);
    return request_with(by_speed ? MOTOR_SPEED : MOTOR_PWM, word, sizeof word, SPIN_UP_MS);
}

static ale_rotary_request_t ask_to_scan(const ale_rplidar_t *l)
{
    if (l->scan_type == ALE_RPLIDAR_STANDARD) {
        return request(SCAN, FIRST_SCAN_MS);
    }
    const uint8_t express[5] = {(uint8_t)l->mode};
    return request_with(EXPRESS_SCAN, express, sizeof express, FIRST_SCAN_MS);
}

typedef struct {
    uint8_t command;
    int32_t wait_ms;
} plain_t;

/* Requests that are the same for all. */
static const plain_t PLAIN[] = {
    [ALE_RPLIDAR_PHASE_STOP] = {STOP, QUIET_MS},          [ALE_RPLIDAR_PHASE_INFO] = {GET_INFO, ANSWER_MS},
    [ALE_RPLIDAR_PHASE_HEALTH] = {GET_HEALTH, ANSWER_MS}, [ALE_RPLIDAR_PHASE_RESET] = {RESET, RESET_MS},
    [ALE_RPLIDAR_PHASE_RATES] = {GET_RATES, ANSWER_MS},
};

/* What is sent in a phase. */
static ale_rotary_request_t say(const ale_rplidar_t *l)
{
    switch (l->phase) {
    case ALE_RPLIDAR_PHASE_TYPICAL:
        return ask_conf(l, CONF_TYPICAL);
    case ALE_RPLIDAR_PHASE_TYPE:
        return ask_conf(l, CONF_ANSWER_TYPE);
    case ALE_RPLIDAR_PHASE_SAMPLE:
        return ask_conf(l, CONF_SAMPLE_US);
    case ALE_RPLIDAR_PHASE_MOTOR:
        return ask_to_turn(l);
    case ALE_RPLIDAR_PHASE_SCAN:
        return ask_to_scan(l);
    default:
        return request(PLAIN[l->phase].command, PLAIN[l->phase].wait_ms);
    }
}

static bool offers_conf(const ale_rplidar_t *l)
{
    return series(l) >= SERIES_C1 || l->firmware >= CONF_FIRMWARE;
}

static bool can_be_read(uint8_t type)
{
    return type == ALE_RPLIDAR_STANDARD || type == ALE_RPLIDAR_EXPRESS || type == ALE_RPLIDAR_DENSE;
}

/* An A1 has its motor on DTR, a C1 turns by itself. */
static ale_rplidar_phase_t motor_or_scan(const ale_rplidar_t *l)
{
    const bool by_command = series(l) != SERIES_A1 && series(l) != SERIES_C1;
    return by_command ? ALE_RPLIDAR_PHASE_MOTOR : ALE_RPLIDAR_PHASE_SCAN;
}

static ale_rplidar_phase_t after_health(const ale_rplidar_t *l)
{
    if (offers_conf(l)) {
        return ALE_RPLIDAR_PHASE_TYPICAL;
    }
    return l->firmware >= RATES_FIRMWARE ? ALE_RPLIDAR_PHASE_RATES : motor_or_scan(l);
}

static void use_standard_scan(ale_rplidar_t *l)
{
    l->mode = 0;
    l->scan_type = ALE_RPLIDAR_STANDARD;
}

static ale_rplidar_phase_t take_info(ale_rplidar_t *l, const uint8_t *answer)
{
    l->model = answer[0];
    l->firmware = (uint16_t)(answer[2] << 8 | answer[1]);
    l->hardware = answer[3];
    memcpy(l->serial, answer + 4, sizeof l->serial);
    l->known = true;
    use_standard_scan(l);
    return ALE_RPLIDAR_PHASE_HEALTH;
}

static ale_rplidar_phase_t take_health(ale_rplidar_t *l, const uint8_t *answer)
{
    l->health = answer[0];
    l->error = ale_get_u16(answer + 1);
    if (l->health < ALE_RPLIDAR_ERROR) {
        l->was_reset = false;
        return after_health(l);
    }
    l->faults++;
    l->gives_up = l->was_reset;
    l->was_reset = false;
    return ALE_RPLIDAR_PHASE_RESET;
}

static ale_rplidar_phase_t take_rates(ale_rplidar_t *l, const uint8_t *answer)
{
    l->scan_type = ALE_RPLIDAR_EXPRESS;
    l->mode = 0;
    l->parser.point_ns = (int32_t)ale_min64((int64_t)ale_get_u16(answer + 2) * 1000, MOST_POINT_NS);
    return motor_or_scan(l);
}

/* Of a mode in a coding that is not read here the express scan, and then the standard scan, is taken in its
 * place. */
static ale_rplidar_phase_t take_type(ale_rplidar_t *l, const uint8_t *answer)
{
    if (can_be_read(answer[4])) {
        l->scan_type = answer[4];
        return ALE_RPLIDAR_PHASE_SAMPLE;
    }
    if (l->mode != EXPRESS_MODE) {
        l->mode = EXPRESS_MODE;
        return ALE_RPLIDAR_PHASE_TYPE;
    }
    use_standard_scan(l);
    return ALE_RPLIDAR_PHASE_SAMPLE;
}

static ale_rplidar_phase_t take_sample(ale_rplidar_t *l, const uint8_t *answer)
{
    l->parser.point_ns = (int32_t)ale_min64((int64_t)ale_get_u32(answer + 4) * 1000 / 256, MOST_POINT_NS);
    return motor_or_scan(l);
}

typedef struct {
    ale_rplidar_phase_t phase;
    uint8_t type;
    uint32_t least_bytes;
    uint32_t entry; /* of CONF */
} expected_t;

static const expected_t EXPECTED[] = {
    {ALE_RPLIDAR_PHASE_INFO, ALE_RPLIDAR_INFO, 20, 0},
    {ALE_RPLIDAR_PHASE_HEALTH, ALE_RPLIDAR_HEALTH, 3, 0},
    {ALE_RPLIDAR_PHASE_RATES, ALE_RPLIDAR_RATES, 4, 0},
    {ALE_RPLIDAR_PHASE_TYPICAL, ALE_RPLIDAR_CONF, 6, CONF_TYPICAL},
    {ALE_RPLIDAR_PHASE_TYPE, ALE_RPLIDAR_CONF, 5, CONF_ANSWER_TYPE},
    {ALE_RPLIDAR_PHASE_SAMPLE, ALE_RPLIDAR_CONF, 8, CONF_SAMPLE_US},
};

/* The answer at hand is the one that this phase waits for. */
static bool is_expected(const ale_rplidar_t *l)
{
    const ale_rplidar_parser_t *p = &l->parser;
    for (unsigned k = 0; k < sizeof EXPECTED / sizeof EXPECTED[0]; k++) {
        const expected_t *e = &EXPECTED[k];
        if (e->phase == l->phase && e->type == p->answer_type && p->answer_bytes >= e->least_bytes) {
            return e->entry == 0 || ale_get_u32(p->answer) == e->entry;
        }
    }
    return false;
}

static ale_rplidar_phase_t take_answer(ale_rplidar_t *l)
{
    const uint8_t *answer = l->parser.answer;
    switch (l->phase) {
    case ALE_RPLIDAR_PHASE_INFO:
        return take_info(l, answer);
    case ALE_RPLIDAR_PHASE_HEALTH:
        return take_health(l, answer);
    case ALE_RPLIDAR_PHASE_RATES:
        return take_rates(l, answer);
    case ALE_RPLIDAR_PHASE_TYPICAL:
        l->mode = ale_get_u16(answer + 4);
        return ALE_RPLIDAR_PHASE_TYPE;
    case ALE_RPLIDAR_PHASE_TYPE:
        return take_type(l, answer);
    case ALE_RPLIDAR_PHASE_SAMPLE:
        return take_sample(l, answer);
    default:
        return l->phase;
    }
}

/* Without an answer: a device that does not say it is not asked again. */
static ale_rplidar_phase_t without_answer(ale_rplidar_t *l)
{
    switch (l->phase) {
    case ALE_RPLIDAR_PHASE_STOP:
        ale_rplidar_parser_begin(&l->parser); /* what was under way is over */
        return ALE_RPLIDAR_PHASE_INFO;
    case ALE_RPLIDAR_PHASE_HEALTH:
        return after_health(l);
    case ALE_RPLIDAR_PHASE_RESET:
        l->was_reset = true;
        return ALE_RPLIDAR_PHASE_STOP;
    case ALE_RPLIDAR_PHASE_MOTOR:
        return ALE_RPLIDAR_PHASE_SCAN;
    default:
        use_standard_scan(l);
        return motor_or_scan(l);
    }
}

static bool waits_for_quiet(const ale_rplidar_t *l)
{
    return l->phase == ALE_RPLIDAR_PHASE_STOP || l->phase == ALE_RPLIDAR_PHASE_RESET ||
           l->phase == ALE_RPLIDAR_PHASE_MOTOR;
}

/* Nothing came in time. True: the same is asked again. */
static bool is_asked_again(ale_rplidar_t *l)
{
    return !waits_for_quiet(l) && ++l->tries < TRIES;
}

static ale_rotary_request_t next(void *state, bool late)
{
    ale_rplidar_t *l = state;
    if (!l->begun) {
        l->begun = true;
    } else if (late && !is_asked_again(l)) {
        if (l->phase == ALE_RPLIDAR_PHASE_INFO) {
            return (ale_rotary_request_t){.gives_up = true};
        }
        l->phase = without_answer(l);
        l->tries = 0;
    } else if (!late && is_expected(l)) {
        l->phase = take_answer(l);
        l->tries = 0;
    } else if (!late) {
        return (ale_rotary_request_t){.wait_ms = ANSWER_MS}; /* an answer to something else */
    }
    if (l->gives_up) {
        return (ale_rotary_request_t){.gives_up = true};
    }
    ale_rotary_request_t out = say(l);
    out.dtr = ALE_DTR_OFF;
    out.streams = l->phase == ALE_RPLIDAR_PHASE_SCAN;
    return out;
}

static void begin(void *state)
{
    ale_rplidar_t *l = state;
    ale_rplidar_parser_begin(&l->parser);
    l->phase = ALE_RPLIDAR_PHASE_STOP;
    l->begun = false;
    l->gives_up = false;
    l->tries = 0;
}

static void overhear_answer(ale_rplidar_t *l)
{
    const ale_rplidar_parser_t *p = &l->parser;
    if (p->answer_type == ALE_RPLIDAR_INFO && p->answer_bytes >= 20) {
        take_info(l, p->answer);
    } else if (p->answer_type == ALE_RPLIDAR_RATES && p->answer_bytes >= 4) {
        take_rates(l, p->answer);
    } else if (p->answer_type == ALE_RPLIDAR_CONF && p->answer_bytes >= 8 &&
               ale_get_u32(p->answer) == CONF_SAMPLE_US) {
        take_sample(l, p->answer);
    }
}

/* What a stream is, its descriptor says; STOP ends it. */
static bool overhear(void *state, const uint8_t *sent, uint32_t count)
{
    ale_rplidar_t *l = state;
    if (count == 0) {
        overhear_answer(l);
        return false;
    }
    const bool ends = count >= 2 && sent[0] == SYNC && (sent[1] == STOP || sent[1] == RESET);
    if (ends) {
        ale_rplidar_parser_begin(&l->parser);
    }
    return ends;
}

static uint32_t parse(void *state, const uint8_t *bytes, uint32_t count, ale_rotary_packet_t *packet)
{
    return ale_rplidar_parse(&((ale_rplidar_t *)state)->parser, bytes, count, packet);
}

/* An A1's motor stops with DTR, the others' with the scan. */
static ale_rotary_request_t stop(void *state)
{
    (void)state;
    ale_rotary_request_t out = request(STOP, QUIET_MS);
    out.dtr = ALE_DTR_ON;
    return out;
}

typedef struct {
    const char *name;
    int32_t series;
    int32_t range_min_um;
    int32_t range_max_um;
    int32_t baud;
} model_t;

/* SLAMTEC's data sheets. */
static const model_t MODELS[] = {
    {"A1", 1, 150000, 12000000, 115200}, {"A2", 2, 150000, 16000000, 115200},
    {"A3", 3, 150000, 25000000, 256000}, {"C1", 4, 50000, 12000000, 460800},
    {"S1", 6, 100000, 40000000, 256000}, {"S2", 7, 50000, 30000000, 1000000},
    {"S3", 8, 50000, 40000000, 1000000},
};

static const model_t *model_of(const ale_rplidar_t *l)
{
    for (unsigned k = 0; k < sizeof MODELS / sizeof MODELS[0]; k++) {
        if (MODELS[k].series == series(l)) {
            return &MODELS[k];
        }
    }
    return &MODELS[0];
}

static void facts(const void *state, ale_rotary_facts_t *f)
{
    const ale_rplidar_t *l = state;
    const model_t *model = model_of(l);
    f->range_min_um = model->range_min_um;
    f->range_max_um = model->range_max_um;
    f->baud = model->baud;
    f->hardware_faults = l->faults;
    f->words[0] = '\0';
    if (!l->known) {
        return;
    }
    snprintf(f->identity.model, sizeof f->identity.model, "RPLIDAR %sM%d", model->name, l->model & 0xf);
    snprintf(f->identity.firmware, sizeof f->identity.firmware, "%d.%02d", l->firmware >> 8,
             l->firmware & 0xff);
    for (unsigned k = 0; k < sizeof l->serial && 2 * k + 2 < sizeof f->identity.serial; k++) {
        snprintf(f->identity.serial + (size_t)2 * k, 3, "%02X", l->serial[k]);
    }
    if (l->health != 0) {
        snprintf(f->words, sizeof f->words, "it says of itself: %s, code %d",
                 l->health == ALE_RPLIDAR_ERROR ? "a fault of its hardware" : "a warning", l->error);
    }
}

const ale_rotary_protocol_t ale_rplidar_protocol = {.name = "rplidar",
                                                    .bauds = {115200, 460800, 256000, 1000000},
                                                    .clockwise = true,
                                                    .state_bytes = sizeof(ale_rplidar_t),
                                                    .begin = begin,
                                                    .parse = parse,
                                                    .next = next,
                                                    .stop = stop,
                                                    .facts = facts,
                                                    .overhear = overhear};

static bool has_baud(int32_t baud)
{
    for (unsigned k = 0; k < ALE_ROTARY_BAUDS; k++) {
        if (ale_rplidar_protocol.bauds[k] == baud) {
            return true;
        }
    }
    return false;
}

static ale_scanner_t *open_scanner(const ale_scanner_config_t *config)
{
    return ale_rotary_open(&ale_scanner_rplidar, &ale_rplidar_protocol, config);
}

const ale_scanner_family_t ale_scanner_rplidar = {.name = "rplidar",
                                                  .tries = ALE_ROTARY_BAUDS,
                                                  .has_baud = has_baud,
                                                  .open = open_scanner,
                                                  .step = ale_rotary_step,
                                                  .health = ale_rotary_health,
                                                  .close = ale_rotary_close};
