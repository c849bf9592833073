/* A request for ranges, in both protocols: the one command of SCIP whose parameters decide how the
 * reply is read. Pure functions, no state.
 *
 *   SCIP 2.0   GD GS  ssss eeee cc          last scan, 3 or 2 characters a value
 *              MD MS  ssss eeee cc i nn     stream: skip i, nn scans (00: until QT)
 *   SCIP 1.1   G      sss eee cc            last scan, 2 characters a value, no sums, no stamp */
#ifndef ALE_SCANNER_URG_SCIP_REQUEST_H
#define ALE_SCANNER_URG_SCIP_REQUEST_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Longest request as text, terminator NUL included: "MD0044072501000". */
enum { ALE_SCIP_REQUEST_TEXT = 16 };

typedef struct {
    uint16_t first_step; /* 0..9999 (1.1: 0..999), both inclusive */
    uint16_t last_step;
    uint8_t cluster;    /* 0..99; 0 equals 1 */
    uint8_t skip;       /* turns left out between two scans, 0..9; streams only */
    uint8_t scans;      /* number of scans, 0: until QT; in a stream frame: scans still to come */
    uint8_t characters; /* of a value: 2 or 3 */
    bool stream;        /* MD, MS */
    uint8_t protocol;   /* 1 or 2 */
} ale_scip_request_t;

/* Reads exactly `count` characters; a trailing ";text" is the caller's matter. False and *out untouched
 * when they are not a well-formed request (a last step before the first is well-formed, and wrong). */
bool ale_scip_request_parse(const uint8_t *text, size_t count, ale_scip_request_t *out);

/* Writes the command without line end, NUL-terminated. Returns its length. Fields out of their range
 * are cut to the digits there are. */
size_t ale_scip_request_format(const ale_scip_request_t *request, char out[ALE_SCIP_REQUEST_TEXT]);

/* Number of values in a reply: ceil((last - first + 1) / cluster); 0 when last lies before first. */
uint32_t ale_scip_request_values(const ale_scip_request_t *request);

/* Bytes of one frame on the line: echo, status, stamp, data with sums, end. */
uint32_t ale_scip_request_frame_bytes(const ale_scip_request_t *request);

/* Same window, cluster, coding and kind; skip and scans may differ (the latter counts down). */
bool ale_scip_request_same_ranges(const ale_scip_request_t *a, const ale_scip_request_t *b);

#endif
