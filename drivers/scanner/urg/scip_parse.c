#include "scanner/urg/scip_parse.h"

#include <string.h>

#include "scanner/urg/scip_code.h"

enum {
    LF = '\n',
    DATA_CHARACTERS = 64,
    STAMP_CHARACTERS = 4,
    CODE_BITS = 6,
    MOST_VALUE = (1 << 18) - 1, /* in three characters */
    ECHOED_BAUD = 14            /* "S" bbbbbb rrrrrrr of SCIP 1.1 */
};

enum { IDLE, CANDIDATE, BODY };

static void drop_candidate(ale_scip_parser_t *p)
{
    p->counters.garbage_bytes += p->candidate.bytes;
    p->candidate.count = 0;
    p->candidate.bytes = 0;
}

/* Keeps the line as a possible echo if it can be one. */
static bool keep_candidate(ale_scip_parser_t *p)
{
    ale_scip_request_t request = {0};
    const int32_t found = ale_scip_line_request(&p->line, &request);
    const uint32_t start = found < 0 ? 0 : (uint32_t)found;
    const uint32_t count = p->line.count - start;
    if (count == 0 || count >= ALE_SCIP_ECHO || (found < 0 && !ale_scip_line_clean(&p->line))) {
        return false;
    }
    for (uint32_t k = 0, at = start; k < count && at < p->line.count; k++, at++) {
        p->candidate.text[k] = (char)p->line.bytes[at];
    }
    p->candidate.text[count] = '\0';
    p->candidate.count = count;
    p->candidate.bytes = count + 1;
    p->candidate.has_request = found >= 0;
    p->candidate.request = request;
    /* Behind garbage the echo's own first byte is not known: the line end is late rather than early. */
    p->candidate.us = start == 0 && p->line.dropped == 0 ? p->line.first_us : p->now_us;
    return true;
}

static void damage(ale_scip_parser_t *p, ale_scip_loss_t loss)
{
    if (p->reply.loss == ALE_SCIP_INTACT) {
        p->reply.loss = loss;
    }
}

/* Ranges follow this echo and status. */
static bool data_follows(const ale_scip_event_t *reply)
{
    if (!reply->has_request || reply->request.protocol != reply->protocol) {
        return false;
    }
    if (reply->protocol == 1) {
        return strcmp(reply->status, "0") == 0;
    }
    return strcmp(reply->status, reply->request.stream ? "99" : "00") == 0;
}

/* The candidate was an echo: a reply of this protocol and status begins. */
static void begin_reply(ale_scip_parser_t *p, uint8_t protocol, const uint8_t *status, uint32_t status_count)
{
    ale_scip_event_t *reply = &p->reply;
    memset(reply, 0, sizeof *reply);
    reply->protocol = protocol;
    memcpy(reply->echo, p->candidate.text, p->candidate.count + 1);
    memcpy(reply->status, status, status_count);
    reply->has_request = p->candidate.has_request;
    reply->request = p->candidate.request;
    reply->first_us = p->candidate.us;
    p->candidate.count = 0;
    p->candidate.bytes = 0;
    p->state = BODY;
    p->body_lines = 0;
    p->ended = false;
    p->partial = 0;
    p->partial_count = 0;
    const bool stream_frame = strcmp(reply->status, "99") == 0;
    p->has_data = data_follows(reply) || stream_frame;
    p->stamp_due = p->has_data && protocol == 2;
    p->expected = reply->has_request ? ale_scip_request_values(&reply->request) : 0;
    if (stream_frame && !data_follows(reply)) {
        damage(p, ALE_SCIP_BAD_SHAPE);
    } else if (p->has_data && (p->expected == 0 || p->expected > ALE_MAX_BEAMS)) {
        damage(p, ALE_SCIP_BAD_COUNT);
    }
}

/* Hands out the reply as it stands. */
static bool end_reply(ale_scip_parser_t *p, ale_scip_event_t *event)
{
    ale_scip_event_t *reply = &p->reply;
    p->state = IDLE;
    reply->last_us = p->now_us;
    /* With an unreadable status and then the end, it was no scan. */
    const bool refusal = reply->status[0] == '\0' && p->body_lines < 2 && reply->loss != ALE_SCIP_CUT;
    if (p->has_data && !refusal) {
        if (p->stamp_due || p->partial_count > 0 || reply->value_count != p->expected) {
            damage(p, ALE_SCIP_BAD_COUNT);
        }
        reply->kind = reply->loss == ALE_SCIP_INTACT ? ALE_SCIP_SCAN : ALE_SCIP_LOST;
    } else {
        reply->kind = ALE_SCIP_REPLY;
    }
    reply->values = reply->kind == ALE_SCIP_SCAN ? p->values : NULL;
    reply->value_count = reply->kind == ALE_SCIP_SCAN ? reply->value_count : 0;
    p->counters.replies += reply->kind == ALE_SCIP_REPLY;
    p->counters.scans += reply->kind == ALE_SCIP_SCAN;
    p->counters.lost[reply->loss] += reply->kind == ALE_SCIP_LOST;
    *event = *reply;
    return true;
}

