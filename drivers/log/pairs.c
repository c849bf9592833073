/* Pairs of lines `Odometry x y theta` and `Laser n r..` (DP-SLAM), metres and radians, without stamps.
 * The SICK measures in millimetre mode, where 8.183 m and more tell that nothing returned; the program that
 * the logs belong to mounts it 0.40 m ahead of the turning centre. */
#include "base/fixed.h"
#include "log/format.h"
#include "log/geometry.h"

enum { RANGE_MIN_UM = 20000, RANGE_MAX_UM = 8183000, LASER_AHEAD_UM = 400000 };

typedef struct {
    bool has_pose;
    ale_pose_t pose; /* of the Odometry line last seen */
} pairs_t;

static bool claims_line(ale_span_t line)
{
    ale_span_t keyword;
    ale_span_t number;
    int64_t value = 0;
    return ale_text_word(&line, &keyword) &&
           (ale_text_is(keyword, "Odometry") || ale_text_is(keyword, "Laser")) &&
           ale_text_word(&line, &number) && ale_text_decimal(number, 6, &value);
}

static void choose(ale_log_t *log, ale_span_t line)
{
    (void)line;
    log->info.has_sensor = true;
    log->info.sensor = (ale_pose_t){.x_um = LASER_AHEAD_UM};
}

static bool take_pose(ale_span_t line, ale_pose_t *out)
{
    ale_span_t x;
    ale_span_t y;
    ale_span_t theta;
    ale_pose_t pose;
    if (!ale_text_word(&line, &x) || !ale_text_word(&line, &y) || !ale_text_word(&line, &theta) ||
        !ale_text_decimal32(x, 6, &pose.x_um) || !ale_text_decimal32(y, 6, &pose.y_um) ||
        !ale_text_angle(theta, &pose.theta_bam)) {
        return false;
    }
    *out = pose;
    return true;
}

static bool take_laser(ale_log_t *log, ale_span_t line, ale_scan_t *scan)
{
    ale_span_t word;
    int64_t beams = 0;
    if (!ale_text_word(&line, &word) || !ale_text_decimal(word, 0, &beams) || beams < 1) {
        ale_log_bad_line(log, "no number of beams");
        return false;
    }
    if (beams > ALE_MAX_BEAMS) {
        ale_log_too_many_beams(log, beams);
        return false;
    }
    *scan = (ale_scan_t){.range_min_um = RANGE_MIN_UM, .range_max_um = RANGE_MAX_UM};
    ale_geometry_by_count(scan, (uint16_t)beams);
    for (uint16_t k = 0; k < scan->beams; k++) {
        int64_t range_um = 0;
        if (!ale_text_word(&line, &word) || !ale_text_decimal(word, 6, &range_um)) {
            ale_log_cut_line(log, k, scan->beams, "ranges");
            return false;
        }
        ale_geometry_set_range(scan, k, (int32_t)ale_clamp64(range_um, 0, INT32_MAX));
    }
    return true;
}

static bool take_line(ale_log_t *log, ale_span_t line, ale_log_record_t *record)
{
    pairs_t *pairs = log->state;
    ale_span_t word;
    if (!ale_text_word(&line, &word) || *word.at == '#') {
        return false;
    }
    if (ale_text_is(word, "Odometry")) {
        if (!take_pose(line, &pairs->pose)) {
            ale_log_bad_line(log, "unreadable Odometry line");
            return false;
        }
        pairs->has_pose = true;
        return false;
    }
    if (!ale_text_is(word, "Laser")) {
        ale_log_bad_line(log, "neither Odometry nor Laser");
        return false;
    }
    record->event.kind = ALE_LOG_SCAN;
    record->event.odometry.pose = pairs->pose;
    record->with_odometry = pairs->has_pose;
    pairs->has_pose = false;
    return take_laser(log, line, &record->event.scan);
}

static bool next(ale_log_t *log, ale_log_record_t *record)
{
    return ale_log_next_line(log, record, take_line);
}

const ale_log_format_t ale_log_pairs = {
    .name = "Odometry/Laser pairs",
    .claims_line = claims_line,
    .choose = choose,
    .state_size = sizeof(pairs_t),
    .next = next,
};
