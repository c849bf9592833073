/* What a log format is to the rest: how it is told, and how it yields records. Internal to drivers/log.
 *
 * A format keeps its own state (state_size bytes, zeroed at every rewind), takes what it needs from
 * log->text and returns one record a call. Every log is read twice: once by the survey at open (does it
 * have odometry, are its stamps of use), once by the caller. */
#ifndef ALE_LOG_FORMAT_H
#define ALE_LOG_FORMAT_H

#include "file/bytes.h"
#include "file/text.h"
#include "log/log_event.h"

typedef struct ale_log ale_log_t;

typedef struct {
    ale_log_event_t event; /* complete but for the stamps, when the log has none of use */
    bool with_odometry;    /* a SCAN whose line also holds event.odometry */
} ale_log_record_t;

typedef struct {
    const char *name;
    /* Binary formats: the whole file is theirs. NULL for text formats. */
    bool (*claims_file)(const uint8_t *bytes, size_t count);
    /* Text formats: this line is one of theirs. NULL for binary formats. */
    bool (*claims_line)(ale_span_t line);
    size_t state_size;
    bool stamped;           /* false: the format has no stamps at all */
    bool constant_odometry; /* odometry that never changes is odometry too (else: columns left empty) */
    /* Called when the format is chosen, with a line that it claimed (text formats). */
    void (*choose)(ale_log_t *log, ale_span_t line);
    /* True and *record filled, false at the end. Writes log->info where the log states something. */
    bool (*next)(ale_log_t *log, ale_log_record_t *record);
} ale_log_format_t;

extern const ale_log_format_t ale_log_carmen;
extern const ale_log_format_t ale_log_rover;
extern const ale_log_format_t ale_log_scan_lines;
extern const ale_log_format_t ale_log_pairs;
extern const ale_log_format_t ale_log_scip;
extern const ale_log_format_t ale_log_lcm_events;

struct ale_log {
    char path[160]; /* for messages */
    ale_bytes_t bytes;
    ale_text_t text; /* what is still to be read */
    const ale_log_format_t *format;
    void *state;
    int32_t variant; /* of the format, set by choose */
    ale_log_info_t info;
    ale_log_statistics_t statistics;
    char last_error[256];
    const char *no_scan; /* why there can be none, as far as the format knows; NULL: nothing is wrong */
    bool stamps_of_use;
    bool use_odometry_of_scans;   /* that their own lines state, */
    bool use_odometry_of_records; /* and that of lines or chunks beside them */
    bool scan_waiting;            /* record.event is a scan whose odometry was handed out */
    ale_log_record_t record;
};

/* Text formats: takes lines until one is a record. False at the end. */
bool ale_log_next_line(ale_log_t *log, ale_log_record_t *record,
                       bool (*take_line)(ale_log_t *log, ale_span_t line, ale_log_record_t *record));

/* Counts the line last taken as bad and remembers why. */
void ale_log_bad_line(ale_log_t *log, const char *what);

/* The same for a line that holds another number of something than it must. */
void ale_log_cut_line(ale_log_t *log, uint32_t count, uint32_t wanted, const char *of_what);

/* Counts an odometry pose in the line last taken that is beyond what ale_pose_t holds: the scan beside it is
 * read without. */
void ale_log_pose_beyond(ale_log_t *log);

/* Counts the record last taken as one whose times are beyond what the core reckons with: it is skipped. */
void ale_log_time_beyond(ale_log_t *log);

/* Counts a damaged part of a binary log, at about log->text.at, and remembers what it was. */
void ale_log_bad_chunk(ale_log_t *log, const char *what);

/* Counts the line last taken as a scan of too many beams. */
void ale_log_too_many_beams(ale_log_t *log, int64_t beams);

#endif