static ale_scip_loss_t read_stamp(ale_scip_parser_t *p)
{
    if (p->line.dropped > 0 || p->line.count != STAMP_CHARACTERS + 1) {
        return ALE_SCIP_BAD_SHAPE;
    }
    if (!ale_scip_line_sum_right(&p->line)) {
        return ALE_SCIP_BAD_SUM;
    }
    const int32_t stamp_ms = ale_scip_decode(p->line.bytes, STAMP_CHARACTERS);
    if (stamp_ms < 0) {
        return ALE_SCIP_BAD_SHAPE;
    }
    p->reply.stamp_ms = (uint32_t)stamp_ms;
    p->reply.stamp_known = true;
    return ALE_SCIP_INTACT;
}

static ale_scip_loss_t read_data_character(ale_scip_parser_t *p, const uint8_t *c)
{
    ale_scip_event_t *reply = &p->reply;
    const int32_t bits = ale_scip_decode(c, 1);
    if (bits < 0) {
        return ALE_SCIP_BAD_SHAPE;
    }
    if (reply->value_count >= p->expected || reply->value_count >= ALE_MAX_BEAMS) {
        return ALE_SCIP_BAD_COUNT;
    }
    p->partial = (p->partial << CODE_BITS | bits) & MOST_VALUE;
    if (++p->partial_count == reply->request.characters) {
        p->values[reply->value_count++] = p->partial;
        p->partial = 0;
        p->partial_count = 0;
    }
    return ALE_SCIP_INTACT;
}

/* Whole, of a possible length, and not behind the last line of its reply. */
static bool can_be_data(const ale_scip_parser_t *p, uint32_t sum_characters)
{
    return p->line.dropped == 0 && !p->ended && p->line.count > sum_characters &&
           p->line.count <= DATA_CHARACTERS + sum_characters;
}

static ale_scip_loss_t read_data(ale_scip_parser_t *p)
{
    const uint32_t sum_characters = p->reply.protocol == 2 ? 1 : 0;
    if (!can_be_data(p, sum_characters)) {
        return ALE_SCIP_BAD_SHAPE;
    }
    if (sum_characters > 0 && !ale_scip_line_sum_right(&p->line)) {
        return ALE_SCIP_BAD_SUM;
    }
    const uint32_t count = p->line.count - sum_characters;
    p->ended = count < DATA_CHARACTERS;
    ale_scip_loss_t loss = ALE_SCIP_INTACT;
    for (uint32_t k = 0; k < count && loss == ALE_SCIP_INTACT; k++) {
        loss = read_data_character(p, p->line.bytes + k);
    }
    /* Only the last line may be short. */
    const bool short_of_values = p->ended && p->reply.value_count != p->expected;
    return loss == ALE_SCIP_INTACT && short_of_values ? ALE_SCIP_BAD_COUNT : loss;
}

/* Takes ";" and sum off an information line and judges the sum; the text stays in line[]. */
static bool read_info(ale_scip_parser_t *p, ale_scip_event_t *event)
{
    if (!ale_scip_line_clean(&p->line)) {
        p->counters.wrong_info_sums++;
        return false;
    }
    uint32_t count = p->line.count;
    bool right = true;
    if (p->reply.protocol == 2) {
        const bool closed = count >= 2 && p->line.bytes[count - 2] == ';';
        right =
            count >= 2 && ale_scip_sum(p->line.bytes, count - (closed ? 2 : 1)) == p->line.bytes[count - 1];
        count -= closed ? 2 : (right ? 1 : 0);
    } else if (p->line.bytes[count - 1] == ';') {
        count--;
    }
    p->counters.wrong_info_sums += !right;
    p->line.bytes[count] = '\0';
    *event = p->reply;
    event->kind = ALE_SCIP_LINE_READ;
    event->text = (const char *)p->line.bytes;
    event->text_count = count;
    event->sum_right = right;
    event->last_us = p->now_us;
    return true;
}

/* The line before looked like an echo and this one is a status: the reply that was read is cut short and
 * another has begun. */
static bool begin_next(ale_scip_parser_t *p, uint8_t protocol, ale_scip_event_t *event)
{
    bool emitted = false;
    if (p->has_data) {
        p->reply.loss = ALE_SCIP_CUT;
        emitted = end_reply(p, event);
    }
    begin_reply(p, protocol, p->line.bytes, protocol);
    return emitted;
}

