// lib/base/turn.c: points of their own bearings become a scan, none lost, none moved.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <random>
#include <vector>

extern "C" {
#include "base/trig.h"
#include "base/turn.h"
}

namespace
{

struct Point {
    double bearing; // turns
    int32_t range_um;
    ale_beam_flag_t flag = ALE_BEAM_VALID;
};

uint32_t bam(double turns)
{
    return static_cast<uint32_t>(static_cast<int64_t>(std::llround(std::ldexp(turns, 32))));
}

std::unique_ptr<ale_scan_t> scan_of(const std::vector<Point> &points,
                                    ale_turn_status_t expected = ALE_TURN_FINE, uint32_t *left_out = nullptr)
{
    auto turn = std::make_unique<ale_turn_t>();
    auto scan = std::make_unique<ale_scan_t>();
    scan->range_min_um = 20000;
    scan->range_max_um = 12000000;
    ale_turn_begin(turn.get());
    for (const Point &p : points) {
        ale_turn_add(turn.get(), bam(p.bearing), p.range_um, p.flag);
    }
    turn->first_us = 1000000;
    turn->last_us = 1100000;
    EXPECT_EQ(ale_turn_to_scan(turn.get(), scan.get()), expected);
    if (left_out) {
        *left_out = turn->left_out;
    }
    return scan;
}

// Of a room, so that neighbours lie on one surface; the motor's speed wavers by 2 %.
std::vector<Point> room(int count, int way, double from = 0.1)
{
    std::vector<Point> points;
    for (int k = 0; k < count; k++) {
        const double along = (k + 0.3 * std::sin(k * 0.7)) / count;
        const double angle = 2 * M_PI * (from + way * along);
        const double wall = 1.5 / std::max(std::fabs(std::cos(angle)), std::fabs(std::sin(angle)));
        points.push_back({from + way * along, static_cast<int32_t>(wall * 1e6)});
    }
    return points;
}

TEST(Turn, EveryPointIsABeamAtItsOwnBearing)
{
    for (const int way : {1, -1}) {
        for (const int count : {90, 450, 1081}) {
            const auto points = room(count, way);
            const auto scan = scan_of(points);
            ASSERT_EQ(scan->beams, count);
            ASSERT_TRUE(scan->own_bearings);
            for (int k = 0; k < count; k++) {
                ASSERT_EQ(ale_scan_bearing(scan.get(), k), bam(points[k].bearing));
                ASSERT_EQ(scan->range_um[k], points[k].range_um);
            }
            EXPECT_EQ(scan->step_bam > 0, way > 0);
            EXPECT_EQ(ale_scan_turn_beams(scan.get()), count) << "the first follows the last";
        }
    }
}

TEST(Turn, TheTimeOfABeamFollowsFromTheAngleTurned)
{
    for (const int way : {1, -1}) {
        const auto points = room(450, way);
        const auto scan = scan_of(points);
        const double swept = std::fabs(points.back().bearing - points[0].bearing);
        for (int k = 0; k < 450; k++) {
            const double turned = std::fabs(points[k].bearing - points[0].bearing);
            const double at_us = static_cast<double>(scan->stamp_us) + ale_scan_beam_offset_us(scan.get(), k);
            ASSERT_NEAR(at_us, 1e6 + 1e5 * turned / swept, 2) << k;
        }
    }
}

TEST(Turn, TheStampIsThatOfTheMiddle)
{
    for (const int way : {1, -1}) {
        for (const int count : {9, 90, 450, 4000}) {
            const auto scan = scan_of(room(count, way));
            const int32_t first_us = ale_scan_beam_offset_us(scan.get(), 0);
            const int32_t last_us = ale_scan_beam_offset_us(scan.get(), scan->beams - 1);
            EXPECT_EQ(scan->stamp_beam, (scan->beams - 1) / 2);
            EXPECT_NEAR(first_us, -last_us, 2 * scan->beam_time_ns / 1000.0);
        }
    }
}

TEST(Turn, TwoPointsInOneDirectionAreTwoBeams)
{
    auto points = room(450, -1);
    points.insert(points.begin() + 101, points[100]);
    points[101].range_um += 1000;
    const auto scan = scan_of(points);
    ASSERT_EQ(scan->beams, 451);
    EXPECT_EQ(scan->bearing_bam[100], scan->bearing_bam[101]);
    EXPECT_EQ(scan->range_um[101], scan->range_um[100] + 1000);
}

TEST(Turn, PointsThatStrayFromTheOrderAreSorted)
{
    const auto points = room(450, -1);
    auto mixed = points;
    for (int k = 5; k + 4 < 450; k += 9) {
        std::reverse(mixed.begin() + k, mixed.begin() + k + 4);
    }
    const auto straight = scan_of(points);
    const auto sorted = scan_of(mixed);
    ASSERT_EQ(sorted->beams, 450);
    for (int k = 0; k < 450; k++) {
        ASSERT_EQ(sorted->bearing_bam[k], straight->bearing_bam[k]);
        ASSERT_EQ(sorted->range_um[k], straight->range_um[k]);
    }
}

TEST(Turn, BeamsOfALostPacketAreUnknown)
{
    auto points = room(450, 1);
    points.erase(points.begin() + 200, points.begin() + 212);
    const auto scan = scan_of(points);
    ASSERT_EQ(scan->beams, 450);
    for (int k = 0; k < 450; k++) {
        ASSERT_EQ(scan->flag[k], k >= 200 && k < 212 ? ALE_BEAM_UNKNOWN : ALE_BEAM_VALID) << k;
        const double error = ale_bam_diff(ale_scan_bearing(scan.get(), k), bam(0.1 + k / 450.0));
        ASSERT_LE(std::fabs(error), std::ldexp(1.0, 32) / 450) << k;
    }
}

TEST(Turn, FlagsStayAndRangesAreJudgedByTheLimits)
{
    auto points = room(90, 1);
    points[3] = {points[3].bearing, 0, ALE_BEAM_NO_RETURN};
    points[4] = {points[4].bearing, 500, ALE_BEAM_UNKNOWN};
    points[5].range_um = 10000;
    points[6].range_um = 12000000;
    const auto scan = scan_of(points);
    EXPECT_EQ(scan->flag[3], ALE_BEAM_NO_RETURN);
    EXPECT_EQ(scan->flag[4], ALE_BEAM_UNKNOWN);
    EXPECT_EQ(scan->range_um[4], 0);
    EXPECT_EQ(scan->flag[5], ALE_BEAM_TOO_NEAR);
    EXPECT_EQ(scan->flag[6], ALE_BEAM_NO_RETURN);
}

TEST(Turn, MorePointsThanBeamsAreJoinedAndAllAreUsed)
{
    for (const int count : {1082, 1440, 3200, 4096}) {
        uint32_t left_out = 1;
        const auto points = room(count, -1);
        const auto scan = scan_of(points, ALE_TURN_FINE, &left_out);
        const int joined = (count + 809) / 810;
        EXPECT_EQ(left_out, 0u);
        ASSERT_EQ(scan->beams, (count + joined - 1) / joined);
        EXPECT_GT(ale_scan_turn_beams(scan.get()), 0);
        for (int k = 0; k < scan->beams; k++) {
            int64_t range_um = 0;
            double bearing = 0;
            int points_of = 0;
            for (int i = joined * k; i < std::min(joined * (k + 1), count); i++, points_of++) {
                range_um += points[i].range_um;
                bearing += points[i].bearing;
            }
            ASSERT_NEAR(scan->range_um[k], static_cast<double>(range_um) / points_of, 1);
            ASSERT_NEAR(ale_bam_diff(scan->bearing_bam[k], bam(bearing / points_of)), 0, 2);
        }
    }
}

TEST(Turn, PointsOfTwoSurfacesAreNotJoined)
{
    auto points = room(1440, 1);
    for (int k = 301; k < 310; k++) {
        points[k].range_um /= 2; // begins and ends within a pair
    }
    const auto scan = scan_of(points);
    EXPECT_EQ(scan->beams, 721);
    const auto near =
        std::count_if(scan->range_um, scan->range_um + scan->beams, [](int r) { return r < 1.2e6; });
    EXPECT_EQ(near, 5);
}

TEST(Turn, WhatIsNoTurnIsSaid)
{
    scan_of(room(7, 1), ALE_TURN_FEW);
    scan_of({}, ALE_TURN_FEW);
    scan_of(room(4097, 1), ALE_TURN_MANY);
    scan_of(std::vector<Point>(100, {0.2, 1000000}), ALE_TURN_STILL);
    for (const auto status : {ALE_TURN_FEW, ALE_TURN_MANY, ALE_TURN_STILL}) {
        EXPECT_GT(std::string(ale_turn_status_text(status)).size(), 10u);
    }
}

// Whatever comes from a line: no more beams than fit, in order, and every point counted.
TEST(Turn, AnyPointsGiveAScanInOrder)
{
    std::mt19937 random(5);
    for (int round = 0; round < 400; round++) {
        const int count = 8 + static_cast<int>(random() % 4089);
        const int wild = static_cast<int>(random() % 3);
        std::vector<Point> points;
        for (int k = 0; k < count; k++) {
            const double bearing = wild ? static_cast<double>(random()) / 4294967296.0 : -1.1 * k / count;
            points.push_back({wild == 2 ? std::floor(bearing * 40) / 40 : bearing,
                              static_cast<int32_t>(random() >> 7),
                              static_cast<ale_beam_flag_t>(random() % 4 / 3 * 2)});
        }
        uint32_t left_out = 0;
        const auto scan = scan_of(points, ALE_TURN_FINE, &left_out);
        ASSERT_LE(scan->beams, ALE_MAX_BEAMS);
        ASSERT_LE(left_out, static_cast<uint32_t>(count));
        ASSERT_TRUE(ale_scan_is_sweep(scan.get()) || scan->beams < 3);
        for (int k = 1; k < scan->beams; k++) {
            const uint32_t from_first = scan->bearing_bam[k] - scan->bearing_bam[0];
            const uint32_t before = scan->bearing_bam[k - 1] - scan->bearing_bam[0];
            ASSERT_TRUE(scan->step_bam > 0 ? from_first >= before : -from_first >= -before)
                << round << ' ' << k;
        }
    }
}

// Sums over all points that there may be, at their largest: what the proofs of run time leave to this test.
TEST(Turn, TheSumsOfTheMostPointsFit)
{
    for (const int way : {1, -1}) {
        for (const int32_t range_um : {INT32_MAX, INT32_MIN, 0}) {
            std::vector<Point> even;
            std::vector<Point> crowded;
            for (int k = 0; k < ALE_MAX_TURN_POINTS; k++) {
                even.push_back({way * static_cast<double>(k) / ALE_MAX_TURN_POINTS, range_um});
                crowded.push_back({way * std::ldexp(k, k + 1 < ALE_MAX_TURN_POINTS ? -32 : -13), range_um});
            }
            for (const auto &points : {even, crowded}) {
                const auto scan = scan_of(points);
                ASSERT_GE(scan->beams, 1);
                ASSERT_LE(scan->beams, ALE_MAX_BEAMS);
            }
        }
    }
}

} // namespace
