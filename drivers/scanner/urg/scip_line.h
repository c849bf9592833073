/* One line of what a SCIP device sends: collecting its bytes, and what it can be by itself. */
#ifndef ALE_SCANNER_URG_SCIP_LINE_H
#define ALE_SCANNER_URG_SCIP_LINE_H

#include <stdbool.h>
#include <stdint.h>

#include "scanner/urg/scip_request.h"

/* Longest line kept; data lines have 65 characters, information lines under 100. */
enum { ALE_SCIP_LINE = 160 };

typedef struct {
    uint8_t bytes[ALE_SCIP_LINE + 1];
    uint32_t count;
    uint32_t dropped; /* bytes that no longer fitted, before bytes[0] */
    int64_t first_us; /* arrival of the line's first byte */
} ale_scip_line_t;

/* Adds a byte; of a line without end the later part is kept, for its end may still be an echo. */
void ale_scip_line_append(ale_scip_line_t *line, uint8_t byte, int64_t arrival_us);
/* Begins the next line; bytes[] stays readable until then. */
void ale_scip_line_clear(ale_scip_line_t *line);

static inline bool ale_scip_line_empty(const ale_scip_line_t *line)
{
    return line->count == 0 && line->dropped == 0;
}

/* Whole, and nothing but printable ASCII. */
bool ale_scip_line_clean(const ale_scip_line_t *line);

/* The last byte is the sum of those before it, of which there are some. */
bool ale_scip_line_sum_right(const ale_scip_line_t *line);

/* Protocol (1 or 2) whose status line this is, or 0. The status has as many characters. */
uint8_t ale_scip_line_status(const ale_scip_line_t *line);

/* Where in bytes[] the echo of a range request starts that ends the line, with or without ";string", and
 * the request; or -1. At most 4 looks at the line's end. */
int32_t ale_scip_line_request(const ale_scip_line_t *line, ale_scip_request_t *out);

#endif
