#include "robot/odometry/wheel_path.h"

#include <algorithm>
#include <cmath>

namespace odometry
{

namespace
{

constexpr double fastest_m_s = 10;
constexpr uint32_t longest_gap_us =
    5000000;                           /* ticks go on beyond lines that are lost, the board's clock wraps */
constexpr int64_t drift_per_us = 5000; /* the board's clock may be slower by one part in this */

int32_t difference(uint32_t a, uint32_t b)
{
    return static_cast<int32_t>(a - b);
}

} // namespace

void WheelPath::begin(const Ticks &ticks, int64_t arrival_us)
{
    before_ = ticks;
    offset_us_ = arrival_us - board_us_;
    starts_++;
}

void WheelPath::move(double left_m, double right_m)
{
    const double way = (left_m + right_m) / 2;
    const double turn = (right_m - left_m) / wheels_.track_m;
    const double half = turn / 2;
    const double chord = std::abs(half) < 1e-6 ? way : way * std::sin(half) / half;
    pose_.x_m += chord * std::cos(pose_.theta_rad + half);
    pose_.y_m += chord * std::sin(pose_.theta_rad + half);
    pose_.theta_rad += turn;
}

bool WheelPath::add(const Ticks &ticks, int64_t arrival_us)
{
    if (!before_) {
        begin(ticks, arrival_us);
        return true;
    }
    const uint32_t elapsed_us = ticks.micros - before_->micros;
    const double left_m = difference(ticks.left, before_->left) / wheels_.left_per_metre;
    const double right_m = difference(ticks.right, before_->right) / wheels_.right_per_metre;
    if (elapsed_us == 0) {
        return false;
    }
    if (elapsed_us > longest_gap_us ||
        std::max(std::abs(left_m), std::abs(right_m)) > fastest_m_s * elapsed_us * 1e-6) {
        board_us_++; /* stamps never stand */
        begin(ticks, arrival_us);
        return true;
    }
    move(left_m, right_m);
    before_ = ticks;
    board_us_ += elapsed_us;
    offset_us_ = std::min(offset_us_ + elapsed_us / drift_per_us + 1, arrival_us - board_us_);
    return true;
}

} // namespace odometry
