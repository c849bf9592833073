/* Recorded logs of any known format, told by content, plain, gzip or bzip2, as one stream of events.
 *
 *   ale_log_t *log;  ale_log_error_t error;
 *   if (ale_log_open(&log, path, &error) < 0) ... error.message names file, line and what ...
 *   while (ale_log_next(log, &event) > 0) ...
 *   ale_log_close(log);
 *
 * Formats: CARMEN text (FLASER, RLASER, ROBOTLASER1, ODOM), Mines ParisTech rover logs (both column
 * layouts), .scan lines, Odometry/Laser pairs, .scip recordings, LCM event logs with ALE_SCAN.
 * Bad lines are counted in the statistics and skipped; they never end a log. Scans come in the order of
 * the log; odometry that belongs to a line comes before its scan, stamped as the log stamps it.
 * The log is held in memory, unpacked (at most 4 GiB; 1 GiB where addresses have 32 bits), and read through
 * once at open: has_odometry and the use of its stamps are facts of the whole. Where stamps are missing or
 * mostly do not advance, scan k is at k * 0.1 s. One owner thread; independent logs may be used at the same
 * time. */
#ifndef ALE_LOG_LOG_H
#define ALE_LOG_LOG_H

#include <stdint.h>

#include "log/log_event.h"

typedef struct ale_log ale_log_t;

typedef struct {
    char message[256]; /* one line: file, line, what is wrong */
} ale_log_error_t;

/* Opens a log and reads it through once. 0 and *out, the caller's to close; or -1, *out NULL and one line in
 * *error: the file cannot be read (with the system's words), is a directory, is empty, is larger than this
 * machine can hold, is of no known format, has nothing but scans of too many beams, or memory is short.
 * path: at most 159 characters of it stand in messages. Time: proportional to the length of the log. */
int ale_log_open(ale_log_t **out, const char *path, ale_log_error_t *error);

/* The same from memory (fuzzing, tests); the bytes must stay until close. */
int ale_log_open_memory(ale_log_t **out, const uint8_t *bytes, uint64_t count, ale_log_error_t *error);

/* What the log says of the robot. Valid until close; the mounting is complete from open on. Cannot fail. */
const ale_log_info_t *ale_log_info(const ale_log_t *log);

/* What was read and skipped since open. Cannot fail. */
ale_log_statistics_t ale_log_statistics(const ale_log_t *log);

/* 1 and *event filled (of its parts only the one that `kind` names), 0 at the end. Damage is no error: it is
 * skipped and counted. Time: one record, or as many bad lines as lie in between. */
int ale_log_next(ale_log_t *log, ale_log_event_t *event);

/* What was wrong with the line or chunk last skipped: file, line, what. Empty when there was none. Valid
 * until the next call of ale_log_next. */
const char *ale_log_last_error(const ale_log_t *log);

/* NULL: nothing. */
void ale_log_close(ale_log_t *log);

#endif
