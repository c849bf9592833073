#include "log/detect.h"

#include <string.h>

static const ale_log_format_t *const BINARY[] = {&ale_log_scip, &ale_log_lcm_events};
static const ale_log_format_t *const TEXT[] = {&ale_log_carmen, &ale_log_pairs, &ale_log_rover,
                                               &ale_log_scan_lines};
enum {
    BINARY_FORMATS = sizeof BINARY / sizeof BINARY[0],
    TEXT_FORMATS = sizeof TEXT / sizeof TEXT[0],
    LOOK_FOR_NUL = 4096
};

static const ale_log_format_t *detect_line(ale_log_t *log, ale_span_t line)
{
    for (uint32_t f = 0; f < TEXT_FORMATS; f++) {
        if (TEXT[f]->claims_line(line)) {
            if (TEXT[f]->choose) {
                TEXT[f]->choose(log, line);
            }
            return TEXT[f];
        }
    }
    return NULL;
}

const ale_log_format_t *ale_log_detect(ale_log_t *log, const char **reason)
{
    const ale_bytes_t *bytes = &log->bytes;
    if (bytes->count == 0) {
        *reason = "is empty";
        return NULL;
    }
    for (uint32_t f = 0; f < BINARY_FORMATS; f++) {
        if (BINARY[f]->claims_file(bytes->at, bytes->count)) {
            return BINARY[f];
        }
    }
    if (memchr(bytes->at, 0, bytes->count < LOOK_FOR_NUL ? bytes->count : LOOK_FOR_NUL)) {
        *reason = "holds binary data that is neither a .scip recording nor an LCM event log";
        return NULL;
    }
    ale_text_t text = ale_text(bytes->at, bytes->count);
    ale_span_t line;
    while (ale_text_line(&text, &line)) {
        const ale_log_format_t *format = detect_line(log, line);
        if (format) {
            return format;
        }
    }
    *reason = "has no line of a known format (CARMEN, rover, .scan lines, Odometry/Laser pairs)";
    return NULL;
}
