#include "lab/sim/world/journey.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "lab/sim/world/route.h"

namespace sim
{

namespace
{

constexpr int64_t step_us = 1000;
constexpr double step_s = 0.001;
constexpr double slip_memory_s = 0.5; /* the ground changes under the wheels about so often */
constexpr uint64_t slip_stream = 0x511b;

} // namespace

Pilot route_pilot(const World &world, const RobotLimits &limits)
{
    auto route = std::make_shared<Route>(Point{world.start.x, world.start.y}, world.via, limits);
    return [route](const Robot &robot, int64_t) -> std::optional<Twist> {
        const Twist twist = route->command(robot);
        if (route->finished()) {
            return std::nullopt;
        }
        return twist;
    };
}

Journey::Journey(const World &world, const Options &options, Pilot pilot)
    : world_(world), options_(options), pilot_(std::move(pilot)), robot_(world.start, options.limits),
      odometry_(options.odometry, options.seed), slip_random_(options.seed ^ slip_stream)
{
    samples_.push_back({robot_.pose(), odometry_.pose()});
}

bool Journey::collides() const
{
    const Point centre = {robot_.pose().x, robot_.pose().y};
    const double radius = options_.collision_radius;
    const auto beyond = [radius](double at, double a, double b) {
        return at < std::min(a, b) - radius || at > std::max(a, b) + radius;
    };
    return std::any_of(world_.walls.begin(), world_.walls.end(), [&](const Wall &wall) {
        return !beyond(centre.x, wall.a.x, wall.b.x) && !beyond(centre.y, wall.a.y, wall.b.y) &&
               distance_to_wall(centre, wall) < radius;
    });
}

void Journey::step()
{
    const int64_t now_us = static_cast<int64_t>(samples_.size() - 1) * step_us;
    const std::optional<Twist> asked = pilot_(robot_, now_us);
    if (!asked && !end_us_) {
        end_us_ = now_us;
    }
    const Pose before = robot_.pose();
    robot_.step(asked.value_or(Twist{}), step_s);
    const Twist velocity = robot_.velocity();
    if (options_.slip > 0) {
        const double keep = std::exp(-step_s / slip_memory_s);
        slip_now_ = keep * slip_now_ + std::sqrt(1 - keep * keep) * options_.slip * slip_random_.normal();
    }
    const double grip =
        1 / std::max(0.5, 1 - std::fabs(slip_now_)); /* wheels turn more than the robot moves */
    odometry_.roll(velocity.v * step_s * grip, velocity.w * step_s * grip);
    const bool touching = options_.collision_radius > 0 && collides();
    if (touching) {
        robot_.hold_at({before.x, before.y, robot_.pose().theta});
    }
    collisions_ += touching && !touching_ ? 1 : 0;
    touching_ = touching;
    samples_.push_back({robot_.pose(), odometry_.pose()});
}

void Journey::extend_to(int64_t play_us)
{
    while (static_cast<int64_t>(samples_.size() - 1) * step_us <= play_us) {
        step();
    }
}

Pose Journey::at(int64_t play_us, Pose Sample::*which)
{
    const int64_t from_start = std::max<int64_t>(0, play_us);
    extend_to(from_start);
    const auto k = static_cast<size_t>(from_start / step_us);
    const double u = static_cast<double>(from_start % step_us) / step_us;
    return interpolate(samples_[k].*which, samples_[k + 1].*which, u);
}

Pose Journey::truth(int64_t play_us)
{
    return at(play_us, &Sample::truth);
}

Pose Journey::wheels(int64_t play_us)
{
    return at(play_us, &Sample::wheels);
}

} // namespace sim
