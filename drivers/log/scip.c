/* .scip recordings: the scans come out of the very bytes that came over the line, by the driver's own parser
 * and clock, so that a recording shows what the robot saw. What was sent tells which stream is running; a
 * recording that begins in the middle of one is followed from its first whole scan. */
#include <string.h>

#include "log/format.h"
#include "scanner/urg/identity.h"
#include "scanner/urg/urg_stream.h"
#include "store/recording.h"

typedef struct {
    bool begun;
    ale_chunk_reader_t chunks;
    const uint8_t *at; /* of the RECEIVED chunk that is being read */
    const uint8_t *end;
    int64_t arrival_us;
    ale_scip_parser_t parser;
    ale_urg_identity_t identity;
    ale_urg_stream_t stream;
    char text[ALE_CHUNK_MAX_PAYLOAD + 1];
} scip_t;

static bool claims_file(const uint8_t *bytes, size_t count)
{
    return ale_recording_claims(bytes, count);
}

static void begin(ale_log_t *log, scip_t *scip)
{
    scip->begun = true;
    scip->chunks = ale_chunk_reader(log->bytes.at, log->bytes.count);
    ale_scip_parser_init(&scip->parser);
    ale_urg_identity_init(&scip->identity);
    ale_urg_stream_init(&scip->stream, false);
    log->info.raw_device = true;
    log->info.urg_noise = true;
}

/* Follows the driver: a request for ranges begins a stream, the same single request again goes on with it,
 * and QT ends it, or asks a sensor that fell silent whether it is there. */
static void take_command(scip_t *scip, ale_span_t command)
{
    ale_scip_request_t request;
    if (ale_text_is(command, "QT")) {
        ale_urg_stream_interrupt(&scip->stream);
    } else if (ale_scip_request_parse((const uint8_t *)command.at, (size_t)(command.end - command.at),
                                      &request) &&
               (request.stream || !ale_scip_request_same_ranges(&request, &scip->stream.request))) {
        ale_urg_stream_begin(&scip->stream, &request);
    }
}

static void take_sent(scip_t *scip, const ale_chunk_t *chunk)
{
    ale_text_t text = ale_text(chunk->payload, chunk->length);
    ale_span_t line;
    ale_span_t command;
    while (ale_text_line(&text, &line)) {
        if (ale_text_word(&line, &command)) {
            take_command(scip, command);
        }
    }
}

static void take_reply(scip_t *scip, const ale_scip_event_t *event)
{
    if (event->protocol == 1 || strcmp(event->echo, "RS") == 0) {
        ale_urg_stream_forget_clock(&scip->stream);
    }
    if ((strcmp(event->echo, "PP") == 0 || strcmp(event->echo, "V") == 0) &&
        ale_urg_geometry_valid(&scip->identity.geometry)) {
        ale_urg_played_t played = scip->identity.played;
        played.zero_us = ALE_URG_PLAYED_ZERO_UNKNOWN;
        ale_urg_stream_describe(&scip->stream, &scip->identity.geometry, &played);
    }
}

static void take_reply_event(scip_t *scip, const ale_scip_event_t *event)
{
    switch (event->kind) {
    case ALE_SCIP_LINE_READ:
        ale_urg_identity_line(&scip->identity, event->text, event->sum_right);
        break;
    case ALE_SCIP_REPLY:
        take_reply(scip, event);
        break;
    case ALE_SCIP_SCAN:
    case ALE_SCIP_LOST:
        if (scip->stream.request.protocol == 0 && event->has_request) {
            ale_urg_stream_begin(&scip->stream, &event->request);
        }
        if (scip->stream.request.protocol != 0) {
            ale_urg_stream_take(&scip->stream, event);
        }
        break;
    case ALE_SCIP_NONE:
        break;
    }
}

