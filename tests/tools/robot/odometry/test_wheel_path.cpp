/* Ticks to pose and stamp: lines taken apart, counters that wrap, lines that are late, boards that begin
 * again. */
#include "robot/odometry/wheel_path.h"

#include <cmath>
#include <cstdio>
#include <gtest/gtest.h>
#include <string>

extern "C" {
#include "motor/line_receiver.h"
}

namespace
{

using odometry::Ticks;
using odometry::WheelPath;

constexpr double pi = 3.14159265358979323846;
constexpr odometry::Wheels wheels = {1000, 1000, 0.5};

std::string line_of(const std::string &body)
{
    char sum[8];
    std::snprintf(sum, sizeof sum, "*%04X", ale_motor_crc(body.data(), body.size()));
    return "$" + body + sum;
}

TEST(TickLine, IsTakenApart)
{
    const auto ticks = odometry::ticks_of(line_of("TICKS,1042,-17,4294967295"));
    ASSERT_TRUE(ticks);
    EXPECT_EQ(ticks->left, 1042U);
    EXPECT_EQ(static_cast<int32_t>(ticks->right), -17);
    EXPECT_EQ(ticks->micros, 4294967295U);
}

TEST(TickLine, WhatIsNoneIsRefused)
{
    const std::string right = line_of("TICKS,1,2,3");
    ASSERT_TRUE(odometry::ticks_of(right));
    for (size_t k = 0; k < right.size(); k++) {
        std::string wrong = right;
        wrong[k] = wrong[k] == '7' ? '8' : '7';
        EXPECT_FALSE(odometry::ticks_of(wrong)) << wrong;
        EXPECT_FALSE(odometry::ticks_of(right.substr(0, k))) << right.substr(0, k);
    }
    for (const char *body : {"TICKS,1,2", "TICKS,1,2,3,4", "TICKS,,2,3", "TICKS,1,2,x", "ALE,1,2,3"}) {
        EXPECT_FALSE(odometry::ticks_of(line_of(body))) << body;
    }
}

TEST(TickLine, LinesComeOutOfAnyBytesAndNoiseIsCounted)
{
    odometry::TickLines lines;
    int found = 0;
    const std::string bytes = "\xff\x01 half a li\r\n" + line_of("TICKS,1,2,3") + "\r\n" +
                              std::string(1000, 'x') + "\n" + line_of("TICKS,4,5,6") + "\n";
    for (const char byte : bytes) {
        found += lines.take(byte).has_value();
    }
    EXPECT_EQ(found, 2);
    EXPECT_EQ(lines.taken(), 2U);
    EXPECT_GE(lines.refused(), 2U);
}

TEST(WheelPath, AQuarterOfACircle)
{
    WheelPath path(wheels);
    path.add({0, 0, 0}, 0);
    /* Radius 1 m of the middle: the wheels go 0.75 and 1.25 m times a quarter turn. */
    for (uint32_t k = 1; k <= 100; k++) {
        path.add({static_cast<uint32_t>(std::lround(750 * pi / 2 * k / 100)),
                  static_cast<uint32_t>(std::lround(1250 * pi / 2 * k / 100)), k * 20000},
                 k * 20000);
    }
    EXPECT_NEAR(path.pose().x_m, 1, 0.003);
    EXPECT_NEAR(path.pose().y_m, 1, 0.003);
    EXPECT_NEAR(path.pose().theta_rad, pi / 2, 0.003);
}

TEST(WheelPath, CountersAndClockWrapAndLostLinesLoseNoWay)
{
    WheelPath path(wheels);
    path.add({0xffffff00U, 0x7fffff00U, 0xffff0000U}, 1000);
    path.add({0xffffff00U + 1000, 0x7fffff00U + 1000, 0xffff0000U + 1000000}, 1001000);
    EXPECT_NEAR(path.pose().x_m, 1, 1e-9);
    EXPECT_EQ(path.stamp_us(), 1001000);
    EXPECT_EQ(path.starts(), 1U);
}

TEST(WheelPath, AWheelThatCountsBackwardsIsTurnedRound)
{
    WheelPath path({-1000, 1000, 0.5});
    path.add({0, 0, 0}, 0);
    path.add({static_cast<uint32_t>(-100), 100, 100000}, 100000);
    EXPECT_NEAR(path.pose().x_m, 0.1, 1e-9);
    EXPECT_NEAR(path.pose().theta_rad, 0, 1e-9);
}

TEST(WheelPath, StampsAreTheBoardsWhateverTheWayOfTheLineTakes)
{
    WheelPath path(wheels);
    int64_t before = 0;
    for (uint32_t k = 0; k < 1000; k++) {
        const int64_t counted = int64_t{k} * 20000;
        const int64_t on_the_way = 1000 + (k % 7) * 3000;
        path.add({k, k, static_cast<uint32_t>(counted) + 77}, counted + on_the_way);
        if (k > 20) {
            EXPECT_NEAR(static_cast<double>(path.stamp_us() - counted), 1000, 60);
            EXPECT_GT(path.stamp_us(), before);
        }
        before = path.stamp_us();
    }
}

TEST(WheelPath, ABoardThatBeginsAgainGoesOnFromThePoseThatItHad)
{
    WheelPath path(wheels);
    path.add({0, 0, 1000000}, 0);
    path.add({1000, 1000, 2000000}, 1000000);
    const int64_t before = path.stamp_us();
    EXPECT_TRUE(path.add({5, 5, 30000}, 1500000)); /* its clock goes back */
    EXPECT_NEAR(path.pose().x_m, 1, 1e-9);
    EXPECT_GT(path.stamp_us(), before);
    path.add({105, 105, 130000}, 1600000);
    EXPECT_NEAR(path.pose().x_m, 1.1, 1e-9);
    EXPECT_TRUE(path.add({900000, 105, 230000}, 1700000)); /* 900 m in 0.1 s */
    EXPECT_NEAR(path.pose().x_m, 1.1, 1e-9);
    EXPECT_EQ(path.starts(), 3U);
}

TEST(WheelPath, ALineThatIsSaidTwiceTellsNothing)
{
    WheelPath path(wheels);
    path.add({0, 0, 5}, 0);
    EXPECT_FALSE(path.add({0, 0, 5}, 10));
}

} // namespace
