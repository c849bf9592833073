/* The way along the via points: a carrot runs along the lines between them, always a little ahead of the
 * robot; the robot heads for the carrot, slower the more it has to turn. */
#ifndef ALE_LAB_SIM_ROUTE_H
#define ALE_LAB_SIM_ROUTE_H

#include <vector>

#include "lab/sim/world/robot.h"

namespace sim
{

class Route
{
  public:
    Route(Point start, const std::vector<Point> &via, const RobotLimits &limits);

    /* What to drive now. Call it along the way, in small steps. */
    Twist command(const Robot &robot);

    bool finished() const
    {
        return finished_;
    }

  private:
    Point carrot() const;
    double beyond_carrot() const;
    void move_carrot(Point robot);

    std::vector<Point> points_;
    RobotLimits limits_;
    size_t leg_ = 0;       /* from points_[leg_] to the next */
    double along_leg_ = 0; /* metres */
    bool finished_ = false;
};

} // namespace sim

#endif
