// lib/plan/follower.c drives a robot in double, with inertia and delay, to points around it.
#include <cmath>
#include <cstring>
#include <deque>

#include <gtest/gtest.h>

#include "lib/motion/convert.h"

extern "C" {
#include "plan/follower.h"
}

namespace
{

const ale_follower_t follower = {{400000, 30000, 500000, 250000, 100000}, {0, 0, 0}, 400000, 800000};

ale_scan_t free_scan()
{
    ale_scan_t scan = {};
    scan.beams = 682;
    scan.step_bam = 1 << 22;
    scan.first_bearing_bam = 0u - 340u * (1u << 22);
    scan.range_max_um = 5600000;
    std::memset(scan.flag, ALE_BEAM_NO_RETURN, sizeof scan.flag);
    return scan;
}

struct Arrival {
    double off;
    double farthest; // from the straight way, metres
    double seconds;
};

// Set points at 10 Hz that act 0.2 s late on a robot with 0.5 m/s^2 and 3 rad/s^2.
Arrival drive_to(double x, double y)
{
    const ale_scan_t scan = free_scan();
    reference::Pose pose = {0, 0, 0};
    double v = 0;
    double w = 0;
    std::deque<ale_velocity_t> delayed(2, ale_velocity_t{0, 0});
    Arrival arrival = {1e9, 0, 0};
    for (int step = 0; step < 300; step++) {
        const double left = std::hypot(x - pose[0], y - pose[1]);
        arrival.off = std::fmin(arrival.off, left);
        if (left < 0.02) {
            break;
        }
        const ale_point_t to = {convert::um(x), convert::um(y)};
        delayed.push_back(ale_follow(&follower, convert::pose(pose), to, convert::um(left), &scan));
        const ale_velocity_t asked = delayed.front();
        delayed.pop_front();
        for (int k = 0; k < 100; k++) {
            v += std::fmax(-5e-4, std::fmin(5e-4, asked.speed_um_s * 1e-6 - v));
            w += std::fmax(-3e-3, std::fmin(3e-3, asked.turn_urad_s * 1e-6 - w));
            pose = reference::compose(pose, {v * 1e-3, 0, w * 1e-3});
        }
        const double along = (pose[0] * x + pose[1] * y) / std::hypot(x, y);
        arrival.farthest = std::fmax(arrival.farthest,
                                     std::sqrt(std::fmax(0, pose.head<2>().squaredNorm() - along * along)));
        arrival.seconds += 0.1;
    }
    return arrival;
}

} // namespace

TEST(Follower, ArrivesFromEveryDirectionAndStaysNearTheStraightWay)
{
    for (int degrees = 0; degrees < 360; degrees += 20) {
        for (const double way : {0.1, 0.6, 2.0}) {
            const double a = degrees * reference::pi / 180;
            const Arrival arrival = drive_to(way * std::cos(a), way * std::sin(a));
            EXPECT_LT(arrival.off, 0.02) << degrees << " degrees, " << way << " m";
            EXPECT_LT(arrival.farthest, 0.12) << degrees << " degrees, " << way << " m";
            EXPECT_LT(arrival.seconds, 8 + way / 0.2) << degrees << " degrees, " << way << " m";
        }
    }
}

TEST(Follower, TurnsOnTheSpotTowardsWhatLiesBehind)
{
    const ale_scan_t scan = free_scan();
    const ale_velocity_t left = ale_follow(&follower, {0, 0, 0}, {-1000000, 100000}, 1000000, &scan);
    EXPECT_EQ(left.speed_um_s, 0);
    EXPECT_EQ(left.turn_urad_s, follower.turn_urad_s);
    const ale_velocity_t right = ale_follow(&follower, {0, 0, 0}, {-1000000, -100000}, 1000000, &scan);
    EXPECT_EQ(right.turn_urad_s, -follower.turn_urad_s);
}

TEST(Follower, NeverFasterThanItCanStopBeforeWhatItSees)
{
    ale_scan_t scan = free_scan();
    for (int k = 300; k < 380; k++) {
        ale_scan_set_range(&scan, static_cast<uint16_t>(k), 500000);
    }
    const ale_velocity_t velocity = ale_follow(&follower, {0, 0, 0}, {3000000, 0}, 3000000, &scan);
    EXPECT_GT(velocity.speed_um_s, 0);
    const double v = velocity.speed_um_s * 1e-6;
    EXPECT_LT(v * 0.25 + v * v, 0.5 - 0.23);
}
