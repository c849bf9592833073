/* CARMEN text logs.
 *
 *   FLASER n r.. x y theta odom_x odom_y odom_theta ipc_stamp host logger_stamp
 *   RLASER as FLASER, the laser that looks back
 *   ROBOTLASER1 type start field resolution max accuracy remission n r.. m remissions..
 *               laser_x y theta  robot_x y theta  tv rv forward side turn_axis  ipc_stamp host logger_stamp
 *   ODOM x y theta tv rv accel ipc_stamp host logger_stamp
 *   PARAM robot_frontlaser_offset metres ..
 *   # beam_time_us 97.656 stamp_beam 340
 *
 * One laser is followed: the one of the first scan line. The mounting is the laser's pose as seen from the
 * robot's where a line has both; it is stated only if all lines agree (in some logs the first pose is a
 * corrected one and has nothing to do with the second). */
#include <stddef.h>
#include <string.h>

#include "base/fixed.h"
#include "base/trig.h"
#include "log/format.h"
#include "log/geometry.h"

enum {
    RANGE_MIN_UM = 20000,
    FLASER_MAX_UM = 50000000,
    AGREE_UM = 2000,
    AGREE_BAM = 2 * ALE_BAM_PER_MRAD,
    HOKUYO_URG = 2 /* CARMEN's number of the sensor in ROBOTLASER1 */
};

typedef struct {
    ale_span_t laser; /* keyword of the laser that is followed */
    int32_t beam_time_ns;
    int32_t stamp_beam;
    bool mounting_seen;
    bool mounting_varies;
    ale_pose_t mounting;
    bool offset_stated; /* by PARAM */
    ale_pose_t offset;
} carmen_t;

static bool is_scan_keyword(ale_span_t word)
{
    return ale_text_is(word, "FLASER") || ale_text_is(word, "RLASER") || ale_text_is(word, "ROBOTLASER1") ||
           ale_text_is(word, "ROBOTLASER2");
}

/* ROBOTLASER1 and 2, which state the pose of the robot beside that of the laser. */
static bool is_robot_laser(ale_span_t keyword)
{
    return keyword.at && keyword.end - keyword.at > (ptrdiff_t)strlen("RLASER");
}

static bool looks_back(ale_span_t keyword)
{
    return keyword.at && *keyword.at == 'R' && !is_robot_laser(keyword);
}

static bool claims_line(ale_span_t line)
{
    ale_span_t keyword;
    ale_span_t number;
    int64_t value = 0;
    return ale_text_word(&line, &keyword) && (is_scan_keyword(keyword) || ale_text_is(keyword, "ODOM")) &&
           ale_text_word(&line, &number) && ale_text_decimal(number, 6, &value);
}

static bool take_decimal(ale_span_t *line, unsigned decimals, int64_t *out)
{
    ale_span_t word;
    return ale_text_word(line, &word) && ale_text_decimal(word, decimals, out);
}

static bool take_decimal32(ale_span_t *line, unsigned decimals, int32_t *out)
{
    ale_span_t word;
    return ale_text_word(line, &word) && ale_text_decimal32(word, decimals, out);
}

static bool take_angle(ale_span_t *line, uint32_t *out)
{
    ale_span_t word;
    return ale_text_word(line, &word) && ale_text_angle(word, out);
}

/* A pose as a line states it. */
typedef struct {
    ale_pose_t pose;
    bool is_held; /* false: its numbers are beyond what a pose holds (encoders that speak millimetres) */
} stated_pose_t;

/* Some programs write a value that they do not have as "nan" or "inf". */
static bool is_nothing(ale_span_t word)
{
    return ale_text_is(word, "nan") || ale_text_is(word, "-nan") || ale_text_is(word, "inf");
}

/* Three words that are numbers; false where they are not. */
static bool take_pose(ale_span_t *line, stated_pose_t *out)
{
    ale_span_t word[3];
    *out = (stated_pose_t){.is_held = true};
    for (uint32_t i = 0; i < 3; i++) {
        int64_t value = 0;
        if (!ale_text_word(line, &word[i]) ||
            (!is_nothing(word[i]) && !ale_text_decimal(word[i], 6, &value))) {
            return false;
        }
    }
    out->is_held = ale_text_decimal32(word[0], 6, &out->pose.x_um) &&
                   ale_text_decimal32(word[1], 6, &out->pose.y_um) &&
                   ale_text_angle(word[2], &out->pose.theta_bam);
    return true;
}

static bool skip_words(ale_span_t *line, int64_t count)
{
    ale_span_t word;
    for (int64_t i = 0; i < count; i++) {
        if (!ale_text_word(line, &word)) {
            return false;
        }
    }
    return true;
}

/* The number of beams; false when it is none or cannot be held (counted accordingly). */
static bool take_beam_count(ale_log_t *log, ale_span_t *line, uint16_t *beams)
{
    int64_t count = 0;
    if (!take_decimal(line, 0, &count) || count < 1) {
        ale_log_bad_line(log, "no number of beams");
        return false;
    }
    if (count > ALE_MAX_BEAMS) {
        ale_log_too_many_beams(log, count);
        return false;
    }
    *beams = (uint16_t)count;
    return true;
}

