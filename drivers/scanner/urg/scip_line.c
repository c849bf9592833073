#include "scanner/urg/scip_line.h"

#include <string.h>

#include "scanner/urg/scip_code.h"

enum { KEPT = ALE_SCIP_LINE / 2, STATUS_LINE = 3, MOST_ECHO_STRING = 16 };

void ale_scip_line_append(ale_scip_line_t *line, uint8_t byte, int64_t arrival_us)
{
    if (ale_scip_line_empty(line)) {
        line->first_us = arrival_us;
    }
    if (line->count == ALE_SCIP_LINE) {
        memmove(line->bytes, line->bytes + ALE_SCIP_LINE - KEPT, KEPT);
        line->count = KEPT;
        line->dropped += ALE_SCIP_LINE - KEPT;
    }
    line->bytes[line->count++] = byte;
}

void ale_scip_line_clear(ale_scip_line_t *line)
{
    line->count = 0;
    line->dropped = 0;
}

bool ale_scip_line_clean(const ale_scip_line_t *line)
{
    for (uint32_t k = 0; k < line->count; k++) {
        if (line->bytes[k] < 0x20 || line->bytes[k] > 0x7e) {
            return false;
        }
    }
    return line->dropped == 0;
}

bool ale_scip_line_sum_right(const ale_scip_line_t *line)
{
    return line->dropped == 0 && line->count >= 2 &&
           ale_scip_sum(line->bytes, line->count - 1) == line->bytes[line->count - 1];
}

static bool status_character(uint8_t c)
{
    return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z');
}

uint8_t ale_scip_line_status(const ale_scip_line_t *line)
{
    if (line->dropped > 0 || line->count == 0 || !status_character(line->bytes[0])) {
        return 0;
    }
    if (line->count == STATUS_LINE && status_character(line->bytes[1]) && ale_scip_line_sum_right(line)) {
        return 2;
    }
    return line->count == 1 ? 1 : 0;
}

/* Looks for a range request that ends before `end`; returns where it starts, or -1. */
static int32_t request_before(const ale_scip_line_t *line, uint32_t end, ale_scip_request_t *out)
{
    static const uint32_t lengths[] = {15, 12, 9};
    for (unsigned k = 0; k < sizeof lengths / sizeof lengths[0]; k++) {
        if (end >= lengths[k] && ale_scip_request_parse(line->bytes + end - lengths[k], lengths[k], out)) {
            return (int32_t)(end - lengths[k]);
        }
    }
    return -1;
}

int32_t ale_scip_line_request(const ale_scip_line_t *line, ale_scip_request_t *out)
{
    const int32_t plain = request_before(line, line->count, out);
    if (plain >= 0) {
        return plain;
    }
    const uint32_t most = line->count < MOST_ECHO_STRING + 1 ? line->count : MOST_ECHO_STRING + 1;
    for (uint32_t back = 1; back <= most; back++) {
        if (line->bytes[line->count - back] == ';') {
            return request_before(line, line->count - back, out);
        }
    }
    return -1;
}
