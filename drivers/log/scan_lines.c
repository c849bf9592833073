/* .scan lines: time in seconds and 726 ranges in mm a line, steps 0 to 725 of a URG-04LX, no odometry.
 * The stamp is the device's own, that of step 0. */
#include "base/fixed.h"
#include "log/format.h"
#include "log/geometry.h"

enum { BEAMS = 726, WORDS = BEAMS + 1 };

static bool claims_line(ale_span_t line)
{
    ale_span_t word;
    int64_t stamp_us = 0;
    return ale_text_count_words(line, WORDS + 1) == WORDS && ale_text_word(&line, &word) &&
           ale_text_decimal(word, 6, &stamp_us);
}

static void choose(ale_log_t *log, ale_span_t line)
{
    (void)line;
    log->info.urg_noise = true;
}

static bool take_scan(ale_span_t line, ale_log_event_t *event)
{
    ale_span_t word;
    if (!ale_text_word(&line, &word) || !ale_text_decimal(word, 6, &event->stamp_us)) {
        return false;
    }
    event->kind = ALE_LOG_SCAN;
    ale_geometry_urg(&event->scan, 0, BEAMS);
    event->scan.stamp_us = event->stamp_us;
    event->scan.stamp_beam = 0;
    for (uint16_t k = 0; k < event->scan.beams; k++) {
        int32_t value_mm = 0;
        if (!ale_text_word(&line, &word) || !ale_text_decimal32(word, 0, &value_mm)) {
            return false;
        }
        ale_scan_set_urg(&event->scan, k, (int32_t)ale_clamp64(value_mm, 0, UINT16_MAX));
    }
    return true;
}

static bool take_line(ale_log_t *log, ale_span_t line, ale_log_record_t *record)
{
    const uint32_t words = ale_text_count_words(line, WORDS + 1);
    if (words == WORDS && take_scan(line, &record->event)) {
        record->with_odometry = false;
        return true;
    }
    if (words > 0) {
        ale_log_bad_line(log, words == WORDS ? "a word that is not a number" : "not a time and 726 ranges");
    }
    return false;
}

static bool next(ale_log_t *log, ale_log_record_t *record)
{
    return ale_log_next_line(log, record, take_line);
}

const ale_log_format_t ale_log_scan_lines = {
    .name = ".scan lines",
    .claims_line = claims_line,
    .choose = choose,
    .state_size = 1,
    .stamped = true,
    .next = next,
};
