// lib/plan/safe_speed.c against a robot that is driven along its arc in small steps, in double.
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "lib/motion/convert.h"

extern "C" {
#include "plan/safe_speed.h"
}

namespace
{

struct Place {
    double x;
    double y;
};

// Where the robot is after `way` metres along the arc of (v, w).
Place along(double way, double v, double w)
{
    const double s = v < 0 ? -way : way;
    const double angle = s * w / v;
    if (std::fabs(angle) < 1e-9) {
        return {s, 0};
    }
    return {std::sin(angle) * v / w, (1 - std::cos(angle)) * v / w};
}

// The first contact, found by walking: step by step, then by halving.
std::optional<double> walked_to_contact(Place p, double radius, double v, double w, double farthest)
{
    const auto gap = [&](double way) {
        const Place robot = along(way, v, w);
        return std::hypot(p.x - robot.x, p.y - robot.y) - radius;
    };
    const double step = 0.002;
    for (double way = 0; way < farthest; way += step) {
        if (gap(way + step) < 0) {
            double low = way;
            double high = way + step;
            for (int k = 0; k < 40; k++) {
                (gap((low + high) / 2) < 0 ? high : low) = (low + high) / 2;
            }
            return low;
        }
    }
    return std::nullopt;
}

ale_point_t core(Place p)
{
    return {convert::um(p.x), convert::um(p.y)};
}

ale_scan_t scan_of_nothing()
{
    ale_scan_t scan = {};
    scan.beams = 682;
    scan.step_bam = 1 << 22;
    scan.first_bearing_bam = 0u - 340u * (1u << 22);
    scan.range_min_um = 20000;
    scan.range_max_um = 5600000;
    std::memset(scan.flag, ALE_BEAM_NO_RETURN, sizeof scan.flag);
    return scan;
}

ale_scan_t scan_of_wall_ahead(double metres)
{
    ale_scan_t scan = scan_of_nothing();
    for (int k = 0; k < scan.beams; k++) {
        const double c = std::cos(convert::radians(ale_scan_bearing(&scan, k)));
        if (c > 0 && metres / c < 5.6) {
            ale_scan_set_range(&scan, static_cast<uint16_t>(k), convert::um(metres / c));
        }
    }
    return scan;
}

const ale_pose_t at_the_centre = {0, 0, 0};

} // namespace

TEST(WayToContact, IsThatOfARobotThatWalksTheArc)
{
    std::mt19937 rng(1);
    std::uniform_real_distribution<double> unit(-1, 1);
    int contacts = 0;
    for (int n = 0; n < 4000; n++) {
        const double v = unit(rng) < 0 ? -0.4 : 0.4;
        const double w = n % 4 == 0 ? 0 : 1.5 * unit(rng);
        const double radius = 0.25;
        const Place p = {1.5 * unit(rng), 1.5 * unit(rng)};
        if (std::hypot(p.x, p.y) < radius + 1e-4) {
            continue;
        }
        const double once_round = w == 0 ? 4 : std::fmin(4, 2 * reference::pi * std::fabs(v / w));
        const int64_t got_um =
            ale_distance_to_contact_um(core(p), convert::um(radius), convert::um(v), convert::um(w));
        const auto truth = walked_to_contact(p, radius, v, w, once_round);
        if (truth) {
            contacts++;
            // Where the disc only grazes the point, a micrometre of range moves the contact by millimetres.
            EXPECT_NEAR(static_cast<double>(got_um) * 1e-6, *truth, 0.004)
                << p.x << ' ' << p.y << ' ' << v << ' ' << w;
        } else {
            EXPECT_GT(got_um, static_cast<int64_t>(once_round * 1e6) - 5000)
                << p.x << ' ' << p.y << ' ' << v << ' ' << w;
        }
    }
    EXPECT_GT(contacts, 300);
}

TEST(WayToContact, AFlatArcIsAsGoodAsAStraightLine)
{
    const ale_point_t p = {5000000, 100000};
    const int64_t straight_um = ale_distance_to_contact_um(p, 250000, 500000, 0);
    for (int32_t w = -8; w <= 8; w++) {
        EXPECT_NEAR(static_cast<double>(ale_distance_to_contact_um(p, 250000, 500000, w)),
                    static_cast<double>(straight_um), 100)
            << w;
    }
}

TEST(WayToContact, APointInsideTheDiscBlocksTheWayTowardsItAndLeavesTheWayBack)
{
    const ale_point_t p = {150000, 50000};
    EXPECT_EQ(ale_distance_to_contact_um(p, 250000, 300000, 0), 0);
    EXPECT_EQ(ale_distance_to_contact_um(p, 250000, 300000, 700000), 0);
    EXPECT_EQ(ale_distance_to_contact_um(p, 250000, -300000, 0), INT64_MAX);
}

TEST(StoppingSpeed, UsesUpTheWayWithReactionAndBraking)
{
    const ale_robot_shape_t shape = ale_robot_shape_default();
    for (int64_t distance_um = 0; distance_um < 6000000; distance_um += 12345) {
        const double v = ale_stopping_speed_um_s(distance_um, &shape) * 1e-6;
        const double used = v * shape.reaction_us * 1e-6 + v * v / (2 * shape.deceleration_um_s2 * 1e-6);
        EXPECT_LE(used, static_cast<double>(distance_um) * 1e-6 + 1e-9);
        EXPECT_GE(used, static_cast<double>(distance_um) * 1e-6 - 1e-5);
    }
    EXPECT_GT(ale_stopping_speed_um_s(INT64_MAX, &shape), 10000000);
}

