/* Lines of scanners of a whole turn: packets by the protocol, turns by the driver's own stream. */
#include <string.h>

#include "log/line_reader.h"

static void restart(ale_rotary_line_t *rotary, const ale_rotary_protocol_t *protocol)
{
    protocol->begin(&rotary->state);
    ale_rotary_stream_begin(&rotary->stream);
    rotary->heard = false;
}

static void begin(ale_line_state_t *line, const ale_rotary_protocol_t *protocol)
{
    ale_rotary_stream_init(&line->rotary.stream, protocol->clockwise, false);
    restart(&line->rotary, protocol);
}

static void send(ale_line_state_t *line, const ale_rotary_protocol_t *protocol, const uint8_t *bytes,
                 uint32_t count)
{
    ale_rotary_line_t *rotary = &line->rotary;
    if (protocol->overhear != NULL && protocol->overhear(&rotary->state, bytes, count)) {
        ale_rotary_stream_begin(&rotary->stream);
        rotary->heard = false;
    }
}

static void learn(ale_rotary_line_t *rotary, const ale_rotary_protocol_t *protocol)
{
    protocol->facts(&rotary->state, &rotary->facts);
    ale_turns_range(&rotary->stream.turns, rotary->facts.range_min_um, rotary->facts.range_max_um);
}

static void take_packet(ale_rotary_line_t *rotary, const ale_rotary_protocol_t *protocol, int64_t arrival_us)
{
    const int32_t usual = rotary->facts.baud;
    switch (rotary->packet.kind) {
    case ALE_PACKET_POINTS:
        learn(rotary, protocol);
        ale_rotary_stream_take(&rotary->stream, &rotary->packet, arrival_us,
                               usual > 0 ? usual : protocol->bauds[0]);
        break;
    case ALE_PACKET_ANSWER:
        protocol->overhear(&rotary->state, NULL, 0);
        learn(rotary, protocol);
        break;
    case ALE_PACKET_DAMAGED:
    case ALE_PACKET_NONE:
        break;
    }
}

/* After such a silence the driver of a scanner that sends unasked begins anew; of others it is seen in what
 * is sent. */
static void follow_silence(ale_rotary_line_t *rotary, const ale_rotary_protocol_t *protocol,
                           int64_t arrival_us)
{
    const int64_t silent_ms = (arrival_us - rotary->arrival_us) / 1000;
    if (protocol->next == NULL && rotary->heard &&
        silent_ms > ale_rotary_stream_silence_ms(&rotary->stream)) {
        restart(rotary, protocol);
    }
    rotary->heard = true;
    rotary->arrival_us = arrival_us;
}

static size_t receive(ale_line_state_t *line, const ale_rotary_protocol_t *protocol, const uint8_t *bytes,
                      size_t count, int64_t arrival_us)
{
    ale_rotary_line_t *rotary = &line->rotary;
    follow_silence(rotary, protocol, arrival_us);
    const uint32_t used = protocol->parse(
        &rotary->state, bytes, (uint32_t)(count < UINT32_MAX ? count : UINT32_MAX), &rotary->packet);
    take_packet(rotary, protocol, arrival_us);
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
