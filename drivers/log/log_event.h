/* What comes out of a recorded log, whatever its format: events, and what the log says of itself. */
#ifndef ALE_LOG_LOG_EVENT_H
#define ALE_LOG_LOG_EVENT_H

#include <stdbool.h>
#include <stdint.h>

#include "base/pose.h"
#include "base/scan.h"
#include "motion/odometry_sample.h"

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
    char scanner[64];     /* model that the scanner told in the recording; empty: not known */
    bool urg_noise;       /* the sensor is a URG-04LX (or simulates one): the default noise model applies */
} ale_log_info_t;

typedef struct {
    uint64_t scans;
    uint64_t bad_lines;      /* unreadable, cut, wrong count: skipped */
    uint64_t bad_chunks;     /* of a recording: checksum, length */
    uint64_t too_many_beams; /* scans with more than ALE_MAX_BEAMS beams: skipped */
    uint64_t poses_beyond;   /* of the odometry, more than 2147 m off or no number: their scans are without */
    uint64_t times_beyond;   /* records with a stamp or sweep beyond limits.h: skipped */
    uint64_t bytes_read;     /* of the unpacked log, for progress */
    uint64_t bytes_total;
    bool cut_short; /* a packed file that ends early or is damaged: what came before was read */
} ale_log_statistics_t;

#endif
