#include "log/log.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "log/detect.h"
#include "log/format.h"

/* Without stamps of use a scan is taken to come ten times a second. */
enum { DEFAULT_PERIOD_US = 100000 };

static int fail(ale_log_error_t *error, const char *path, const char *reason)
{
    snprintf(error->message, sizeof error->message, "%s: %s", path, reason);
    return -1;
}

static void rewind_log(ale_log_t *log)
{
    memset(log->state, 0, log->format->state_size);
    log->text = ale_text(log->bytes.at, log->bytes.count);
    log->statistics =
        (ale_log_statistics_t){.bytes_total = log->bytes.count, .cut_short = log->bytes.cut_short};
    log->last_error[0] = '\0';
    log->scan_waiting = false;
}

/* Odometry from one place of a log: the lines of the scans, or records of its own. */
typedef struct {
    uint64_t count;
    bool changes;
    ale_pose_t first;
} odometry_survey_t;

typedef struct {
    uint64_t forward;  /* steps of the stamps ahead */
    uint64_t standing; /* and all others */
    int64_t last_stamp_us;
    odometry_survey_t of_scans;
    odometry_survey_t of_records;
} survey_t;

static bool poses_differ(const ale_pose_t *a, const ale_pose_t *b)
{
    return a->x_um != b->x_um || a->y_um != b->y_um || a->theta_bam != b->theta_bam;
}

static void survey_odometry(odometry_survey_t *survey, const ale_pose_t *pose)
{
    if (survey->count++ == 0) {
        survey->first = *pose;
    }
    survey->changes |= poses_differ(pose, &survey->first);
}

static void survey_record(survey_t *survey, const ale_log_record_t *record, bool first_scan)
{
    const ale_log_event_t *event = &record->event;
    if (event->kind == ALE_LOG_SCAN) {
        const bool ahead = event->stamp_us > survey->last_stamp_us;
        survey->forward += !first_scan && ahead;
        survey->standing += !first_scan && !ahead;
        survey->last_stamp_us = event->stamp_us;
    }
    if (event->kind == ALE_LOG_ODOMETRY) {
        survey_odometry(&survey->of_records, &event->odometry.pose);
    } else if (record->with_odometry) {
        survey_odometry(&survey->of_scans, &event->odometry.pose);
    }
}

/* Which odometry is the robot's. Where the lines of the scans have one, records beside them are not used:
 * their stamps belong to another clock. Lines that never change beside records that do were left empty. */
static void choose_odometry(ale_log_t *log, const survey_t *survey)
{
    const odometry_survey_t *scans = &survey->of_scans;
    const odometry_survey_t *records = &survey->of_records;
    const bool between =
        scans->count > 0 && records->count > 0 && poses_differ(&scans->first, &records->first);
    const bool changes = scans->changes || records->changes || between;
    log->info.has_odometry =
        (scans->count > 0 || records->count > 0) && (changes || log->format->constant_odometry);
    log->use_odometry_of_records = !scans->changes;
    log->use_odometry_of_scans = scans->changes || !records->changes || scans->count < 2;
}

static bool is_stamp(int64_t stamp_us)
{
    return stamp_us >= -ALE_MAX_STAMP_US && stamp_us <= ALE_MAX_STAMP_US;
}

/* Times that the core can reckon with. */
static bool is_in_time(const ale_log_record_t *record)
{
    const ale_log_event_t *event = &record->event;
    if (event->kind == ALE_LOG_ODOMETRY || record->with_odometry) {
        return is_stamp(event->stamp_us) && is_stamp(event->odometry.stamp_us);
    }
    return is_stamp(event->stamp_us);
}

/* The next record that can be believed. */
static bool next_record(ale_log_t *log)
{
    while (log->format->next(log, &log->record)) {
        const ale_log_event_t *event = &log->record.event;
        if (is_in_time(&log->record) && (event->kind != ALE_LOG_SCAN || ale_scan_is_sweep(&event->scan))) {
            return true;
        }
        ale_log_time_beyond(log);
    }
    return false;
}

/* Reads the log once for what only the whole of it tells. */
static int survey_log(ale_log_t *log, ale_log_error_t *error)
{
    survey_t survey = {0};
    rewind_log(log);
    while (next_record(log)) {
        survey_record(&survey, &log->record, log->statistics.scans == 0);
        log->statistics.scans += log->record.event.kind == ALE_LOG_SCAN;
    }
    if (log->statistics.scans == 0 && log->statistics.too_many_beams > 0) {
        snprintf(error->message, sizeof error->message, "%s", log->last_error);
        return -1;
    }
    if (log->statistics.scans == 0 && log->no_scan) {
        return fail(error, log->path, log->no_scan);
    }
    log->stamps_of_use = log->format->stamped && survey.forward >= survey.standing;
    choose_odometry(log, &survey);
    rewind_log(log);
    return 0;
}

