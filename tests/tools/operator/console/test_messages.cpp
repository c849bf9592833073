// The JSON that the page gets.
#include "operator/console/messages.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

using nlohmann::json;

TEST(Messages, WhatIsNoNumberLeavesAsNull)
{
    ale::pose_t pose{};
    pose.cov[4] = std::numeric_limits<float>::quiet_NaN();
    pose.observability[0] = std::numeric_limits<float>::infinity();
    const json message = json::parse(console::pose_message(pose));
    EXPECT_TRUE(message["cov"][4].is_null());
    EXPECT_TRUE(message["observability"][0].is_null());
    EXPECT_EQ(message["cov"][0], 0.0);
}

TEST(Messages, SmallVariancesKeepTheirDigits)
{
    ale::pose_t pose{};
    pose.cov[0] = 1.2345678e-9F;
    pose.cov[4] = -3.5e-7F;
    const json message = json::parse(console::pose_message(pose));
    EXPECT_NEAR(message["cov"][0].get<double>(), 1.2345678e-9, 1e-15);
    EXPECT_NEAR(message["cov"][4].get<double>(), -3.5e-7, 1e-13);
}

TEST(Messages, ABigMapStaysSmallOnTheWire)
{
    ale::map_t map{};
    map.lines.resize(100);
    for (auto &line : map.lines) {
        line.x1 = line.y1 = line.x2 = line.y2 = 1.1F / 3;
    }
    EXPECT_LT(console::map_message(map).size(), 100U * 80);
}

TEST(Messages, LatencyIsFromTheLastByteToTheSending)
{
    ale::pose_t pose{};
    pose.utime = 1000000;
    pose.age_us = 70000;
    pose.arrival_utime = 1000000 + 68600;
    EXPECT_EQ(json::parse(console::pose_message(pose))["latency_us"], 1400);
    pose.arrival_utime = 0;
    EXPECT_TRUE(json::parse(console::pose_message(pose))["latency_us"].is_null());
}

TEST(Messages, ABeamWithACodeHasNoRangeAndCodesAreCounted)
{
    ale::scan_t scan{};
    scan.range_unit_mm = 1;
    scan.range_mm = {500, 500, 0, 700};
    scan.codes = {0, 7, 0x81, 7};
    scan.num_ranges = scan.num_codes = 4;
    const json message = json::parse(console::scan_message(scan));
    EXPECT_EQ(message["ranges_mm"], json({500, 0, 0, 0}));
    EXPECT_EQ(message["codes"], json({{7, 2}, {0x81, 1}}));
    EXPECT_EQ(message["beams"], json({1, 4}));
    scan.utime = 5;
    EXPECT_EQ(json::parse(console::scan_brief(scan)),
              json({{"type", "scan"}, {"utime", 5}, {"beams", {1, 4}}}));
}

TEST(Messages, OfFeaturesTheBriefHasHowMany)
{
    ale::features_t features{};
    features.utime = 6;
    features.lines.resize(3);
    features.corners.resize(1);
    EXPECT_EQ(json::parse(console::features_message(features))["found"], json({3, 1}));
    EXPECT_EQ(json::parse(console::features_brief(features)),
              json({{"type", "features"}, {"utime", 6}, {"found", {3, 1}}}));
}

TEST(Messages, WheelsStandBesideTheScans)
{
    const console::WheelWay way = {7, 8, {0.25, -0.5}, {0.24, -0.48}};
    EXPECT_EQ(json::parse(console::odometry_message(way)), json({{"type", "odometry"},
                                                                 {"utime", 7},
                                                                 {"scan", 8},
                                                                 {"wheels", {0.25, -0.5}},
                                                                 {"scans", {0.24, -0.48}}}));
}

TEST(Messages, ARangeUnitScalesTheRanges)
{
    ale::scan_t scan{};
    scan.range_unit_mm = 4;
    scan.range_mm = {20000};
    scan.codes = {0};
    EXPECT_EQ(json::parse(console::scan_message(scan))["ranges_mm"][0], 80000);
}

TEST(Messages, TextThatIsNotUtf8DoesNotSpoilTheStatus)
{
    ale::status_t status{};
    status.device = "URG\xff\xfe";
    status.counter_name = {"one", "two"};
    status.counter_value = {1}; // fewer values than names
    const json message = json::parse(console::status_message(status));
    EXPECT_EQ(message["device"].get<std::string>().substr(0, 3), "URG");
    EXPECT_EQ(message["counters"].size(), 1U);
}

TEST(Messages, AJumpOfTheTrailIsAGap)
{
    const console::TrailPiece piece{1, 0, {{0, 0, true}, {1, 2, false}, {9, 9, true}}};
    const json message = json::parse(console::trail_message(piece));
    EXPECT_EQ(message["points"], json({nullptr, nullptr, 0.0, 0.0, 1.0, 2.0, nullptr, nullptr, 9.0, 9.0}));
    EXPECT_TRUE(message["anew"]);
}