static bool take_ranges(ale_log_t *log, ale_span_t *line, ale_scan_t *scan)
{
    for (uint16_t k = 0; k < scan->beams; k++) {
        ale_span_t word;
        if (!ale_text_word(line, &word)) {
            ale_log_cut_line(log, k, scan->beams, "ranges");
            return false;
        }
        int64_t range_um = 0;
        if (!is_nothing(word) && !ale_text_decimal(word, 6, &range_um)) {
            ale_log_bad_line(log, "a range that is not a number");
            return false;
        }
        ale_geometry_set_range(scan, k, (int32_t)ale_clamp64(range_um, 0, INT32_MAX));
    }
    return true;
}

static bool is_origin(const ale_pose_t *pose)
{
    return pose->x_um == 0 && pose->y_um == 0 && pose->theta_bam == 0;
}

static void note_mounting(carmen_t *carmen, ale_pose_t laser, ale_pose_t robot)
{
    const ale_pose_t mounting = ale_pose_between(robot, laser);
    if (!carmen->mounting_seen) {
        carmen->mounting_seen = true;
        carmen->mounting = mounting;
    }
    const ale_pose_t *first = &carmen->mounting;
    carmen->mounting_varies |= ale_abs64((int64_t)mounting.x_um - first->x_um) > AGREE_UM ||
                               ale_abs64((int64_t)mounting.y_um - first->y_um) > AGREE_UM ||
                               ale_abs64(ale_bam_diff(mounting.theta_bam, first->theta_bam)) > AGREE_BAM;
}

/* Poses, then the stamp after `between` words that nobody needs. A line without stamp is a scan at 0; one
 * whose odometry no pose holds is a scan without odometry. */
static bool take_poses_and_stamp(ale_log_t *log, ale_span_t *line, int64_t between, ale_log_record_t *record)
{
    stated_pose_t laser;
    stated_pose_t robot;
    ale_log_event_t *event = &record->event;
    if (!take_pose(line, &laser) || !take_pose(line, &robot)) {
        ale_log_bad_line(log, "no poses after the ranges");
        return false;
    }
    if (!robot.is_held) {
        ale_log_pose_beyond(log);
    } else if (laser.is_held) {
        note_mounting(log->state, laser.pose, robot.pose);
    }
    int64_t stamp_us = 0;
    if (skip_words(line, between)) {
        (void)take_decimal(line, 6, &stamp_us);
    }
    event->kind = ALE_LOG_SCAN;
    event->stamp_us = event->scan.stamp_us = event->odometry.stamp_us = stamp_us;
    event->odometry.pose = robot.pose;
    record->with_odometry = robot.is_held;
    return true;
}

static void set_sweep(const carmen_t *carmen, ale_scan_t *scan)
{
    scan->beam_time_ns = carmen->beam_time_ns;
    scan->stamp_beam = carmen->beam_time_ns ? carmen->stamp_beam : 0;
}

/* FLASER and RLASER behind their keyword. */
static bool take_old_laser(ale_log_t *log, ale_span_t *line, ale_log_record_t *record)
{
    ale_scan_t *scan = &record->event.scan;
    uint16_t beams = 0;
    if (!take_beam_count(log, line, &beams)) {
        return false;
    }
    ale_geometry_by_count(scan, beams);
    set_sweep(log->state, scan);
    scan->range_min_um = RANGE_MIN_UM;
    scan->range_max_um = FLASER_MAX_UM;
    return take_ranges(log, line, scan) && take_poses_and_stamp(log, line, 0, record);
}

/* Type to accuracy, remission mode, number of beams. */
static bool take_laser_head(ale_log_t *log, ale_span_t *line, ale_scan_t *scan)
{
    int64_t type = 0;
    int64_t field_nrad = 0;
    uint32_t step_bam = 0;
    int32_t max_um = 0;
    if (!take_decimal(line, 0, &type) || !take_angle(line, &scan->first_bearing_bam) ||
        !take_decimal(line, 9, &field_nrad) || !take_angle(line, &step_bam) ||
        !take_decimal32(line, 6, &max_um) || !skip_words(line, 2)) {
        ale_log_bad_line(log, "unreadable head of a ROBOTLASER line");
        return false;
    }
    if (!take_beam_count(log, line, &scan->beams)) {
        return false;
    }
    scan->step_bam = ale_geometry_whole_step((int32_t)step_bam);
    scan->range_min_um = RANGE_MIN_UM;
    scan->range_max_um = (int32_t)ale_clamp64(max_um > 0 ? max_um : FLASER_MAX_UM, 1, ALE_MAX_RANGE_UM);
    log->info.urg_noise = type == HOKUYO_URG || scan->step_bam == ALE_URG_STEP_BAM;
    return true;
}

