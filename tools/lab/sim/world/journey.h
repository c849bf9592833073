/* The robot's drive through a world: true pose and wheel odometry at any time, worked out in steps of a
 * millisecond as far as somebody asks. The same seed and commands give the same journey. */
#ifndef ALE_LAB_SIM_JOURNEY_H
#define ALE_LAB_SIM_JOURNEY_H

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "lab/sim/world/robot.h"
#include "lab/sim/world/wheel_odometry.h"
#include "lab/sim/world/world.h"

namespace sim
{

/* Slip of a robot that is driven from outside. */
constexpr double driven_slip = 0.03;

/* Tells what to drive at a time of play; nothing: the way is over. */
using Pilot = std::function<std::optional<Twist>(const Robot &, int64_t play_us)>;

/* A pilot that follows the via points of the world. */
Pilot route_pilot(const World &world, const RobotLimits &limits);

class Journey
{
  public:
    struct Options {
        RobotLimits limits;
        OdometryErrors odometry;
        uint64_t seed = 1;
        double slip = 0;             /* standard deviation of the part of the way that the wheels lose */
        double collision_radius = 0; /* metres; 0: the robot passes through walls */
    };

    Journey(const World &world, const Options &options, Pilot pilot);

    Pose truth(int64_t play_us);
    Pose wheels(int64_t play_us);

    /* When the way was over; nothing while it is not. */
    std::optional<int64_t> end_us() const
    {
        return end_us_;
    }
    uint32_t collisions() const
    {
        return collisions_;
    }

  private:
    struct Sample {
        Pose truth;
        Pose wheels;
    };

    void extend_to(int64_t play_us);
    void step();
    bool collides() const;
    Pose at(int64_t play_us, Pose Sample::*which);

    const World &world_;
    Options options_;
    Pilot pilot_;
    Robot robot_;
    WheelOdometry odometry_;
    bench::Random slip_random_;
    double slip_now_ = 0;
    std::vector<Sample> samples_;
    std::optional<int64_t> end_us_;
    bool touching_ = false;
    uint32_t collisions_ = 0;
};

} // namespace sim

#endif
