#include "lab/sim/world/route.h"

#include <algorithm>

namespace sim
{

namespace
{

constexpr double lead = 0.2;           /* the carrot's distance from the robot, metres */
constexpr double carrot_step = 0.005;  /* metres */
constexpr double arrived = 0.02;       /* metres */
constexpr double turn_gain = 4;        /* rad/s per radian of heading error */
constexpr double widest_driving = 0.9; /* heading error from which the robot turns on the spot, radians */

} // namespace

Route::Route(Point start, const std::vector<Point> &via, const RobotLimits &limits)
    : points_{start}, limits_(limits)
{
    for (const Point &p : via) {
        if (distance(points_.back(), p) > 0) {
            points_.push_back(p);
        }
    }
    finished_ = points_.size() < 2;
}

Point Route::carrot() const
{
    if (leg_ + 1 >= points_.size()) {
        return points_.back();
    }
    const Point &a = points_[leg_];
    const Point &b = points_[leg_ + 1];
    const double u = along_leg_ / distance(a, b);
    return {a.x + u * (b.x - a.x), a.y + u * (b.y - a.y)};
}

void Route::move_carrot(Point robot)
{
    while (leg_ + 1 < points_.size() && distance(carrot(), robot) < lead) {
        along_leg_ += carrot_step;
        if (along_leg_ >= distance(points_[leg_], points_[leg_ + 1])) {
            leg_++;
            along_leg_ = 0;
        }
    }
}

/* Length of the way from the carrot to the end. */
double Route::beyond_carrot() const
{
    double length = -along_leg_;
    for (size_t k = leg_; k + 1 < points_.size(); k++) {
        length += distance(points_[k], points_[k + 1]);
    }
    return length;
}

Twist Route::command(const Robot &robot)
{
    const Point at = {robot.pose().x, robot.pose().y};
    move_carrot(at);
    const Point goal = carrot();
    const bool last = leg_ + 1 >= points_.size();
    const double ahead = distance(goal, at);
    const double error = wrapped(std::atan2(goal.y - at.y, goal.x - at.x) - robot.pose().theta);
    finished_ = finished_ || (last && (ahead < arrived || std::fabs(error) > pi / 2));
    if (finished_) {
        return {};
    }
    const double straight = std::max(0.0, 1 - std::fabs(error) / widest_driving);
    const double braking = std::sqrt(2 * limits_.acceleration * (ahead + beyond_carrot()));
    return {std::min(limits_.speed * straight, braking),
            std::clamp(turn_gain * error, -limits_.turn_rate, limits_.turn_rate)};
}

} // namespace sim
