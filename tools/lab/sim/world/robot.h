/* A robot with two driven wheels: it takes up speed as its mass allows, and its wheels may slip. */
#ifndef ALE_LAB_SIM_ROBOT_H
#define ALE_LAB_SIM_ROBOT_H

#include "lab/sim/geometry.h"

namespace sim
{

/* Velocity, m/s forward and rad/s counter-clockwise. */
struct Twist {
    double v = 0;
    double w = 0;
};

struct RobotLimits {
    double speed = 0.5;             /* m/s */
    double turn_rate = 0.9;         /* rad/s */
    double acceleration = 0.5;      /* m/s^2 */
    double turn_acceleration = 3.0; /* rad/s^2 */
};

class Robot
{
  public:
    Robot(const Pose &start, const RobotLimits &limits) : pose_(start), limits_(limits)
    {
    }

    /* Drives for dt seconds towards the velocity asked for; the limits cut it. */
    void step(Twist asked, double dt);

    /* Something holds it there; its wheels go on turning. */
    void hold_at(const Pose &pose)
    {
        pose_ = pose;
    }

    const Pose &pose() const
    {
        return pose_;
    }
    const Twist &velocity() const
    {
        return velocity_;
    }

  private:
    Pose pose_;
    Twist velocity_;
    RobotLimits limits_;
};

} // namespace sim

#endif
