#include "operator/console/wheel_watch.h"

#include <algorithm>
#include <cmath>

namespace console
{

namespace
{

constexpr double turn_rad = 2 * 3.14159265358979323846;
constexpr double us_per_s = 1e6;

/* Anybody may send: of two such times the difference is a number. */
bool is_time(int64_t utime)
{
    return utime >= 0 && utime < int64_t{1} << 60;
}

double turned(double from, double to)
{
    return std::remainder(to - from, turn_rad);
}

} // namespace

void WheelWatch::odometry(const ale::odometry_t &sample)
{
    if (!is_time(sample.utime)) {
        return;
    }
    if (!samples_.empty() && sample.utime <= samples_.back().utime) {
        samples_.clear();
    }
    samples_.push_back({sample.utime, static_cast<double>(sample.x), static_cast<double>(sample.y),
                        static_cast<double>(sample.theta)});
    if (samples_.size() > most_samples) {
        samples_.pop_front();
    }
}

void WheelWatch::pose(const ale::pose_t &pose)
{
    if (!is_time(pose.utime)) {
        return;
    }
    poses_.push_back(pose);
    if (poses_.size() > most_poses) {
        poses_.pop_front();
    }
}

/* On the straight line between the samples before and after. */
std::optional<WheelWatch::Place> WheelWatch::wheels_at(int64_t utime) const
{
    const auto after =
        std::lower_bound(samples_.begin(), samples_.end(), utime,
                         [](const Place &sample, int64_t time) { return sample.utime < time; });
    if (after != samples_.end() && after->utime == utime) {
        return *after;
    }
    if (after == samples_.begin() || after == samples_.end()) {
        return std::nullopt;
    }
    const Place &a = *(after - 1);
    const Place &b = *after;
    if (b.utime - a.utime > longest_us) {
        return std::nullopt;
    }
    const double part = static_cast<double>(utime - a.utime) / static_cast<double>(b.utime - a.utime);
    return Place{utime, a.x + part * (b.x - a.x), a.y + part * (b.y - a.y),
                 a.theta + part * turned(a.theta, b.theta)};
}

Speed WheelWatch::speed(const Place &from, const Place &to)
{
    const double seconds = static_cast<double>(to.utime - from.utime) / us_per_s;
    const double turn = turned(from.theta, to.theta);
    const double heading = from.theta + turn / 2;
    const double ahead = (to.x - from.x) * std::cos(heading) + (to.y - from.y) * std::sin(heading);
    return {ahead / seconds, turn / seconds};
}

std::optional<WheelWay> WheelWatch::next()
{
    while (!poses_.empty() && !samples_.empty() && poses_.front().utime <= samples_.back().utime) {
        const ale::pose_t pose = poses_.front();
        poses_.pop_front();
        const std::optional<Both> before = before_;
        const std::optional<Place> wheels = wheels_at(pose.utime);
        before_.reset();
        if (!wheels) {
            continue;
        }
        before_ = Both{*wheels,
                       {pose.utime, static_cast<double>(pose.x), static_cast<double>(pose.y),
                        static_cast<double>(pose.theta)}};
        const int64_t taken_us = before ? pose.utime - before->wheels.utime : 0;
        if (taken_us > 0 && taken_us <= longest_us) {
            return WheelWay{pose.utime, pose.scan, speed(before->wheels, before_->wheels),
                            speed(before->scans, before_->scans)};
        }
    }
    return std::nullopt;
}

} // namespace console
