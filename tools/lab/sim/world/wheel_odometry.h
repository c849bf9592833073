/* What the wheels say of the way: wrong in scale by a few per cent, and turning by itself. */
#ifndef ALE_LAB_SIM_WHEEL_ODOMETRY_H
#define ALE_LAB_SIM_WHEEL_ODOMETRY_H

#include <cstdint>
#include <optional>

#include "lab/bench/random.hpp"
#include "lab/sim/geometry.h"

namespace sim
{

/* What wheels count of a metre driven, of a radian turned, and the radians they count for a metre counted. */
struct WheelGains {
    double way = 1;
    double turn = 1;
    double turn_per_metre = 0;
};

/* Standard deviations; what is drawn once a run (scale errors) stays for the run. */
struct OdometryErrors {
    double scale = 0.03;
    double turn_scale = 0.03;
    double turn_per_metre = 0.035;                  /* radians: 2 degrees, a random walk over the way */
    std::optional<WheelGains> gains = std::nullopt; /* instead of drawn ones */
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
    WheelGains gains_;
    Pose pose_;
};

} // namespace sim

#endif