/* A line of stamp or values. */
static void read_measurement(ale_scip_parser_t *p, bool echo_at_end)
{
    ale_scip_loss_t loss = p->reply.loss;
    if (p->stamp_due) {
        loss = read_stamp(p);
        p->stamp_due = false;
    } else if (loss == ALE_SCIP_INTACT) {
        loss = read_data(p);
    }
    if (loss != ALE_SCIP_INTACT) {
        damage(p, loss);
    }
    /* The cut piece of a line and an echo behind it may by chance have a right sum. */
    if (loss != ALE_SCIP_INTACT || echo_at_end) {
        keep_candidate(p);
    }
}

static bool read_body_line(ale_scip_parser_t *p, ale_scip_event_t *event)
{
    const uint8_t protocol = ale_scip_line_status(&p->line);
    if (p->candidate.count > 0 && protocol > 0) {
        return begin_next(p, protocol, event);
    }
    p->candidate.count = 0;
    p->candidate.bytes = 0;
    if (ale_scip_line_empty(&p->line)) {
        return end_reply(p, event);
    }
    if (++p->body_lines > ALE_SCIP_BODY_LINES) {
        damage(p, ALE_SCIP_BAD_SHAPE);
        return end_reply(p, event);
    }
    ale_scip_request_t request;
    const bool echo_at_end = ale_scip_line_request(&p->line, &request) >= 0;
    if (p->has_data) {
        read_measurement(p, echo_at_end);
        return false;
    }
    if (echo_at_end) {
        keep_candidate(p);
        return false;
    }
    return read_info(p, event);
}

/* An echo of a range request without a readable status: this line stands where it should be. */
static bool begin_damaged_reply(ale_scip_parser_t *p, ale_scip_event_t *event)
{
    begin_reply(p, p->candidate.request.protocol, (const uint8_t *)"", 0);
    p->has_data = true;
    damage(p, ALE_SCIP_BAD_SHAPE);
    const bool emitted = read_body_line(p, event);
    p->stamp_due = !emitted && p->reply.protocol == 2;
    return emitted;
}

/* Real devices answer S of SCIP 1.1 as any command; its document puts the status right behind the echo. */
static bool baud_reply(ale_scip_parser_t *p)
{
    if (p->line.count != ECHOED_BAUD + 1 || p->line.dropped > 0 || p->line.bytes[0] != 'S' ||
        p->line.bytes[ECHOED_BAUD] <= ' ') {
        return false;
    }
    for (uint32_t k = 1; k < ECHOED_BAUD; k++) {
        if (p->line.bytes[k] < '0' || p->line.bytes[k] > '9') {
            return false;
        }
    }
    p->candidate.text[ECHOED_BAUD] = '\0';
    p->candidate.count = ECHOED_BAUD;
    begin_reply(p, 1, p->line.bytes + ECHOED_BAUD, 1);
    return true;
}

/* Outside a reply: the line is an echo to be, or garbage. */
static void read_first_line(ale_scip_parser_t *p)
{
    const uint32_t bytes = p->line.count + p->line.dropped + 1;
    if (!keep_candidate(p)) {
        p->counters.garbage_bytes += bytes;
        p->state = IDLE;
        return;
    }
    p->counters.garbage_bytes += bytes - p->candidate.bytes;
    p->state = CANDIDATE;
    baud_reply(p);
}

static bool read_second_line(ale_scip_parser_t *p, ale_scip_event_t *event)
{
    const uint8_t protocol = ale_scip_line_status(&p->line);
    if (protocol > 0) {
        begin_reply(p, protocol, p->line.bytes, protocol);
        return false;
    }
    if (p->candidate.has_request) {
        return begin_damaged_reply(p, event);
    }
    drop_candidate(p);
    read_first_line(p);
    return false;
}

static bool read_line(ale_scip_parser_t *p, ale_scip_event_t *event)
{
    switch (p->state) {
    case IDLE:
        read_first_line(p);
        return false;
    case CANDIDATE:
        return read_second_line(p, event);
    default:
        return read_body_line(p, event);
    }
}

size_t ale_scip_parse(ale_scip_parser_t *parser, const uint8_t *bytes, size_t count, int64_t arrival_us,
                      ale_scip_event_t *event)
{
    memset(event, 0, sizeof *event);
    parser->now_us = arrival_us;
    for (size_t k = 0; k < count; k++) {
        parser->counters.bytes++;
        if (bytes[k] != LF) {
            ale_scip_line_append(&parser->line, bytes[k], arrival_us);
            continue;
        }
        const bool emitted = read_line(parser, event);
        ale_scip_line_clear(&parser->line);
        if (emitted) {
            return k + 1;
        }
    }
    return count;
}

void ale_scip_parser_init(ale_scip_parser_t *parser)
{
    memset(parser, 0, sizeof *parser);
}

void ale_scip_parser_reset(ale_scip_parser_t *parser)
{
    const ale_scip_counters_t counters = parser->counters;
    memset(parser, 0, sizeof *parser);
    parser->counters = counters;
}

const ale_scip_counters_t *ale_scip_counters(const ale_scip_parser_t *parser)
{
    return &parser->counters;
}
