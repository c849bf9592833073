/* What the wheels say of the way from one scan to the next, beside what the scans say of it: both between the
 * same two instants.
 *
 *   WheelWatch watch;
 *   watch.odometry(sample);                  as they come, in their order
 *   watch.pose(pose);
 *   while (const auto way = watch.next()) ...
 *
 * Of a scan it is known once odometry of a later time has come. Bounded memory; where times go back, or more
 * than a second lies between, it begins anew. */
#ifndef CONSOLE_WHEEL_WATCH_H
#define CONSOLE_WHEEL_WATCH_H

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>

#include "ale/odometry_t.hpp"
#include "ale/pose_t.hpp"

namespace console
{

/* Mean of a piece of way: along the robot's own heading, backwards negative; counter-clockwise. */
struct Speed {
    double ahead_m_s;
    double turn_rad_s;
};

struct WheelWay {
    int64_t utime; /* of the scan at its end */
    int32_t scan;
    Speed wheels;
    Speed scans; /* by the smooth poses */
};

class WheelWatch
{
  public:
    void odometry(const ale::odometry_t &sample);
    void pose(const ale::pose_t &pose);
    std::optional<WheelWay> next();

  private:
    static constexpr int64_t longest_us = 1000000;
    static constexpr size_t most_samples = 1000;
    static constexpr size_t most_poses = 100;

    struct Place {
        int64_t utime;
        double x;
        double y;
        double theta;
    };
    struct Both {
        Place wheels;
        Place scans;
    };

    std::optional<Place> wheels_at(int64_t utime) const;
    static Speed speed(const Place &from, const Place &to);

    std::deque<Place> samples_;
    std::deque<ale::pose_t> poses_; /* whose odometry has not come yet */
    std::optional<Both> before_;
};

} // namespace console

#endif
