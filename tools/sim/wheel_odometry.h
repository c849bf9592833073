/* What the wheels say of the way: wrong in scale by a few per cent, and turning by itself. */
#ifndef ALE_SIM_WHEEL_ODOMETRY_H
#define ALE_SIM_WHEEL_ODOMETRY_H

#include <cstdint>

#include "bench/random.hpp"
#include "sim/geometry.h"

namespace sim
{

/* Standard deviations; what is drawn once a run (scale errors) stays for the run. */
struct OdometryErrors {
    double scale = 0.03;
    double turn_scale = 0.03;
    double turn_per_metre = 0.035; /* radians: 2 degrees, a random walk over the way */
};

class WheelOdometry
{
  public:
    WheelOdometry(const OdometryErrors &errors, uint64_t seed);

    /* The wheels have rolled so far, metres and radians. */
    void roll(double forward, double turn);

    const Pose &pose() const
    {
        return pose_;
    }

  private:
    bench::Random random_;
    OdometryErrors errors_;
    double scale_;
    double turn_scale_;
    Pose pose_;
};

} // namespace sim

#endif
