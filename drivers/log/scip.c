/* .scip recordings: the scans come out of the very bytes that came over the line, by the driver's own parser
 * and clock, so that a recording shows what the robot saw. Which family of scanner it was no chunk says: it
 * is the one whose reader makes a scan of the bytes. */
#include <stdio.h>
#include <string.h>

#include "log/format.h"
#include "log/line_reader.h"
#include "store/recording.h"

static const ale_line_reader_t *const READERS[] = {&ale_line_urg, &ale_line_ldrobot, &ale_line_rplidar};

enum { READER_COUNT = sizeof READERS / sizeof READERS[0], LONGEST_SCAN = 20000 };

typedef struct {
    const ale_line_reader_t *reader; /* NULL: not begun */
    ale_chunk_reader_t chunks;
    const uint8_t *at; /* of the RECEIVED chunk that is being read */
    const uint8_t *end;
    int64_t arrival_us;
    uint64_t received; /* bytes */
    ale_line_state_t line;
    char text[ALE_CHUNK_MAX_PAYLOAD + 1];
} scip_t;

static bool claims_file(const uint8_t *bytes, size_t count)
{
    return ale_recording_claims(bytes, count);
}

/* A scan or a loss that the reader has ready. */
static bool hand_out(scip_t *scip, ale_log_record_t *record)
{
    ale_log_event_t *event = &record->event;
    const ale_scanner_event_t kind = scip->reader->next(&scip->line, &event->scan);
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
        scip->at +=
            scip->reader->receive(&scip->line, scip->at, (size_t)(scip->end - scip->at), scip->arrival_us);
    }
    return true;
}

static bool is_in_time(const ale_chunk_t *chunk)
{
    return chunk->stamp_us >= -ALE_MAX_STAMP_US && chunk->stamp_us <= ALE_MAX_STAMP_US;
}

/* What passed on the line. True: *record is filled. */
static bool take_line(scip_t *scip, const ale_chunk_t *chunk, ale_log_record_t *record)
{
    if (chunk->kind == ALE_CHUNK_SENT) {
        scip->reader->send(&scip->line, chunk->payload, chunk->length);
        return false;
    }
    scip->received += chunk->length;
    scip->at = chunk->payload;
    scip->end = chunk->payload + chunk->length;
    scip->arrival_us = chunk->stamp_us;
    return take_received(scip, record);
}

static void start(ale_log_t *log, scip_t *scip, const ale_line_reader_t *reader)
{
    scip->reader = reader;
    scip->chunks = ale_chunk_reader(log->bytes.at, log->bytes.count);
    scip->at = scip->end = NULL;
    scip->received = 0;
    memset(&scip->line, 0, sizeof scip->line);
    reader->begin(&scip->line, reader->protocol);
}

static bool makes_a_scan(scip_t *scip, ale_log_record_t *record)
{
    ale_chunk_t chunk;
    while (ale_chunk_next(&scip->chunks, &chunk)) {
        const bool of_line = chunk.kind == ALE_CHUNK_RECEIVED || chunk.kind == ALE_CHUNK_SENT;
        if (of_line && is_in_time(&chunk) && take_line(scip, &chunk, record)) {
            return true;
        }
    }
    return false;
}

static void begin(ale_log_t *log, scip_t *scip, ale_log_record_t *record)
{
    const ale_line_reader_t *chosen = NULL;
    for (unsigned k = 0; k < READER_COUNT && !chosen; k++) {
        start(log, scip, READERS[k]);
        chosen = makes_a_scan(scip, record) ? READERS[k] : NULL;
    }
    if (!chosen && scip->received > LONGEST_SCAN) {
        log->no_scan = "no scan can be made of its bytes (one of an RPLIDAR must begin before its scan did)";
    }
    chosen = chosen ? chosen : READERS[0];
    start(log, scip, chosen);
    log->info.raw_device = true;
    log->info.urg_noise = chosen == &ale_line_urg;
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
    case ALE_CHUNK_SENT:
        return take_line(scip, chunk, record);
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
    if (!scip->reader) {
        begin(log, scip, record);
    }
    record->with_odometry = false;
    if (take_received(scip, record)) {
        return true;
    }
    snprintf(log->info.scanner, sizeof log->info.scanner, "%s", scip->reader->model(&scip->line));
    ale_chunk_t chunk;
    bool taken = false;
    while (!taken && next_chunk(log, &chunk)) {
        if (is_in_time(&chunk)) {
            taken = take_chunk(log, &chunk, record);
        } else {
            ale_log_time_beyond(log); /* the parser reckons with it */
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
