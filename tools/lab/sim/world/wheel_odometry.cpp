#include "lab/sim/world/wheel_odometry.h"

namespace sim
{

namespace
{

constexpr uint64_t own_stream = 0x0d0e7e4;

} // namespace

WheelOdometry::WheelOdometry(const OdometryErrors &errors, uint64_t seed)
    : random_(seed ^ own_stream), errors_(errors)
{
    gains_.way = 1 + errors.scale * random_.normal();
    gains_.turn = 1 + errors.turn_scale * random_.normal();
    gains_ = errors.gains.value_or(gains_);
}

void WheelOdometry::roll(double forward, double turn)
{
    const double walk = errors_.turn_per_metre * std::sqrt(std::fabs(forward)) * random_.normal();
    const double measured = forward * gains_.way;
    const double turned = turn * gains_.turn + measured * gains_.turn_per_metre + walk;
    const double heading = pose_.theta + turned / 2;
    pose_ = {pose_.x + measured * std::cos(heading), pose_.y + measured * std::sin(heading),
             pose_.theta + turned};
}

} // namespace sim
