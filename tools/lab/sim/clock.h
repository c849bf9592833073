/* Time of the simulation: the host's, times the speed. Microseconds since the program's start. */
#ifndef ALE_LAB_SIM_CLOCK_H
#define ALE_LAB_SIM_CLOCK_H

#include <cmath>
#include <cstdint>

#include <time.h>

namespace sim
{

class Clock
{
  public:
    /* The speed counts in millionths, as in the firmware. */
    explicit Clock(double speed)
        : speed_(std::round(speed * 1e6) / 1e6L), start_us_(read(CLOCK_MONOTONIC)),
          start_utime_us_(read(CLOCK_REALTIME))
    {
    }

    int64_t now_us() const
    {
        return scaled(host_us());
    }
    int64_t host_us() const
    {
        return read(CLOCK_MONOTONIC) - start_us_;
    }
    /* How long the host has to wait for that much simulated time. */
    int64_t host_duration_us(int64_t simulated_us) const
    {
        return static_cast<int64_t>(std::ceil(static_cast<long double>(simulated_us) / speed_));
    }
    /* What messages carry: the time of day, times the speed. A receiver that counts the same way agrees
     * without any exchange. */
    int64_t utime(int64_t simulated_us) const
    {
        return scaled(start_utime_us_) + simulated_us;
    }

  private:
    static int64_t read(clockid_t clock)
    {
        timespec t = {};
        clock_gettime(clock, &t);
        return static_cast<int64_t>(t.tv_sec) * 1000000 + t.tv_nsec / 1000;
    }
    int64_t scaled(int64_t us) const
    {
        return static_cast<int64_t>(std::llround(static_cast<long double>(us) * speed_));
    }

    long double speed_;
    int64_t start_us_;
    int64_t start_utime_us_;
};

} // namespace sim

#endif
