// What wheels and scans say of the same piece of way, whatever comes first.
#include "operator/console/wheel_watch.h"

#include <cmath>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

using console::WheelWatch;
using console::WheelWay;

namespace
{

constexpr double radius_m = 2;
constexpr double turn_rad_s = 0.5;

/* On a circle, at that time; wheels that tell `scale` of the way. */
template <class Message> Message placed(int64_t utime, double scale = 1)
{
    const double angle = turn_rad_s * static_cast<double>(utime) * 1e-6;
    Message message{};
    message.utime = utime;
    message.x = static_cast<float>(scale * radius_m * std::sin(angle));
    message.y = static_cast<float>(scale * radius_m * (1 - std::cos(angle)));
    message.theta = static_cast<float>(std::remainder(angle, 2 * M_PI));
    return message;
}

ale::pose_t pose_at(int64_t utime, int32_t scan)
{
    auto pose = placed<ale::pose_t>(utime);
    pose.scan = scan;
    return pose;
}

std::vector<WheelWay> all_of(WheelWatch &watch)
{
    std::vector<WheelWay> ways;
    while (const auto way = watch.next()) {
        ways.push_back(*way);
    }
    return ways;
}

} // namespace

/* Every 20 ms, which no scan's stamp falls on; through half a turn, where headings jump. */
TEST(WheelWatch, BothAreOfTheSamePieceOfWay)
{
    for (const int64_t late_us : {0, 70000, 300000}) {
        WheelWatch watch;
        std::vector<WheelWay> ways;
        int32_t scan = 0;
        for (int64_t now = 0; now < 15000000; now += 20000) {
            watch.odometry(placed<ale::odometry_t>(now, 1.1));
            if (now % 100000 == 0 && now >= late_us) {
                watch.pose(pose_at(now - late_us + 7000, scan++));
            }
            for (const WheelWay &way : all_of(watch)) {
                ways.push_back(way);
            }
        }
        EXPECT_GE(ways.size(), static_cast<size_t>(scan) - 2);
        for (size_t k = 0; k < ways.size(); k++) {
            EXPECT_EQ(ways[k].scan, static_cast<int32_t>(k) + 1);
            EXPECT_EQ(ways[k].utime - ways[0].utime, 100000 * static_cast<int64_t>(k));
            EXPECT_NEAR(ways[k].scans.ahead_m_s, radius_m * turn_rad_s, 1e-3);
            EXPECT_NEAR(ways[k].scans.turn_rad_s, turn_rad_s, 1e-4);
            EXPECT_NEAR(ways[k].wheels.ahead_m_s, 1.1 * radius_m * turn_rad_s, 3e-3);
            EXPECT_NEAR(ways[k].wheels.turn_rad_s, turn_rad_s, 1e-3);
        }
    }
}

TEST(WheelWatch, WhoDrivesBackwardsHasANegativeSpeed)
{
    WheelWatch watch;
    for (int k = 0; k < 3; k++) {
        ale::odometry_t sample{};
        sample.utime = k * 100000;
        sample.x = -0.05F * static_cast<float>(k);
        ale::pose_t pose{};
        pose.utime = sample.utime;
        watch.odometry(sample);
        watch.pose(pose);
    }
    const std::vector<WheelWay> ways = all_of(watch);
    ASSERT_EQ(ways.size(), 2U);
    EXPECT_NEAR(ways[1].wheels.ahead_m_s, -0.5, 1e-6);
    EXPECT_EQ(ways[1].scans.ahead_m_s, 0);
}

TEST(WheelWatch, NothingIsSaidAcrossAGapOrWhereTimesGoBack)
{
    WheelWatch watch;
    const auto both = [&watch](int64_t utime) {
        watch.odometry(placed<ale::odometry_t>(utime));
        watch.pose(pose_at(utime, 0));
        return all_of(watch).size();
    };
    EXPECT_EQ(both(1000000), 0U);
    EXPECT_EQ(both(1100000), 1U);
    EXPECT_EQ(both(4000000), 0U) << "a gap in both";
    EXPECT_EQ(both(4100000), 1U);
    watch.pose(pose_at(4200000, 0));
    watch.odometry(placed<ale::odometry_t>(6000000));
    EXPECT_EQ(all_of(watch).size(), 0U) << "a gap in the odometry";
    EXPECT_EQ(both(500000), 0U);
    EXPECT_EQ(both(600000), 1U);
}

TEST(WheelWatch, TimesOutOfThisWorldAreLeftOut)
{
    WheelWatch watch;
    for (const int64_t utime :
         {INT64_MIN, int64_t{-1}, int64_t{1} << 61, INT64_MAX, int64_t{0}, int64_t{100000}}) {
        watch.odometry(placed<ale::odometry_t>(utime));
        watch.pose(pose_at(utime, 0));
    }
    EXPECT_EQ(all_of(watch).size(), 1U);
}

TEST(WheelWatch, WithoutTheOneTheOtherWaitsInBoundedMemory)
{
    WheelWatch watch;
    for (int k = 0; k < 100000; k++) {
        watch.pose(pose_at(k * int64_t{100000}, k));
    }
    EXPECT_EQ(all_of(watch).size(), 0U);
    for (int k = 99000; k < 100000; k++) {
        watch.odometry(placed<ale::odometry_t>(k * int64_t{100000}));
    }
    EXPECT_EQ(all_of(watch).size(), 99U) << "of the newest hundred poses";
}