TEST(SafeSpeed, TheRobotStopsBeforeAnythingItSees)
{
    std::mt19937 rng(2);
    std::uniform_real_distribution<double> unit(0, 1);
    const ale_robot_shape_t shape = ale_robot_shape_default();
    const reference::Pose mounting = {0.1, -0.05, 0.3};
    const ale_pose_t sensor = convert::pose(mounting);
    int slowed = 0;
    for (int n = 0; n < 200; n++) {
        ale_scan_t scan = scan_of_nothing();
        std::vector<Place> seen;
        for (int k = 0; k < 25; k++) {
            const int beam = 27 * k + static_cast<int>(unit(rng) * 26);
            const double range = 0.4 + 3 * unit(rng);
            ale_scan_set_range(&scan, static_cast<uint16_t>(beam), convert::um(range));
            const double bearing = convert::radians(ale_scan_bearing(&scan, beam));
            const reference::Pose p =
                reference::compose(mounting, {range * std::cos(bearing), range * std::sin(bearing), 0});
            seen.push_back({p[0], p[1]});
        }
        const double wanted = 0.8;
        const double turn = 1.6 * (unit(rng) - 0.5);
        const int32_t safe_um_s =
            ale_safe_speed_um_s(&scan, &sensor, &shape, convert::um(wanted), convert::um(turn));
        const double v = safe_um_s * 1e-6;
        ASSERT_GE(safe_um_s, 0);
        ASSERT_LE(safe_um_s, convert::um(wanted));
        const double way = v * shape.reaction_us * 1e-6 + v * v / (2 * shape.deceleration_um_s2 * 1e-6);
        double nearest = std::numeric_limits<double>::max();
        for (int step = 0; step <= 200; step++) {
            const Place robot = along(way * step / 200, wanted, turn);
            for (const Place &p : seen) {
                nearest = std::fmin(nearest, std::hypot(p.x - robot.x, p.y - robot.y));
            }
        }
        const double kept = (shape.width_um / 2 + shape.margin_um) * 1e-6;
        const bool stands_in_it = std::any_of(seen.begin(), seen.end(),
                                              [&](const Place &p) { return std::hypot(p.x, p.y) < kept; });
        if (!stands_in_it) {
            EXPECT_GE(nearest, kept - 1e-4) << "seed " << n;
        }
        if (safe_um_s < convert::um(wanted) && safe_um_s > 0) {
            slowed++;
            EXPECT_NEAR(nearest, kept, 1e-3) << "and no slower than it must, seed " << n;
        }
    }
    EXPECT_GT(slowed, 50);
}

TEST(SafeSpeed, KeepsTheSignAndIsZeroAtTheWall)
{
    const ale_robot_shape_t shape = ale_robot_shape_default();
    const ale_scan_t free = scan_of_nothing();
    EXPECT_EQ(ale_safe_speed_um_s(&free, &at_the_centre, &shape, 500000, 100000), 500000);
    EXPECT_EQ(ale_safe_speed_um_s(&free, &at_the_centre, &shape, 0, 800000), 0);
    const ale_scan_t wall = scan_of_wall_ahead(0.23);
    EXPECT_EQ(ale_safe_speed_um_s(&wall, &at_the_centre, &shape, 500000, 0), 0);
    EXPECT_LT(ale_safe_speed_um_s(&wall, &at_the_centre, &shape, -50000, 0), 0);
}

TEST(SafeSpeed, WhatIsNearerThanTheMarginMayBeDrivenAlongAndLeftButNotApproached)
{
    const ale_robot_shape_t shape = ale_robot_shape_default();
    const ale_pose_t looks_left = {0, 0, ALE_BAM_QUARTER_TURN};
    const ale_scan_t wall_on_the_left = scan_of_wall_ahead(0.215);
    EXPECT_GT(ale_safe_speed_um_s(&wall_on_the_left, &looks_left, &shape, 300000, 0), 100000);
    EXPECT_GT(ale_safe_speed_um_s(&wall_on_the_left, &looks_left, &shape, 300000, -500000), 100000);
    EXPECT_LT(ale_safe_speed_um_s(&wall_on_the_left, &looks_left, &shape, 300000, 500000), 10000);
}

TEST(SafeSpeed, WhereTheScannerDoesNotLookTheRobotCreeps)
{
    const ale_robot_shape_t shape = ale_robot_shape_default();
    ale_scan_t scan = scan_of_nothing();
    EXPECT_EQ(ale_safe_speed_um_s(&scan, &at_the_centre, &shape, -500000, 0), -shape.blind_um_s);
    const ale_pose_t looks_back = {0, 0, ALE_BAM_HALF_TURN};
    EXPECT_EQ(ale_safe_speed_um_s(&scan, &looks_back, &shape, -500000, 0), -500000);
    EXPECT_EQ(ale_safe_speed_um_s(&scan, &looks_back, &shape, 500000, 0), shape.blind_um_s);
    std::memset(scan.flag, ALE_BEAM_UNKNOWN, sizeof scan.flag);
    EXPECT_EQ(ale_safe_speed_um_s(&scan, &at_the_centre, &shape, 500000, 0), shape.blind_um_s) << "dazzled";
    scan.beams = 0;
    EXPECT_EQ(ale_safe_speed_um_s(&scan, &at_the_centre, &shape, 500000, 0), shape.blind_um_s) << "no scan";
}

TEST(SafeSpeed, AThingTooNearToMeasureStopsTheRobot)
{
    const ale_robot_shape_t shape = ale_robot_shape_default();
    ale_scan_t scan = scan_of_nothing();
    scan.flag[340] = ALE_BEAM_TOO_NEAR;
    const ale_pose_t at_the_front = {200000, 0, 0};
    EXPECT_EQ(ale_safe_speed_um_s(&scan, &at_the_front, &shape, 500000, 0), 0);
}
