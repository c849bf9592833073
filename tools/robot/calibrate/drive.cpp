#include "robot/calibrate/drive.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "common/command_line/wrong_use.h"
#include "common/log/log_reader.h"
#include "common/log/robot_config.h"
#include "common/offline/core_object.h"

extern "C" {
#include "motion/lag.h"
#include "motion/motion.h"
#include "motion/odometry.h"
#include "motion/timestamp_filter.h"
}

namespace mounting
{

namespace
{

constexpr double pi = 3.14159265358979323846;
constexpr double longest_gap = 2; /* seconds: no way is read between scans farther apart */

double seconds(int64_t us)
{
    return static_cast<double>(us) * 1e-6;
}

/* As a pose whose heading goes on from that of the one before. */
Pose pose_of(const ale_pose_t &pose, double heading_before)
{
    const double heading = static_cast<int32_t>(pose.theta_bam) * (pi / 2147483648.0);
    return {pose.x_um * 1e-6, pose.y_um * 1e-6,
            heading_before + std::remainder(heading - heading_before, 2 * pi)};
}

/* The map frame's velocity of a pose that is told in its own frame. */
Pose in_map(const LaserPose &p)
{
    const double c = std::cos(p.pose.z());
    const double s = std::sin(p.pose.z());
    return {c * p.velocity.x() - s * p.velocity.y(), s * p.velocity.x() + c * p.velocity.y(), p.velocity.z()};
}

/* Runs the log's scans through the tracker and its wheels past it. */
class Reader
{
  public:
    Reader(const std::string &path, const std::string &config);
    Drive read();

  private:
    void begin(const char *recorded_config);
    void take(const ale_log_event_t &event);
    void take_scan(const ale_scan_t &scan);
    void take_odometry(const ale_odometry_t &sample);

    std::string path_;
    ale::LogReader log_;
    ale::RobotOptions options_;
    ale_config_t config_{};
    ale::CoreObject<ale_pipeline_t> pipeline_;
    ale_timestamp_filter_t pace_{};
    ale_wheels_t buffer_{};
    ale_lag_t lag_{};
    int64_t instant_us_ = INT64_MIN;
    std::vector<LaserPose> laser_;
    std::vector<WheelPose> wheels_;
};

Reader::Reader(const std::string &path, const std::string &config) : path_(path), log_(path)
{
    options_.config = config;
    if (!log_.info().has_odometry) {
        throw std::runtime_error(path + ": there is no odometry in it");
    }
}

void Reader::begin(const char *recorded_config)
{
    config_ = ale::robot_config(options_, log_.info(), recorded_config);
    ale_pipeline_config_t alone = config_.pipeline;
    alone.sensor = ale_pose_t{};
    alone.use_odometry = false;
    pipeline_ = ale::core_object<ale_pipeline_t>(ale_pipeline_size());
    if (ale_pipeline_init(pipeline_.get(), &alone) < 0) {
        throw cli::WrongUse("the configuration has a value that the core refuses");
    }
    ale_timestamp_filter_init(&pace_);
    ale_wheels_init(&buffer_, alone.max_speed_mm_s, alone.max_turn_mrad_s);
    ale_lag_init(&lag_, alone.odometry_lag_us);
}

void Reader::take_scan(const ale_scan_t &scan)
{
    ale_estimate_t estimate;
    const ale_scan_t as_mounted = ale::mounted(scan, config_.reversed && log_.info().raw_device);
    ale_pipeline_scan(pipeline_.get(), &as_mounted, &estimate);
    instant_us_ = std::max(ale_timestamp_filter_instant(&pace_, scan.stamp_us), instant_us_ + 1);
    const double before = laser_.empty() ? 0 : laser_.back().pose.z();
    laser_.push_back(
        {seconds(instant_us_), pose_of(estimate.map, before),
         Pose(estimate.velocity_x_um_s, estimate.velocity_y_um_s, estimate.velocity_theta_urad_s) * 1e-6,
         estimate.state == ALE_STATE_GOOD && !estimate.predicted});
    const int64_t turn_urad_tick =
        static_cast<int64_t>(estimate.velocity_theta_urad_s) * ALE_TICK_US / 1000000;
    const ale_heading_t heading = {instant_us_, estimate.map.theta_bam, static_cast<int32_t>(turn_urad_tick)};
    ale_lag_add_heading(&lag_, &heading);
    ale_lag_update(&lag_, &buffer_);
}

void Reader::take_odometry(const ale_odometry_t &sample)
{
    ale_wheels_add(&buffer_, &sample);
    const double time = seconds(sample.stamp_us);
    if (wheels_.empty() || time > wheels_.back().time) {
        wheels_.push_back({time, pose_of(sample.pose, wheels_.empty() ? 0 : wheels_.back().pose.z())});
    }
}

void Reader::take(const ale_log_event_t &event)
{
    if (!pipeline_ && event.kind != ALE_LOG_COMMAND) {
        begin(event.kind == ALE_LOG_CONFIG ? event.text : nullptr);
    }
    if (event.kind == ALE_LOG_SCAN) {
        take_scan(event.scan);
    } else if (event.kind == ALE_LOG_ODOMETRY) {
        take_odometry(event.odometry);
    }
}

Drive Reader::read()
{
    constexpr size_t least_scans = 20;
    const auto event = std::make_unique<ale_log_event_t>();
    while (log_.next(*event)) {
        take(*event);
    }
    if (laser_.size() < least_scans) {
        throw std::runtime_error(path_ + ": " + std::to_string(laser_.size()) + " scans, at least " +
                                 std::to_string(least_scans) + " are needed");
    }
    return {Laser(std::move(laser_)), std::move(wheels_), seconds(lag_.lag_us),
            config_.pipeline.max_speed_mm_s * 1e-3, config_.pipeline.max_turn_mrad_s * 1e-3};
}

} // namespace

std::optional<Pose> Laser::at(double time) const
{
    const auto after = std::upper_bound(poses_.begin(), poses_.end(), time,
                                        [](double t, const LaserPose &p) { return t < p.time; });
    if (after == poses_.begin() || after == poses_.end()) {
        return std::nullopt;
    }
    const LaserPose &a = *(after - 1);
    const LaserPose &b = *after;
    const double gap = b.time - a.time;
    if (!a.good || !b.good || gap > longest_gap) {
        return std::nullopt;
    }
    const double u = (time - a.time) / gap;
    const double uu = u * u;
    const double uuu = uu * u;
    return a.pose + (3 * uu - 2 * uuu) * (b.pose - a.pose) + gap * (uuu - 2 * uu + u) * in_map(a) +
           gap * (uuu - uu) * in_map(b);
}

double Laser::period() const
{
    std::vector<double> gaps;
    for (size_t k = 1; k < poses_.size(); k++) {
        gaps.push_back(poses_[k].time - poses_[k - 1].time);
    }
    std::nth_element(gaps.begin(), gaps.begin() + static_cast<std::ptrdiff_t>(gaps.size() / 2), gaps.end());
    return gaps[gaps.size() / 2];
}

Drive read_drive(const std::string &log, const std::string &config)
{
    return std::make_unique<Reader>(log, config)->read();
}

} // namespace mounting
