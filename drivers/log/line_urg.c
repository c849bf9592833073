/* Hokuyo's line, SCIP. What was sent tells which stream is running; a recording that begins in the middle of
 * one is followed from its first whole scan. */
#include <string.h>

#include "file/text.h"
#include "log/line_reader.h"

static void begin(ale_line_state_t *line, const ale_rotary_protocol_t *protocol)
{
    (void)protocol;
    ale_scip_parser_init(&line->urg.parser);
    ale_urg_identity_init(&line->urg.identity);
    ale_urg_stream_init(&line->urg.stream, false);
}

/* Follows the driver: a request for ranges begins a stream, the same single request again goes on with it,
 * and QT ends it, or asks a sensor that fell silent whether it is there. */
static void take_command(ale_urg_line_t *urg, ale_span_t command)
{
    ale_scip_request_t request;
    if (ale_text_is(command, "QT")) {
        ale_urg_stream_interrupt(&urg->stream);
    } else if (ale_scip_request_parse((const uint8_t *)command.at, (size_t)(command.end - command.at),
                                      &request) &&
               (request.stream || !ale_scip_request_same_ranges(&request, &urg->stream.request))) {
        ale_urg_stream_begin(&urg->stream, &request);
    }
}

static void send(ale_line_state_t *line, const uint8_t *bytes, uint32_t count)
{
    ale_text_t text = ale_text(bytes, count);
    ale_span_t row;
    ale_span_t command;
    while (ale_text_line(&text, &row)) {
        if (ale_text_word(&row, &command)) {
            take_command(&line->urg, command);
        }
    }
}

static void take_reply(ale_urg_line_t *urg, const ale_scip_event_t *event)
{
    if (event->protocol == 1 || strcmp(event->echo, "RS") == 0) {
        ale_urg_stream_forget_clock(&urg->stream);
    }
    if ((strcmp(event->echo, "PP") == 0 || strcmp(event->echo, "V") == 0) &&
        ale_urg_geometry_valid(&urg->identity.geometry)) {
        ale_urg_played_t played = urg->identity.played;
        played.zero_us = ALE_URG_PLAYED_ZERO_UNKNOWN;
        ale_urg_stream_describe(&urg->stream, &urg->identity.geometry, &played);
    }
}

static void take_event(ale_urg_line_t *urg, const ale_scip_event_t *event)
{
    switch (event->kind) {
    case ALE_SCIP_LINE_READ:
        ale_urg_identity_line(&urg->identity, event->text, event->sum_right);
        break;
    case ALE_SCIP_REPLY:
        take_reply(urg, event);
        break;
    case ALE_SCIP_SCAN:
    case ALE_SCIP_LOST:
        if (urg->stream.request.protocol == 0 && event->has_request) {
            ale_urg_stream_begin(&urg->stream, &event->request);
        }
        if (urg->stream.request.protocol != 0) {
            ale_urg_stream_take(&urg->stream, event);
        }
        break;
    case ALE_SCIP_NONE:
        break;
    }
}

static size_t receive(ale_line_state_t *line, const uint8_t *bytes, size_t count, int64_t arrival_us)
{
    ale_scip_event_t event;
    const size_t used = ale_scip_parse(&line->urg.parser, bytes, count, arrival_us, &event);
    take_event(&line->urg, &event);
    return used;
}

static ale_scanner_event_t next(ale_line_state_t *line, ale_scan_t *scan)
{
    return ale_urg_stream_next(&line->urg.stream, scan);
}

static const char *model(const ale_line_state_t *line)
{
    return line->urg.identity.device.model;
}

const ale_line_reader_t ale_line_urg = {
    .family = "urg", .begin = begin, .send = send, .receive = receive, .next = next, .model = model};
