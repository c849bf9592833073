#include "scanner/urg/scip_request.h"

#include <stdio.h>
#include <string.h>

enum {
    SYMBOL_2 = 2,
    LINE_DATA = 64,
    STAMP_LINE = 6,
    STATUS_2 = 4,
    STATUS_1 = 2,
    STREAM_LENGTH = 15,
    LAST_LENGTH = 12,
    LENGTH_1 = 9
};

/* Value of `count` decimal digits at *at, which moves on; -1 when one is none. */
static int32_t digits(const uint8_t **at, unsigned count)
{
    int32_t value = 0;
    for (unsigned k = 0; k < count; k++) {
        const uint8_t c = (*at)[k];
        if (value < 0 || c < '0' || c > '9') {
            value = -1;
        } else {
            value = value * 10 + (c - '0');
        }
    }
    *at += count;
    return value;
}

static bool parse_window(const uint8_t **at, unsigned step_digits, ale_scip_request_t *out)
{
    const int32_t first = digits(at, step_digits);
    const int32_t last = digits(at, step_digits);
    const int32_t cluster = digits(at, 2);
    if (first < 0 || last < 0 || cluster < 0) {
        return false;
    }
    out->first_step = (uint16_t)first;
    out->last_step = (uint16_t)last;
    out->cluster = (uint8_t)cluster;
    return true;
}

/* The command of SCIP 2.0: GD, GS, MD or MS. */
static bool parse_symbol(const uint8_t *text, ale_scip_request_t *out)
{
    if ((text[0] != 'M' && text[0] != 'G') || (text[1] != 'D' && text[1] != 'S')) {
        return false;
    }
    out->stream = text[0] == 'M';
    out->characters = text[1] == 'D' ? 3 : 2;
    return true;
}

/* What MD and MS have behind the window. */
static bool parse_repetition(const uint8_t **at, ale_scip_request_t *out)
{
    const int32_t skip = digits(at, 1);
    const int32_t scans = digits(at, 2);
    if (skip < 0 || scans < 0) {
        return false;
    }
    out->skip = (uint8_t)skip;
    out->scans = (uint8_t)scans;
    return true;
}

static bool parse_2(const uint8_t *text, size_t count, ale_scip_request_t *out)
{
    ale_scip_request_t request = {.protocol = 2};
    if (count < LAST_LENGTH || !parse_symbol(text, &request) ||
        count != (request.stream ? STREAM_LENGTH : LAST_LENGTH)) {
        return false;
    }
    const uint8_t *at = text + SYMBOL_2;
    if (!parse_window(&at, 4, &request) || (request.stream && !parse_repetition(&at, &request))) {
        return false;
    }
    *out = request;
    return true;
}

static bool parse_1(const uint8_t *text, size_t count, ale_scip_request_t *out)
{
    ale_scip_request_t request = {.protocol = 1, .characters = 2};
    const uint8_t *at = text + 1;
    if (count != LENGTH_1 || text[0] != 'G' || !parse_window(&at, 3, &request)) {
        return false;
    }
    *out = request;
    return true;
}

bool ale_scip_request_parse(const uint8_t *text, size_t count, ale_scip_request_t *out)
{
    return parse_2(text, count, out) || parse_1(text, count, out);
}

size_t ale_scip_request_format(const ale_scip_request_t *request, char out[ALE_SCIP_REQUEST_TEXT])
{
    const unsigned cluster = request->cluster % 100U;
    const char coding = request->characters == 3 ? 'D' : 'S';
    int length;
    if (request->protocol == 1) {
        length = snprintf(out, ALE_SCIP_REQUEST_TEXT, "G%03u%03u%02u", request->first_step % 1000U,
                          request->last_step % 1000U, cluster);
    } else if (request->stream) {
        length = snprintf(out, ALE_SCIP_REQUEST_TEXT, "M%c%04u%04u%02u%u%02u", coding,
                          request->first_step % 10000U, request->last_step % 10000U, cluster,
                          request->skip % 10U, request->scans % 100U);
    } else {
        length = snprintf(out, ALE_SCIP_REQUEST_TEXT, "G%c%04u%04u%02u", coding, request->first_step % 10000U,
                          request->last_step % 10000U, cluster);
    }
    return (size_t)length;
}

uint32_t ale_scip_request_values(const ale_scip_request_t *request)
{
    if (request->last_step < request->first_step) {
        return 0;
    }
    const uint32_t steps = (uint32_t)(request->last_step - request->first_step) + 1;
    const uint32_t cluster = request->cluster > 1 ? request->cluster : 1;
    return (steps + cluster - 1) / cluster;
}

uint32_t ale_scip_request_frame_bytes(const ale_scip_request_t *request)
{
    const uint32_t data = ale_scip_request_values(request) * request->characters;
    const uint32_t lines = (data + LINE_DATA - 1) / LINE_DATA;
    if (request->protocol == 1) {
        return LENGTH_1 + 1 + STATUS_1 + data + lines + 1;
    }
    const uint32_t echo = request->stream ? STREAM_LENGTH : LAST_LENGTH;
    return echo + 1 + STATUS_2 + STAMP_LINE + data + 2 * lines + 1;
}

bool ale_scip_request_same_ranges(const ale_scip_request_t *a, const ale_scip_request_t *b)
{
    return a->first_step == b->first_step && a->last_step == b->last_step && a->cluster == b->cluster &&
           a->characters == b->characters && a->stream == b->stream && a->protocol == b->protocol;
}
