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

constexpr int64_t longest_pause_us = 30000000;
constexpr int64_t set_back_us = 1000000; /* a stamp that is older by more tells of a clock that was set */
constexpr int64_t short_pause_us = 3000000;
constexpr int64_t tick_us = 1; /* of the stamps on the line */
/* Scans and odometry go two ways to the robot. So far apart they arrive in the order of the log, as long as
 * its scans leave the time. */
constexpr int64_t distance_host_us = 20000;
constexpr int64_t distance_least_us = 20000;
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

/* What only the whole of a log tells. */
class Survey
{
  public:
    explicit Survey(const std::string &path)
    {
        ale::LogReader log(path);
        const auto event = std::make_unique<ale_log_event_t>();
        while (log.next(*event)) {
            if (event->kind == ALE_LOG_SCAN) {
                take(event->scan);
            }
        }
    }
    int64_t longest_gap_us() const
    {
        return longest_gap_us_;
    }
    int64_t mean_gap_us() const
    {
        return scans_ > 1 ? timeline_.last_us() / (scans_ - 1) : 0;
    }
    /* Beams at either end that the log's reader knows to see the robot itself. */
    int32_t blind_right() const
    {
        return blind_right_;
    }
    int32_t blind_left() const
    {
        return blind_left_;
    }

  private:
    void take(const ale_scan_t &scan)
    {
        const int64_t before_us = timeline_.last_us();
        if (scans_ == 0) {
            timeline_.begin(scan.stamp_us, 0);
        } else {
            longest_gap_us_ = std::max(longest_gap_us_, timeline_.take(scan.stamp_us) - before_us);
        }
        const auto is_blind = [&](int32_t k) { return scan.flag[k] == ALE_BEAM_BLIND && scan.code[k] == 0; };
        while (blind_right_ < scan.beams && is_blind(blind_right_)) {
            blind_right_++;
        }
        while (blind_left_ < scan.beams && is_blind(scan.beams - 1 - blind_left_)) {
            blind_left_++;
        }
        scans_++;
    }

    Timeline timeline_;
    int64_t scans_ = 0;
    int64_t longest_gap_us_ = 0;
    int32_t blind_right_ = 0;
    int32_t blind_left_ = 0;
};

Recorded recorded_as(const ale_scan_t &scan, int32_t first_step, const Survey &survey)
{
    Recorded recorded;
    recorded.longest_gap_us = survey.longest_gap_us();
    recorded.blind_before = first_step + survey.blind_right();
    recorded.blind_from = first_step + scan.beams - survey.blind_left();
    recorded.stamp_step = first_step + scan.stamp_beam;
    recorded.step_ns = scan.beam_time_ns;
    recorded.step_bam = scan.step_bam;
    recorded.origin_bam = ale_bam_diff(ale_scan_bearing(&scan, -first_step), 0);
    return recorded;
}

