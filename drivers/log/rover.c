/* Logs of the Mines ParisTech rover: a line of blank-separated numbers a scan, two column layouts.
 *
 *   exp*.dat       time_us  x  left right  21 others  682 ranges        (both wheels count up driving
 * forward) test_lab.dat   time_us  left -right  10 others  682 ranges
 *
 * Ranges are in mm, URG-04LX steps 44 to 725, values below 20 the sensor's error codes. The published readers
 * begin the scan one column too early and turn every beam by a step; this one does not. The wheels: 77 mm
 * radius, 2000 counts a turn, 165 mm from the middle of the axle; the laser sits 145 mm ahead of it.
 *
 * The stamp is the rover's clock when the line was written. Turns of the scans and of the wheels agree best
 * when the line's scan, taken as one at its middle beam, is 155 ms older than the line's wheel counts:
 * the scan is therefore stamped at the beam straight ahead, and 155 ms is stated as the prior of the lag.
 * Nothing is corrected here. */
#include "base/fixed.h"
#include "base/trig.h"
#include "log/format.h"
#include "log/geometry.h"

enum {
    BEAMS = 682,
    FIRST_STEP = 44,
    BEAM_AHEAD = 340,
    BODY_RIGHT = 50, /* beams before, and from BODY_LEFT on, look at the rover itself and return nothing */
    BODY_LEFT = 657,
    LAG_US = 155000,
    LASER_AHEAD_UM = 145000
};

/* Distance of the axle's middle for one count of one wheel: half of 2 pi 77 mm / 2000, in picometres. */
static const int64_t FORWARD_PM_PER_COUNT = 120951317;
static const int64_t PM_PER_UM = 1000000;

typedef struct {
    const char *name;
    uint32_t words;
    uint32_t left;
    uint32_t right;
    int32_t right_sign;
} layout_t;

static const layout_t LAYOUTS[] = {{"rover", 25 + BEAMS, 2, 3, 1},
                                   {"rover (older columns)", 13 + BEAMS, 1, 2, -1}};
enum { LAYOUT_COUNT = sizeof LAYOUTS / sizeof LAYOUTS[0], MOST_WORDS = 25 + BEAMS + 1 };

typedef struct {
    bool begun;
    int32_t first_left;
    int32_t first_right;
    int32_t left;
    int32_t right;
    int64_t x_pm;
    int64_t y_pm;
    uint32_t theta_bam;
} rover_t;

static int32_t layout_of(ale_span_t line)
{
    const uint32_t words = ale_text_count_words(line, MOST_WORDS);
    for (int32_t i = 0; i < LAYOUT_COUNT; i++) {
        if (LAYOUTS[i].words == words) {
            return i;
        }
    }
    return -1;
}

static bool claims_line(ale_span_t line)
{
    ale_span_t word;
    int64_t stamp_us = 0;
    const int32_t layout = layout_of(line);
    return layout >= 0 && ale_text_word(&line, &word) && ale_text_decimal(word, 0, &stamp_us);
}

static void choose(ale_log_t *log, ale_span_t line)
{
    log->variant = layout_of(line);
    log->info = (ale_log_info_t){
        .has_sensor = true, .sensor = {.x_um = LASER_AHEAD_UM}, .lag_prior_us = LAG_US, .urg_noise = true};
}

/* Heading from the counts since the start, without drift of rounding: (right - left) * m / 165 mm rad with
 * m = 77 pi / 2000 mm, which is (right - left) * 7 * 2^27 / 1875 BAM. */
static uint32_t heading(const rover_t *rover)
{
    const int64_t turned =
        ((int64_t)rover->right - rover->first_right) - ((int64_t)rover->left - rover->first_left);
    return (uint32_t)ale_round_div(turned * 7 * ((int64_t)1 << 27), 1875);
}

/* No farther than a pose can tell: damaged counts may leap millions of metres. */
static int64_t moved_pm(int64_t from_pm, int64_t by_pm)
{
    return ale_clamp64(from_pm + by_pm, INT32_MIN * PM_PER_UM, INT32_MAX * PM_PER_UM);
}