/* ROBOTLASER1 and 2 behind their keyword. */
static bool take_robot_laser(ale_log_t *log, ale_span_t *line, ale_log_record_t *record)
{
    ale_scan_t *scan = &record->event.scan;
    if (!take_laser_head(log, line, scan) || !take_ranges(log, line, scan)) {
        return false;
    }
    set_sweep(log->state, scan);
    int64_t remissions = 0;
    if (!take_decimal(line, 0, &remissions) || !skip_words(line, remissions)) {
        ale_log_bad_line(log, "ends before its poses");
        return false;
    }
    return take_poses_and_stamp(log, line, 5, record);
}

static bool take_odometry(ale_log_t *log, ale_span_t *line, ale_log_record_t *record)
{
    stated_pose_t robot;
    ale_log_event_t *event = &record->event;
    if (!take_pose(line, &robot) || !skip_words(line, 3) ||
        !take_decimal(line, 6, &event->odometry.stamp_us)) {
        ale_log_bad_line(log, "unreadable ODOM line");
        return false;
    }
    if (!robot.is_held) {
        ale_log_pose_beyond(log);
        return false;
    }
    event->odometry.pose = robot.pose;
    event->kind = ALE_LOG_ODOMETRY;
    event->stamp_us = event->odometry.stamp_us;
    record->with_odometry = false;
    return true;
}

static void take_comment(carmen_t *carmen, ale_span_t line)
{
    ale_span_t word;
    while (ale_text_word(&line, &word)) {
        int32_t value = 0;
        if (ale_text_is(word, "beam_time_us") && take_decimal32(&line, 3, &value)) {
            carmen->beam_time_ns = value;
        } else if (ale_text_is(word, "stamp_beam") && take_decimal32(&line, 0, &value)) {
            carmen->stamp_beam = value;
        }
    }
}

static void take_parameter(carmen_t *carmen, ale_span_t line)
{
    ale_span_t word;
    if (ale_text_word(&line, &word) && ale_text_is(word, "robot_frontlaser_offset") &&
        take_decimal32(&line, 6, &carmen->offset.x_um)) {
        carmen->offset_stated = true;
    }
}

/* Other messages begin with a word of capitals; anything else is damage. */
static bool is_message_name(ale_span_t word)
{
    for (const char *c = word.at; c < word.end; c++) {
        if (!(*c >= 'A' && *c <= 'Z') && !(*c >= '0' && *c <= '9' && c > word.at) && *c != '_') {
            return false;
        }
    }
    return true;
}

static bool take_scan(ale_log_t *log, ale_span_t keyword, ale_span_t *line, ale_log_record_t *record)
{
    carmen_t *carmen = log->state;
    if (!carmen->laser.at) {
        carmen->laser = keyword;
    }
    const size_t length = (size_t)(keyword.end - keyword.at);
    if (length != (size_t)(carmen->laser.end - carmen->laser.at) ||
        memcmp(keyword.at, carmen->laser.at, length) != 0) {
        return false; /* another laser of the same robot */
    }
    return is_robot_laser(keyword) ? take_robot_laser(log, line, record) : take_old_laser(log, line, record);
}

static bool take_line(ale_log_t *log, ale_span_t line, ale_log_record_t *record)
{
    ale_span_t word;
    if (!ale_text_word(&line, &word)) {
        return false;
    }
    if (*word.at == '#') {
        take_comment(log->state, line);
    } else if (is_scan_keyword(word)) {
        return take_scan(log, word, &line, record);
    } else if (ale_text_is(word, "ODOM")) {
        return take_odometry(log, &line, record);
    } else if (ale_text_is(word, "PARAM")) {
        take_parameter(log->state, line);
    } else if (!is_message_name(word)) {
        ale_log_bad_line(log, "not a CARMEN message");
    }
    return false;
}

/* What is known of the mounting so far; complete once the log has been read through. Many programs write the
 * robot's pose for the laser's into FLASER: a mounting of zero is believed of ROBOTLASER only. */
static void state_mounting(ale_log_t *log)
{
    const carmen_t *carmen = log->state;
    ale_log_info_t *info = &log->info;
    const bool agreed = carmen->mounting_seen && !carmen->mounting_varies;
    if (agreed && !is_origin(&carmen->mounting)) {
        info->has_sensor = true;
        info->sensor = carmen->mounting;
    } else if (looks_back(carmen->laser)) {
        info->has_sensor = true;
        info->sensor = (ale_pose_t){.theta_bam = ALE_BAM_HALF_TURN};
    } else {
        info->has_sensor = carmen->offset_stated || (agreed && is_robot_laser(carmen->laser));
        info->sensor = carmen->offset;
    }
}

static bool next(ale_log_t *log, ale_log_record_t *record)
{
    if (ale_log_next_line(log, record, take_line)) {
        return true;
    }
    state_mounting(log);
    return false;
}

const ale_log_format_t ale_log_carmen = {
    .name = "CARMEN",
    .claims_line = claims_line,
    .state_size = sizeof(carmen_t),
    .stamped = true,
    .next = next,
};
