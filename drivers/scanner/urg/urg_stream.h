/* From replies to scans: judges every frame of a stream, gives it host time, and accounts for what is
 * missing, so that each scan that the device sent comes out once: as a scan or as a loss. Pure: the
 * driver feeds it from the port, a reader of recordings from a file.
 *
 *   ale_urg_stream_init(&stream, reversed);
 *   ale_urg_stream_describe(&stream, &identity.geometry, &identity.played);
 *   ale_urg_stream_begin(&stream, &request);                     when the stream is (re)started
 *   ale_urg_stream_take(&stream, &event);                        for each SCAN or LOST of the parser
 *   while ((kind = ale_urg_stream_next(&stream, &scan)) != ALE_SCANNER_IDLE) ...
 */
#ifndef ALE_SCANNER_URG_URG_STREAM_H
#define ALE_SCANNER_URG_URG_STREAM_H

#include <stdbool.h>
#include <stdint.h>

#include "base/scan.h"
#include "scanner/scanner_types.h"
#include "scanner/urg/identity.h"
#include "scanner/urg/scip_parse.h"
#include "scanner/urg/sensor_clock.h"

/* What became of a frame. */
typedef enum {
    ALE_FRAME_SCAN,
    ALE_FRAME_LOST,     /* damaged: a loss, if a scanner can have sent so many */
    ALE_FRAME_REPEATED, /* its stamp was there before: no scan, no loss */
    ALE_FRAME_FOREIGN   /* answers a request other than the present one: a left-over, dropped */
} ale_frame_t;

typedef struct {
    bool reversed;
    ale_urg_geometry_t geometry;
    ale_urg_played_t played;
    ale_scip_request_t request;
    ale_sensor_clock_t clock;
    int32_t period_us; /* of one turn, measured */
    bool continuous;   /* the last scan belongs to the same stream: gaps can be counted */
    int32_t regular;   /* intervals in a row that were whole turns; far below 0 after one that was not */
    uint32_t losses;   /* reported since the last scan */
    int64_t last_stamp_us;
    uint32_t gaps_owed; /* losses seen by the gap before the scan that waits */
    int64_t gap_us;     /* time of the next one of them */
    int64_t turn_us;    /* between two scans of the stream */
    bool loss_waits;
    int64_t loss_stamp_us;
    bool scan_waits;
    ale_scan_t scan;
    uint64_t clock_jumps;
    int64_t losses_until_us;  /* up to here every turn has its loss */
    uint64_t losses_too_fast; /* damaged frames that are no scans: a scanner does not send so many */
} ale_urg_stream_t;

void ale_urg_stream_init(ale_urg_stream_t *stream, bool reversed);

/* Takes the sensor's numbers, which must be valid (ale_urg_geometry_valid), and what it says of a recording.
 * Of a played one every stamp is right as it is: neither its gaps nor its steps back say anything. */
void ale_urg_stream_describe(ale_urg_stream_t *stream, const ale_urg_geometry_t *geometry,
                             const ale_urg_played_t *played);

/* A stream with this request begins: gaps in the stamps before it are no losses. */
void ale_urg_stream_begin(ale_urg_stream_t *stream, const ale_scip_request_t *request);

/* Nobody knows whether the sensor goes on sending: the gap that follows is no loss. */
void ale_urg_stream_interrupt(ale_urg_stream_t *stream);

/* The sensor's counter was set to 0 (reset, power). */
void ale_urg_stream_forget_clock(ale_urg_stream_t *stream);

/* Takes a SCAN or LOST event. What it yields must be fetched before the next one. */
ale_frame_t ale_urg_stream_take(ale_urg_stream_t *stream, const ale_scip_event_t *event);

/* ALE_SCANNER_SCAN_LOST (scan->stamp_us only; 0 beams), ALE_SCANNER_SCAN, or ALE_SCANNER_IDLE when all is
 * fetched. */
ale_scanner_event_t ale_urg_stream_next(ale_urg_stream_t *stream, ale_scan_t *scan);

/* Time between two scans of the stream. */
int64_t ale_urg_stream_turn_us(const ale_urg_stream_t *stream);

#endif