static int open_bytes(ale_log_t *log, ale_log_error_t *error)
{
    const char *reason = NULL;
    log->format = ale_log_detect(log, &reason);
    if (!log->format) {
        return fail(error, log->path, reason);
    }
    log->state = calloc(1, log->format->state_size);
    if (!log->state) {
        return fail(error, log->path, "not enough memory");
    }
    log->info.format = log->format->name;
    return survey_log(log, error);
}

static ale_log_t *create(const char *path)
{
    ale_log_t *log = calloc(1, sizeof *log);
    if (log) {
        snprintf(log->path, sizeof log->path, "%s", path);
    }
    return log;
}

/* Ends both ways of opening: `reason` is what went wrong in getting the bytes, or NULL. */
static int finish_open(ale_log_t **out, ale_log_t *log, const char *reason, ale_log_error_t *error)
{
    const int status = reason ? fail(error, log->path, reason) : open_bytes(log, error);
    if (status < 0) {
        ale_log_close(log);
        return -1;
    }
    *out = log;
    return 0;
}

int ale_log_open(ale_log_t **out, const char *path, ale_log_error_t *error)
{
    *out = NULL;
    ale_log_t *log = create(path);
    if (!log) {
        return fail(error, path, "not enough memory");
    }
    return finish_open(out, log, ale_bytes_read_file(&log->bytes, path), error);
}

int ale_log_open_memory(ale_log_t **out, const uint8_t *bytes, uint64_t count, ale_log_error_t *error)
{
    *out = NULL;
    ale_log_t *log = create("memory");
    if (!log) {
        return fail(error, "memory", "not enough memory");
    }
    const char *wrong =
        count <= ALE_BYTES_MOST ? ale_bytes_from_memory(&log->bytes, bytes, (size_t)count) : "too large";
    return finish_open(out, log, wrong, error);
}

const ale_log_info_t *ale_log_info(const ale_log_t *log)
{
    return &log->info;
}

ale_log_statistics_t ale_log_statistics(const ale_log_t *log)
{
    ale_log_statistics_t statistics = log->statistics;
    statistics.bytes_read = statistics.bytes_total - (uint64_t)(log->text.end - log->text.at);
    return statistics;
}

const char *ale_log_last_error(const ale_log_t *log)
{
    return log->last_error;
}

/* Gives the record the stamps of a log that has none of use. False: it has no place in time. */
static bool stamp_record(ale_log_t *log)
{
    ale_log_event_t *event = &log->record.event;
    if (log->stamps_of_use) {
        return true;
    }
    event->stamp_us = (int64_t)log->statistics.scans * DEFAULT_PERIOD_US;
    event->scan.stamp_us = event->stamp_us;
    event->odometry.stamp_us = event->stamp_us;
    return event->kind != ALE_LOG_ODOMETRY;
}

static int hand_out_scan(ale_log_t *log, ale_log_event_t *event)
{
    log->scan_waiting = false;
    log->statistics.scans++;
    *event = log->record.event;
    return 1;
}

static int hand_out_odometry(const ale_log_t *log, ale_log_event_t *event)
{
    event->kind = ALE_LOG_ODOMETRY;
    event->stamp_us = log->record.event.odometry.stamp_us;
    event->odometry = log->record.event.odometry;
    event->text = NULL;
    return 1;
}

int ale_log_next(ale_log_t *log, ale_log_event_t *event)
{
    if (log->scan_waiting) {
        return hand_out_scan(log, event);
    }
    while (next_record(log)) {
        const ale_log_kind_t kind = log->record.event.kind;
        const bool used = log->info.has_odometry && (kind == ALE_LOG_ODOMETRY ? log->use_odometry_of_records
                                                                              : log->use_odometry_of_scans);
        if (!stamp_record(log) || (kind == ALE_LOG_ODOMETRY && !used)) {
            continue;
        }
        if (used && (kind == ALE_LOG_ODOMETRY || log->record.with_odometry)) {
            log->scan_waiting = kind == ALE_LOG_SCAN;
            return hand_out_odometry(log, event);
        }
        if (kind == ALE_LOG_SCAN) {
            return hand_out_scan(log, event);
        }
        *event = log->record.event;
        return 1;
    }
    return 0;
}

void ale_log_close(ale_log_t *log)
{
    if (!log) {
        return;
    }
    free(log->state);
    ale_bytes_free(&log->bytes);
    free(log);
}