/* Follows the wheels to new counts: straight along the mean heading. */
static void follow_wheels(rover_t *rover, int32_t left, int32_t right)
{
    if (!rover->begun) {
        *rover =
            (rover_t){.begun = true, .first_left = left, .first_right = right, .left = left, .right = right};
        return;
    }
    const int64_t counts = ((int64_t)left - rover->left) + ((int64_t)right - rover->right);
    const uint32_t before_bam = rover->theta_bam;
    rover->left = left;
    rover->right = right;
    rover->theta_bam = heading(rover);
    const int64_t forward_pm = counts * FORWARD_PM_PER_COUNT;
    const uint32_t mean_bam = before_bam + (uint32_t)(ale_bam_diff(rover->theta_bam, before_bam) / 2);
    rover->x_pm = moved_pm(rover->x_pm, ale_mul_shift(forward_pm, ale_cos_q30(mean_bam), 30));
    rover->y_pm = moved_pm(rover->y_pm, ale_mul_shift(forward_pm, ale_sin_q30(mean_bam), 30));
}

static ale_pose_t wheel_pose(const rover_t *rover)
{
    return (ale_pose_t){.x_um = (int32_t)ale_round_div(rover->x_pm, PM_PER_UM),
                        .y_um = (int32_t)ale_round_div(rover->y_pm, PM_PER_UM),
                        .theta_bam = rover->theta_bam};
}

/* The columns before the ranges. */
static bool take_head(ale_span_t *line, const layout_t *layout, int64_t *stamp_us, int32_t *left,
                      int32_t *right)
{
    ale_span_t word;
    for (uint32_t i = 0; i < layout->words - BEAMS; i++) {
        if (!ale_text_word(line, &word) || (i == 0 && !ale_text_decimal(word, 0, stamp_us)) ||
            (i == layout->left && !ale_text_decimal32(word, 0, left)) ||
            (i == layout->right && !ale_text_decimal32(word, 0, right))) {
            return false;
        }
    }
    if (layout->right_sign < 0) {
        *right = *right == INT32_MIN ? INT32_MAX : -*right;
    }
    return true;
}

static bool take_ranges(ale_span_t *line, ale_scan_t *scan)
{
    ale_geometry_urg(scan, FIRST_STEP, BEAMS);
    scan->stamp_beam = BEAM_AHEAD;
    for (int32_t k = 0; k < scan->beams; k++) {
        ale_span_t word;
        int32_t value_mm = 0;
        if (!ale_text_word(line, &word) || !ale_text_decimal32(word, 0, &value_mm)) {
            return false;
        }
        ale_scan_set_urg(scan, (uint16_t)k, (int32_t)ale_clamp64(value_mm, 0, UINT16_MAX));
        if ((k < BODY_RIGHT || k >= BODY_LEFT) && scan->flag[k] == ALE_BEAM_NO_RETURN) {
            scan->flag[k] = ALE_BEAM_BLIND;
        }
    }
    return true;
}

static bool take_line(ale_log_t *log, ale_span_t line, ale_log_record_t *record)
{
    const layout_t *layout = &LAYOUTS[log->variant];
    const uint32_t words = ale_text_count_words(line, MOST_WORDS);
    if (words == 0) {
        return false;
    }
    if (words != layout->words) {
        ale_log_cut_line(log, words, layout->words, "numbers");
        return false;
    }
    ale_log_event_t *event = &record->event;
    int32_t left = 0;
    int32_t right = 0;
    if (!take_head(&line, layout, &event->stamp_us, &left, &right) || !take_ranges(&line, &event->scan)) {
        ale_log_bad_line(log, "a word that is not a number");
        return false;
    }
    follow_wheels(log->state, left, right);
    event->kind = ALE_LOG_SCAN;
    event->scan.stamp_us = event->stamp_us;
    event->odometry = (ale_odometry_t){.stamp_us = event->stamp_us, .pose = wheel_pose(log->state)};
    record->with_odometry = true;
    return true;
}

static bool next(ale_log_t *log, ale_log_record_t *record)
{
    return ale_log_next_line(log, record, take_line);
}

const ale_log_format_t ale_log_rover = {
    .name = "rover",
    .claims_line = claims_line,
    .choose = choose,
    .state_size = sizeof(rover_t),
    .stamped = true,
    .next = next,
};