/* A scan or a loss that the stream has ready. */
static bool hand_out(scip_t *scip, ale_log_record_t *record)
{
    ale_log_event_t *event = &record->event;
    const ale_scanner_event_t kind = ale_urg_stream_next(&scip->stream, &event->scan);
    if (kind != ALE_SCANNER_SCAN && kind != ALE_SCANNER_SCAN_LOST) {
        return false;
    }
    event->kind = kind == ALE_SCANNER_SCAN ? ALE_LOG_SCAN : ALE_LOG_SCAN_LOST;
    event->stamp_us = event->scan.stamp_us;
    return true;
}

/* Reads on in the bytes at hand until they yield something. */
static bool take_received(scip_t *scip, ale_log_record_t *record)
{
    while (!hand_out(scip, record)) {
        if (scip->at == scip->end) {
            return false;
        }
        ale_scip_event_t event;
        scip->at +=
            ale_scip_parse(&scip->parser, scip->at, (size_t)(scip->end - scip->at), scip->arrival_us, &event);
        take_reply_event(scip, &event);
    }
    return true;
}

static bool take_text(scip_t *scip, const ale_chunk_t *chunk, ale_log_kind_t kind, ale_log_event_t *event)
{
    memcpy(scip->text, chunk->payload, chunk->length);
    scip->text[chunk->length] = '\0';
    event->kind = kind;
    event->stamp_us = chunk->stamp_us;
    event->text = scip->text;
    return true;
}

static bool take_odometry(ale_log_t *log, const ale_chunk_t *chunk, ale_log_event_t *event)
{
    if (!ale_chunk_odometry(chunk, &event->odometry)) {
        ale_log_bad_chunk(log, "odometry of wrong length");
        return false;
    }
    event->kind = ALE_LOG_ODOMETRY;
    event->stamp_us = event->odometry.stamp_us;
    return true;
}

static bool take_chunk(ale_log_t *log, const ale_chunk_t *chunk, ale_log_record_t *record)
{
    scip_t *scip = log->state;
    switch (chunk->kind) {
    case ALE_CHUNK_RECEIVED:
        scip->at = chunk->payload;
        scip->end = chunk->payload + chunk->length;
        scip->arrival_us = chunk->stamp_us;
        return take_received(scip, record);
    case ALE_CHUNK_SENT:
        take_sent(scip, chunk);
        return false;
    case ALE_CHUNK_ODOMETRY:
        return take_odometry(log, chunk, &record->event);
    case ALE_CHUNK_COMMAND:
        return take_text(scip, chunk, ALE_LOG_COMMAND, &record->event);
    case ALE_CHUNK_CONFIG:
        return take_text(scip, chunk, ALE_LOG_CONFIG, &record->event);
    default:
        return false;
    }
}

/* The next intact chunk; damage before it is counted. */
static bool next_chunk(ale_log_t *log, ale_chunk_t *chunk)
{
    scip_t *scip = log->state;
    const uint64_t bad_before = scip->chunks.bad_chunks;
    const bool found = ale_chunk_next(&scip->chunks, chunk);
    log->text.at = (const char *)scip->chunks.at;
    if (scip->chunks.bad_chunks > bad_before) {
        ale_log_bad_chunk(log, "damaged or cut chunk");
    }
    return found;
}

static bool next(ale_log_t *log, ale_log_record_t *record)
{
    scip_t *scip = log->state;
    if (!scip->begun) {
        begin(log, scip);
    }
    record->with_odometry = false;
    if (take_received(scip, record)) {
        return true;
    }
    ale_chunk_t chunk;
    bool taken = false;
    while (!taken && next_chunk(log, &chunk)) {
        if (chunk.stamp_us < -ALE_MAX_STAMP_US || chunk.stamp_us > ALE_MAX_STAMP_US) {
            ale_log_time_beyond(log); /* the parser reckons with it */
        } else {
            taken = take_chunk(log, &chunk, record);
        }
    }
    return taken;
}

const ale_log_format_t ale_log_scip = {
    .name = ".scip recording",
    .claims_file = claims_file,
    .state_size = sizeof(scip_t),
    .stamped = true,
    .constant_odometry = true,
    .next = next,
};
