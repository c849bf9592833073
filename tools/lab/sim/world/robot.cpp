#include "lab/sim/world/robot.h"

#include <algorithm>

namespace sim
{

namespace
{

double approach(double now, double asked, double step)
{
    return now + std::clamp(asked - now, -step, step);
}

} // namespace

void Robot::step(Twist asked, double dt)
{
    const double v = std::clamp(asked.v, -limits_.speed, limits_.speed);
    const double w = std::clamp(asked.w, -limits_.turn_rate, limits_.turn_rate);
    velocity_.v = approach(velocity_.v, v, limits_.acceleration * dt);
    velocity_.w = approach(velocity_.w, w, limits_.turn_acceleration * dt);
    const double forward = velocity_.v * dt;
    const double turn = velocity_.w * dt;
    const double heading = pose_.theta + turn / 2;
    pose_ = {pose_.x + forward * std::cos(heading), pose_.y + forward * std::sin(heading),
             pose_.theta + turn};
}

} // namespace sim
