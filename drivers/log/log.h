/* Recorded logs of any known format, told by content, plain or gzip, as one stream of events.
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

#include <stdbool.h>
#include <stdint.h>

#include "base/pose.h"
#include "base/scan.h"
#include "motion/odometry_sample.h"

typedef struct ale_log ale_log_t;

typedef struct {
    char message[256]; /* one line: file, line, what is wrong */
} ale_log_error_t;

typedef enum {
    ALE_LOG_SCAN,
    ALE_LOG_SCAN_LOST, /* a recording shows that the device sent a scan which did not survive the line */
    ALE_LOG_ODOMETRY,
    ALE_LOG_COMMAND, /* operator's command, as recorded: text in `text` */
    ALE_LOG_CONFIG   /* configuration in force, as recorded: INI text in `text` */
} ale_log_kind_t;

typedef struct {
    ale_log_kind_t kind;
    int64_t stamp_us;
    ale_scan_t scan;         /* SCAN */
    ale_odometry_t odometry; /* ODOMETRY */
    const char *text;        /* COMMAND, CONFIG; valid until the next call */
} ale_log_event_t;

/* What the log says of the robot it was taken on; known after open. */
typedef struct {
    const char *format; /* for people: "CARMEN", "rover", ... */
    bool has_odometry;  /* columns that never change are taken as left empty, except in live recordings */
    bool has_sensor;    /* the mounting is stated by the format or the log */
    ale_pose_t sensor;
    int32_t lag_prior_us; /* odometry younger than the scan on its line: a prior, nothing is corrected */
    bool raw_device;      /* bearings are the device's own: a scanner upside down is not yet accounted for */
    bool urg_noise;       /* the sensor is a URG-04LX (or simulates one): the default noise model applies */
} ale_log_info_t;

typedef struct {
    uint64_t scans;
    uint64_t bad_lines;      /* unreadable, cut, wrong count: skipped */
    uint64_t bad_chunks;     /* of a recording: checksum, length */
    uint64_t too_many_beams; /* scans with more than ALE_MAX_BEAMS beams: skipped */
    uint64_t bytes_read;     /* of the unpacked log, for progress */
    uint64_t bytes_total;
    bool cut_short; /* a gzip file that ends early or is damaged: what came before was read */
} ale_log_statistics_t;

/* 0, or -1 with *error set. */
int ale_log_open(ale_log_t **out, const char *path, ale_log_error_t *error);
/* The same from memory (fuzzing, tests); the bytes must stay until close. */
int ale_log_open_memory(ale_log_t **out, const uint8_t *bytes, uint64_t count, ale_log_error_t *error);
const ale_log_info_t *ale_log_info(const ale_log_t *log);
ale_log_statistics_t ale_log_statistics(const ale_log_t *log);
/* 1 and *event filled (of its parts only the one that `kind` names), 0 at the end. Time: one record, or as
 * many bad lines as lie in between. */
int ale_log_next(ale_log_t *log, ale_log_event_t *event);
/* What was wrong with the line or chunk last skipped: file, line, what. Empty when there was none. */
const char *ale_log_last_error(const ale_log_t *log);
void ale_log_close(ale_log_t *log);

#endif
