/* From ticks of two wheels to the pose of the point between them, by arcs:
 *
 *   WheelPath path({4096, 4096, 0.32});
 *   if (path.add(ticks, arrival_us)) send(path.stamp_us(), path.pose()); */
#ifndef ALE_ROBOT_ODOMETRY_WHEEL_PATH_H
#define ALE_ROBOT_ODOMETRY_WHEEL_PATH_H

#include <cstdint>
#include <optional>

#include "robot/odometry/tick_line.h"

namespace odometry
{

struct Wheels {
    double left_per_metre; /* ticks; negative: it counts backwards */
    double right_per_metre;
    double track_m; /* from wheel to wheel */
};

struct PathPose {
    double x_m = 0;
    double y_m = 0;
    double theta_rad = 0; /* grows with the turns */
};

class WheelPath
{
  public:
    explicit WheelPath(const Wheels &wheels) : wheels_(wheels)
    {
    }

    /* arrival_us: when the line came, on a clock of this machine that never steps. False: there is nothing to
     * tell. The pose stays where the board has started again, which is seen by a wheel faster than anything
     * or a board's clock that jumped. */
    bool add(const Ticks &ticks, int64_t arrival_us);

    const PathPose &pose() const
    {
        return pose_;
    }
    /* When the ticks were counted, on the clock of the arrivals: the board's clock tells the distances, the
     * line that was the least on its way the offset. */
    int64_t stamp_us() const
    {
        return board_us_ + offset_us_;
    }
    /* How often the board began again. */
    uint64_t starts() const
    {
        return starts_;
    }

  private:
    void begin(const Ticks &ticks, int64_t arrival_us);
    void move(double left_m, double right_m);

    Wheels wheels_;
    PathPose pose_;
    std::optional<Ticks> before_;
    int64_t board_us_ = 0;
    int64_t offset_us_ = 0;
    uint64_t starts_ = 0;
};

} // namespace odometry

#endif
