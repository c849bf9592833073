#include "lab/sim/log_source.h"

#include <algorithm>
#include <stdexcept>

#include "lab/sim/units.h"

extern "C" {
#include "base/trig.h"
}

namespace sim
{

namespace
{

constexpr int64_t longest_gap_us = 2000000;
constexpr int64_t usual_gap_us = 100000;
constexpr int64_t shortest_gap_us = 2000; /* stamps are milliseconds: two scans must not share one */
constexpr size_t scans_ahead = 4;         /* odometry of a later scan may be due before an earlier scan */
constexpr double degrees_per_bam = 360 / bam_per_turn;
constexpr double urg_step_bam = 4194304; /* 1024 steps a turn */

/* The URG-04LX's step of the scan's first beam; nothing when the scan is another scanner's. */
std::optional<int32_t> urg_first_step(const ale_scan_t &scan)
{
    const Scanner urg;
    const double tolerance = urg_step_bam / 10000; /* logs state angles as decimal fractions */
    const double step = ale_bam_diff(scan.first_bearing_bam, 0) / urg_step_bam + urg.front_step;
    const auto first = static_cast<int32_t>(std::lround(step));
    const bool fits = std::fabs(scan.step_bam - urg_step_bam) < tolerance && std::fabs(step - first) < 0.1 &&
                      first >= 0 && first + scan.beams <= urg.end_step + 1;
    return fits ? std::optional(first) : std::nullopt;
}

/* The scanner that gives such scans. Its steps are the log's beams; the front is the nearest of them. */
Scanner scanner_of(const ale_scan_t &scan)
{
    Scanner scanner;
    if (urg_first_step(scan)) {
        return scanner;
    }
    const double step = std::fabs(static_cast<double>(scan.step_bam));
    const auto first_bearing = static_cast<double>(ale_bam_diff(scan.first_bearing_bam, 0));
    scanner.model = "Recorded scanner";
    scanner.product = "Recorded scanner of " + std::to_string(scan.beams) + " beams";
    scanner.serial = "LOG";
    scanner.turn_steps = static_cast<int32_t>(std::lround(bam_per_turn / step));
    scanner.first_step = 0;
    scanner.last_step = scan.beams - 1;
    scanner.end_step = scanner.last_step;
    scanner.front_step = static_cast<int32_t>(std::lround(-first_bearing / scan.step_bam));
    scanner.min_mm = std::max(20, (scan.range_min_um + 999) / 1000);
    scanner.max_mm = scan.range_max_um / 1000;
    return scanner;
}

int32_t value_of(const ale_scan_t &scan, size_t beam)
{
    const int32_t mm = static_cast<int32_t>((static_cast<int64_t>(scan.range_um[beam]) + 500) / 1000);
    switch (scan.flag[beam]) {
    case ALE_BEAM_VALID:
        return mm;
    case ALE_BEAM_UNKNOWN:
        return scan.code[beam] != 0 ? scan.code[beam] : 1;
    default:
        return scan.code[beam];
    }
}

/* The beams at either end that the log's reader knows to see the robot itself. */
std::vector<BlindSector> blind_ends(const ale_scan_t &scan)
{
    int32_t right = 0;
    int32_t left = scan.beams;
    while (right < scan.beams && scan.flag[right] == ALE_BEAM_BLIND) {
        right++;
    }
    while (left > right && scan.flag[left - 1] == ALE_BEAM_BLIND) {
        left--;
    }
    const auto edge = [&](int32_t beam) {
        const double step = degrees_per_bam * scan.step_bam;
        return degrees_per_bam * ale_bam_diff(scan.first_bearing_bam, 0) + (beam - 0.5) * step;
    };
    std::vector<BlindSector> sectors;
    if (right > 0) {
        sectors.push_back({edge(0), edge(right)});
    }
    if (left < scan.beams) {
        sectors.push_back({edge(left), edge(scan.beams)});
    }
    return sectors;
}

Pose pose_of(const ale_pose_t &pose)
{
    return {metres(pose.x_um), metres(pose.y_um), radians(pose.theta_bam)};
}

} // namespace

LogSource::LogSource(const std::string &path, bool once)
    : once_(once), path_(path), log_(path), event_(std::make_unique<ale_log_event_t>())
{
    read_ahead();
    if (turns_.empty()) {
        throw std::runtime_error(path + ": no scan in it");
    }
}

void LogSource::read_ahead()
{
    while (!at_end_ && turns_.size() < scans_ahead) {
        at_end_ = !log_.next(*event_);
        if (!at_end_ && event_->kind == ALE_LOG_ODOMETRY) {
            unplaced_.push_back(event_->odometry);
        } else if (!at_end_ && event_->kind == ALE_LOG_SCAN) {
            take_scan(event_->scan);
        }
    }
    if (at_end_ && turns_.empty() && !once_ && scans_ > 0) {
        stay();
    }
}

/* Time of play of a scan's step 0. */
int64_t LogSource::play_time(int64_t stamp_us)
{
    const int64_t gap_us = stamp_us - offset_us_ - last_start_us_;
    if (scans_ == 0) {
        offset_us_ = stamp_us;
    } else if (gap_us <= 0 || gap_us > longest_gap_us) {
        offset_us_ = stamp_us - last_start_us_ - usual_gap_us;
    }
    return std::max(stamp_us - offset_us_, scans_ == 0 ? 0 : last_start_us_ + shortest_gap_us);
}

void LogSource::take_scan(const ale_scan_t &scan)
{
    if (scans_ == 0) {
        scanner_ = scanner_of(scan);
        blind_ = blind_ends(scan);
    }
    const int32_t first_step = urg_first_step(scan).value_or(scanner_.first_step);
    Turn turn;
    turn.number = scans_;
    turn.value_mm.assign(static_cast<size_t>(scanner_.end_step) + 1, not_a_step);
    for (size_t k = 0; k < scan.beams && static_cast<size_t>(first_step) + k < turn.value_mm.size(); k++) {
        turn.value_mm[static_cast<size_t>(first_step) + k] = value_of(scan, k);
    }
    turn.start_us = play_time(scan.stamp_us + ale_scan_beam_offset_us(&scan, -first_step));
    last_start_us_ = turn.start_us;
    scans_++;
    for (const ale_odometry_t &sample : unplaced_) {
        const int64_t stamp_us = sample.stamp_us - offset_us_;
        if (std::llabs(stamp_us - turn.start_us) <= longest_gap_us) {
            odometry_.push_back({stamp_us, pose_of(sample.pose)});
        }
    }
    unplaced_.clear();
    last_turn_ = turn;
    turns_.push_back(std::move(turn));
}

/* The log is over and the robot stands: its last scan again and again. */
void LogSource::stay()
{
    last_start_us_ += scanner_.period_us();
    last_turn_.number = scans_++;
    last_turn_.start_us = last_start_us_;
    turns_.push_back(last_turn_);
}

std::optional<int64_t> LogSource::due_us()
{
    if (turns_.empty() && odometry_.empty()) {
        return std::nullopt;
    }
    const int64_t never = INT64_MAX;
    const int64_t turn_us =
        turns_.empty() ? never : turns_.front().start_us + scanner_.period_us() + reply_delay_us;
    return std::min(turn_us, odometry_.empty() ? never : odometry_.front().stamp_us);
}

Event LogSource::next()
{
    const bool odometry_first =
        !odometry_.empty() &&
        (turns_.empty() || odometry_.front().stamp_us <= turns_.front().start_us + scanner_.period_us());
    if (odometry_first) {
        const OdometryReport report = odometry_.front();
        odometry_.pop_front();
        return report;
    }
    Turn turn = std::move(turns_.front());
    turns_.pop_front();
    read_ahead();
    return turn;
}

} // namespace sim