/* The scanner that gives such scans. Its steps are the log's beams; the front is the nearest of them. */
Scanner scanner_of(const ale_scan_t &scan)
{
    Scanner scanner;
    if (const auto first_step = urg_first_step(scan)) {
        scanner.first_step = *first_step;
        scanner.last_step = *first_step + scan.beams - 1;
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

Pose pose_of(const ale_pose_t &pose)
{
    return {metres(pose.x_um), metres(pose.y_um), radians(pose.theta_bam)};
}

} // namespace

int64_t Timeline::take(int64_t stamp_us)
{
    const int64_t gap_us = at(stamp_us) - last_us_;
    if (gap_us < -set_back_us || gap_us > longest_pause_us) {
        offset_us_ = stamp_us - last_us_ - short_pause_us;
    }
    last_us_ = at(stamp_us) == last_us_ ? last_us_ + tick_us : at(stamp_us);
    return last_us_;
}

LogSource::LogSource(const std::string &path, bool once, double speed)
    : once_(once), speed_(speed), path_(path), log_(path), event_(std::make_unique<ale_log_event_t>())
{
    read_ahead();
    if (due_.empty()) {
        throw std::runtime_error(path + ": no scan in it");
    }
}

void LogSource::read_ahead()
{
    while (!at_end_ && due_.empty()) {
        at_end_ = !log_.next(*event_);
        if (!at_end_ && event_->kind == ALE_LOG_ODOMETRY) {
            unplaced_.push_back(event_->odometry);
        } else if (!at_end_ && event_->kind == ALE_LOG_SCAN) {
            take_scan(event_->scan);
        }
    }
    if (at_end_ && due_.empty() && !once_ && scans_ > 0) {
        stay();
    }
}

Turn LogSource::turn_of(const ale_scan_t &scan, int32_t first_step) const
{
    Turn turn;
    turn.number = scans_;
    turn.value_mm.assign(static_cast<size_t>(scanner_.end_step) + 1, not_a_step);
    for (size_t k = 0; k < scan.beams && static_cast<size_t>(first_step) + k < turn.value_mm.size(); k++) {
        turn.value_mm[static_cast<size_t>(first_step) + k] = value_of(scan, k);
    }
    return turn;
}

void LogSource::begin(const ale_scan_t &scan)
{
    if (scan.own_bearings) {
        throw std::runtime_error(path_ +
                                 ": its points lie on no grid, as those of a scanner of a whole turn do, "
                                 "and SCIP cannot say that: ale-replay reads it");
    }
    const Survey survey(path_);
    scanner_ = scanner_of(scan);
    const int32_t first_step = urg_first_step(scan).value_or(scanner_.first_step);
    scanner_.recorded = recorded_as(scan, first_step, survey);
    const auto order_us = static_cast<int64_t>(static_cast<double>(distance_host_us) * speed_);
    distance_us_ = std::min(std::max(order_us, distance_least_us), survey.mean_gap_us() / 3);
    timeline_.begin(scan.stamp_us, -ale_scan_beam_offset_us(&scan, -first_step));
}

void LogSource::take_scan(const ale_scan_t &scan)
{
    const Timeline before = timeline_;
    const bool is_first = scans_ == 0;
    if (is_first) {
        begin(scan);
    }
    const int32_t first_step = urg_first_step(scan).value_or(scanner_.first_step);
    const int64_t known_after_us = scanner_.period_us() + reply_delay_us;
    Turn turn = turn_of(scan, first_step);
    turn.recorded_us = is_first ? timeline_.last_us() : timeline_.take(scan.stamp_us);
    const int64_t begun_us = turn.recorded_us + ale_scan_beam_offset_us(&scan, -first_step);
    send_odometry(is_first ? timeline_ : before, begun_us + known_after_us);
    last_due_us_ = std::max(begun_us + known_after_us, last_due_us_ + distance_us_);
    turn.start_us = last_due_us_ - known_after_us;
    scans_++;
    last_turn_ = turn;
    due_.push_back({last_due_us_, std::move(turn)});
}

/* What the log has between two scans goes out between them. Where the clock was set meanwhile, a sample
 * belongs to the scan that is nearer to it. */
void LogSource::send_odometry(const Timeline &before, int64_t scan_due_us)
{
    last_due_us_ += scans_ > 0 && !unplaced_.empty() ? distance_us_ : 0;
    for (const ale_odometry_t &sample : unplaced_) {
        const int64_t after_us = timeline_.at(sample.stamp_us);
        const int64_t before_us = before.at(sample.stamp_us);
        const bool is_before =
            std::llabs(before_us - before.last_us()) < std::llabs(after_us - timeline_.last_us());
        const OdometryReport report = {is_before ? before_us : after_us, pose_of(sample.pose)};
        last_due_us_ = std::max(std::min(report.stamp_us, scan_due_us), last_due_us_);
        due_.push_back({last_due_us_, report});
    }
    unplaced_.clear();
}

/* The log is over and the robot stands: its last scan again and again. */
void LogSource::stay()
{
    last_due_us_ += scanner_.period_us();
    last_turn_.number = scans_++;
    last_turn_.start_us += scanner_.period_us();
    last_turn_.recorded_us += scanner_.period_us();
    due_.push_back({last_due_us_, last_turn_});
}

std::optional<int64_t> LogSource::due_us()
{
    return due_.empty() ? std::nullopt : std::optional(due_.front().at_us);
}

Event LogSource::next()
{
    Event event = std::move(due_.front().event);
    due_.pop_front();
    read_ahead();
    return event;
}

} // namespace sim
