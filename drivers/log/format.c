#include "log/format.h"

#include <stdio.h>

bool ale_log_next_line(ale_log_t *log, ale_log_record_t *record,
                       bool (*take_line)(ale_log_t *log, ale_span_t line, ale_log_record_t *record))
{
    ale_span_t line;
    while (ale_text_line(&log->text, &line)) {
        if (take_line(log, line, record)) {
            return true;
        }
    }
    return false;
}

void ale_log_bad_line(ale_log_t *log, const char *what)
{
    snprintf(log->last_error, sizeof log->last_error, "%s: line %llu: %s", log->path,
             (unsigned long long)log->text.line, what);
    log->statistics.bad_lines++;
}

void ale_log_cut_line(ale_log_t *log, uint32_t count, uint32_t wanted, const char *of_what)
{
    char what[64];
    snprintf(what, sizeof what, "%u %s instead of %u", count, of_what, wanted);
    ale_log_bad_line(log, what);
}

void ale_log_pose_beyond(ale_log_t *log)
{
    snprintf(log->last_error, sizeof log->last_error,
             "%s: line %llu: odometry that no pose holds (farther than 2147 m, or no number)", log->path,
             (unsigned long long)log->text.line);
    log->statistics.poses_beyond++;
}

void ale_log_time_beyond(ale_log_t *log)
{
    const uint64_t offset = (uint64_t)((const uint8_t *)log->text.at - log->bytes.at);
    snprintf(log->last_error, sizeof log->last_error,
             "%s: before byte %llu: a stamp or a sweep that no clock and no scanner has", log->path,
             (unsigned long long)offset);
    log->statistics.times_beyond++;
}

void ale_log_bad_chunk(ale_log_t *log, const char *what)
{
    const uint64_t offset = (uint64_t)((const uint8_t *)log->text.at - log->bytes.at);
    snprintf(log->last_error, sizeof log->last_error, "%s: before byte %llu: %s", log->path,
             (unsigned long long)offset, what);
    log->statistics.bad_chunks++;
}

void ale_log_too_many_beams(ale_log_t *log, int64_t beams)
{
    snprintf(log->last_error, sizeof log->last_error, "%s: scan of %lld beams; at most %d are possible",
             log->path, (long long)beams, ALE_MAX_BEAMS);
    log->statistics.too_many_beams++;
}
