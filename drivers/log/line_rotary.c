/* Lines of scanners of a whole turn: packets by the protocol, turns by the driver's own stream. */
#include <string.h>

#include "log/line_reader.h"

static void restart(ale_rotary_line_t *rotary)
{
    rotary->protocol->begin(&rotary->state);
    ale_rotary_stream_begin(&rotary->stream);
    rotary->heard = false;
}

static void begin(ale_line_state_t *line, const ale_rotary_protocol_t *protocol)
{
    line->rotary.protocol = protocol;
    ale_rotary_stream_init(&line->rotary.stream, protocol->clockwise, false);
    restart(&line->rotary);
}

static void send(ale_line_state_t *line, const uint8_t *bytes, uint32_t count)
{
    ale_rotary_line_t *rotary = &line->rotary;
    if (rotary->protocol->overhear != NULL && rotary->protocol->overhear(&rotary->state, bytes, count)) {
        ale_rotary_stream_begin(&rotary->stream);
        rotary->heard = false;
    }
}

static void learn(ale_rotary_line_t *rotary)
{
    rotary->protocol->facts(&rotary->state, &rotary->facts);
    ale_turns_range(&rotary->stream.turns, rotary->facts.range_min_um, rotary->facts.range_max_um);
}

static void take_packet(ale_rotary_line_t *rotary, int64_t arrival_us)
{
    const int32_t usual = rotary->facts.baud;
    switch (rotary->packet.kind) {
    case ALE_PACKET_POINTS:
        learn(rotary);
        ale_rotary_stream_take(&rotary->stream, &rotary->packet, arrival_us,
                               usual > 0 ? usual : rotary->protocol->bauds[0]);
        break;
    case ALE_PACKET_ANSWER:
        rotary->protocol->overhear(&rotary->state, NULL, 0);
        learn(rotary);
        break;
    case ALE_PACKET_DAMAGED:
    case ALE_PACKET_NONE:
        break;
    }
}

/* After such a silence the driver of a scanner that sends unasked begins anew; of others it is seen in what
 * is sent. */
static void follow_silence(ale_rotary_line_t *rotary, int64_t arrival_us)
{
    const int64_t silent_ms = (arrival_us - rotary->arrival_us) / 1000;
    if (rotary->protocol->next == NULL && rotary->heard &&
        silent_ms > ale_rotary_stream_silence_ms(&rotary->stream)) {
        restart(rotary);
    }
    rotary->heard = true;
    rotary->arrival_us = arrival_us;
}

static size_t receive(ale_line_state_t *line, const uint8_t *bytes, size_t count, int64_t arrival_us)
{
    ale_rotary_line_t *rotary = &line->rotary;
    follow_silence(rotary, arrival_us);
    const uint32_t used = rotary->protocol->parse(
        &rotary->state, bytes, (uint32_t)(count < UINT32_MAX ? count : UINT32_MAX), &rotary->packet);
    take_packet(rotary, arrival_us);
    return used;
}

static ale_scanner_event_t next(ale_line_state_t *line, ale_scan_t *scan)
{
    return ale_turns_next(&line->rotary.stream.turns, scan);
}

static const char *model(const ale_line_state_t *line)
{
    return line->rotary.facts.identity.model;
}

const ale_line_reader_t ale_line_ldrobot = {.family = "ldrobot",
                                            .protocol = &ale_ldrobot_protocol,
                                            .begin = begin,
                                            .send = send,
                                            .receive = receive,
                                            .next = next,
                                            .model = model};

const ale_line_reader_t ale_line_rplidar = {.family = "rplidar",
                                            .protocol = &ale_rplidar_protocol,
                                            .begin = begin,
                                            .send = send,
                                            .receive = receive,
                                            .next = next,
                                            .model = model};
