// lib/map/visibility.c: whether a scan sees a wall, sees through its place, or cannot tell. Twin: rays in
// double.
#include <cmath>
#include <optional>
#include <random>

#include <gtest/gtest.h>

#include "lib/motion/room.h"
#include "walls.h"

extern "C" {
#include "map/visibility.h"
}

namespace
{
using reference::pi;

constexpr double range_min_m = 0.02;
constexpr double tolerance_m = 0.12;
constexpr double tolerance_per_metre = 0.03;

ale_scan_t scan_of(const std::vector<room::Wall> &surfaces, const reference::Pose &from)
{
    std::mt19937 rng(1);
    room::Sensor sensor;
    sensor.beam_time_ns = 0;
    return room::scan_at(
        surfaces, sensor, [&](double) { return from; }, 1, rng);
}

/* A plane wall of a map, in metres. */
struct Plane {
    double x, y, normal, half;
    ale_wall_t wall() const
    {
        return make_wall(x, y, normal, half);
    }
    Eigen::Vector2d point(double t) const
    {
        return {x + t * std::sin(normal), y - t * std::cos(normal)};
    }
    room::Wall surface(double beyond) const
    {
        const Eigen::Vector2d away = -beyond * Eigen::Vector2d(std::cos(normal), std::sin(normal));
        const Eigen::Vector2d a = point(-half) + away;
        const Eigen::Vector2d b = point(half) + away;
        return {a[0], a[1], b[0], b[1]};
    }
};

/* The rules of the header, by geometry alone. Nothing is expected near a threshold, nor where neighbouring
 * beams disagree. */
struct Geometry {
    const std::vector<room::Wall> &surfaces;
    reference::Pose sensor;
    room::Sensor model{};

    std::optional<ale_visibility_t> of_beam(double beam, double range) const
    {
        const double measured =
            room::distance(surfaces, sensor[0], sensor[1], sensor[2] + model.first + beam * model.step);
        if (measured > model.reach - 0.1) {
            return ALE_VISIBILITY_NONE;
        }
        const double beyond = measured - range;
        const double tolerance = tolerance_m + tolerance_per_metre * range;
        if (std::abs(std::abs(beyond) - tolerance) < 0.002 ||
            std::abs(measured - model.reach + 0.1) < 0.002) {
            return std::nullopt;
        }
        if (beyond > tolerance) {
            return ALE_VISIBILITY_VIOLATED;
        }
        return beyond < -tolerance ? ALE_VISIBILITY_NONE : ALE_VISIBILITY_SUPPORTED;
    }

    double beam_towards(const Eigen::Vector2d &d) const
    {
        const double angle = std::atan2(d[1], d[0]) - sensor[2] - model.first;
        return (angle - 2 * pi * std::floor(angle / (2 * pi))) / model.step;
    }

    std::optional<ale_visibility_t> of_beams_around(double beam, double range) const
    {
        const auto here = of_beam(beam, range);
        for (int aside = -1; aside <= 2; aside++) {
            if (of_beam(beam + aside, range) != here) {
                return std::nullopt;
            }
        }
        return here;
    }

    std::optional<ale_visibility_t> of_point(const Plane &plane, double t) const
    {
        const Eigen::Vector2d d = plane.point(t) - sensor.head<2>();
        const double range = d.norm();
        const double cosine = -(d[0] * std::cos(plane.normal) + d[1] * std::sin(plane.normal)) / range;
        const double grazing = std::cos(75 * pi / 180);
        if (std::abs(cosine - grazing) < 0.002 || std::abs(range - model.reach) < 0.001 ||
            std::abs(range - range_min_m) < 0.001) {
            return std::nullopt;
        }
        if (cosine < grazing || range > model.reach || range < range_min_m) {
            return ALE_VISIBILITY_NONE;
        }
        const double beam = beam_towards(d);
        if (beam < 2 || std::abs(beam - model.beams) < 2 || beam > 1022) {
            return std::nullopt;
        }
        return beam > model.beams ? ALE_VISIBILITY_NONE : of_beams_around(std::floor(beam), range);
    }

    std::optional<ale_visibility_t> of_wall(const Plane &plane) const
    {
        int violated = 0;
        bool supported = false;
        for (const double part : {-2.0 / 3, 0.0, 2.0 / 3}) {
            const auto point = of_point(plane, part * plane.half);
            if (!point) {
                return std::nullopt;
            }
            violated += *point == ALE_VISIBILITY_VIOLATED;
            supported = supported || *point == ALE_VISIBILITY_SUPPORTED;
        }
        if (supported) {
            return ALE_VISIBILITY_SUPPORTED;
        }
        return violated >= 2 ? ALE_VISIBILITY_VIOLATED : ALE_VISIBILITY_NONE;
    }
};

struct Tally {
    int told[3] = {0, 0, 0};
    void check(std::optional<ale_visibility_t> expected, ale_visibility_t got)
    {
        if (expected) {
            EXPECT_EQ(got, *expected);
            told[*expected]++;
        }
    }
};

TEST(Visibility, AgreesWithGeometryInRandomScenes)
{
    std::mt19937 rng(7);
    std::uniform_real_distribution<double> unit(-1, 1);
    Tally points;
    Tally walls;
    for (int n = 0; n < 2500; n++) {
        const reference::Pose from(unit(rng), unit(rng), pi * unit(rng));
        const double side = pi * unit(rng);
        const double away = 3.2 + 3 * unit(rng);
        const Plane plane = {from[0] + away * std::cos(side), from[1] + away * std::sin(side),
                             side + pi + 1.6 * unit(rng), 0.8 + 0.6 * unit(rng)};
        std::vector<room::Wall> surfaces = {{-6, 5, 6, 5}, {-6, -5, 6, -5}, {5, -6, 5, 6}};
        if (n % 2 == 0) {
            surfaces.push_back(plane.surface(0.3 * unit(rng)));
        }
        if (n % 3 == 0) {
            const double x = 3 * unit(rng);
            const double y = 3 * unit(rng);
            surfaces.push_back({x, y, x + unit(rng), y + unit(rng)});
        }
        const ale_scan_t scan = scan_of(surfaces, from);
        const ale_posed_scan_t posed = {&scan, nullptr, convert::pose(from)};
        const Geometry geometry = {surfaces, from};
        const ale_wall_t wall = plane.wall();
        walls.check(geometry.of_wall(plane), ale_wall_visibility(&wall, &posed));
        const double t = 0.95 * plane.half * unit(rng);
        points.check(geometry.of_point(plane, t), ale_wall_point_visibility(&wall, convert::um(t), &posed));
    }
    for (const int told : points.told) {
        EXPECT_GT(told, 150);
    }
    for (const int told : walls.told) {
        EXPECT_GT(told, 150);
    }
}

/* A wall 2 m ahead of a sensor at the origin, and what stands there in its place. */
struct Ahead : testing::Test {
    const Plane plane = {2, 0, pi, 0.8};
    const ale_wall_t wall = plane.wall();

    ale_visibility_t seen(const std::vector<room::Wall> &surfaces, const Plane &asked) const
    {
        const ale_scan_t scan = scan_of(surfaces, {0, 0, 0});
        const ale_posed_scan_t posed = {&scan, nullptr, {0, 0, 0}};
        const ale_wall_t w = asked.wall();
        return ale_wall_visibility(&w, &posed);
    }
    ale_visibility_t seen_at(double x) const
    {
        return seen({{x, -4, x, 4}}, plane);
    }
    ale_points_visibility_t points(const ale_scan_t &scan, ale_slack_t slack) const
    {
        const ale_posed_scan_t posed = {&scan, nullptr, {0, 0, 0}};
        return ale_wall_points_visibility(&wall, &posed, slack);
    }
};

TEST_F(Ahead, SeenHiddenSeenThrough)
{
    EXPECT_EQ(seen_at(2.02), ALE_VISIBILITY_SUPPORTED);
    EXPECT_EQ(seen_at(1.0), ALE_VISIBILITY_NONE);
    EXPECT_EQ(seen_at(3.0), ALE_VISIBILITY_VIOLATED);
}

TEST_F(Ahead, WithoutAValueInTheBeamsNothingIsSaid)
{
    EXPECT_EQ(seen_at(9.0), ALE_VISIBILITY_NONE);
    const ale_scan_t dark = scan_of({{9, -4, 9, 4}}, {0, 0, 0});
    EXPECT_EQ(points(dark, {0, 0, false}).violated, 0);
    EXPECT_EQ(points(dark, {0, 0, true}).violated, ALE_VISIBILITY_POINTS)
        << "the same beams gave an answer from this place before";
}

TEST_F(Ahead, OutOfViewOutOfRangeOrGrazingNothingIsSaid)
{
    const std::vector<room::Wall> far = {{5.2, -9, 5.2, 9}};
    EXPECT_EQ(seen(far, {-2, 0, 0, 0.3}), ALE_VISIBILITY_NONE) << "behind the sensor";
    EXPECT_EQ(seen(far, {2, 0, 0, 0.8}), ALE_VISIBILITY_NONE) << "it faces away";
    EXPECT_EQ(seen(far, {6, 0, pi, 0.8}), ALE_VISIBILITY_NONE) << "beyond the scanner's range";
    EXPECT_EQ(seen(far, {3, -0.4, pi / 2, 0.8}), ALE_VISIBILITY_NONE) << "82 degrees off its normal";
    EXPECT_EQ(seen(far, {3, -0.4, pi / 2 + 1, 0.3}), ALE_VISIBILITY_VIOLATED)
        << "the same place, less grazing";
}

TEST_F(Ahead, OnePointOfThreeThatIsSeenThroughIsNotEnoughAndOneThatIsSeenIs)
{
    const std::vector<room::Wall> left_hidden = {{1, 0.1, 1, 2}, {4, -6, 4, 6}};
    EXPECT_EQ(seen(left_hidden, plane), ALE_VISIBILITY_VIOLATED);
    const std::vector<room::Wall> mostly_hidden = {{1, -0.1, 1, 2}, {4, -6, 4, 6}};
    EXPECT_EQ(seen(mostly_hidden, plane), ALE_VISIBILITY_NONE);
    const std::vector<room::Wall> in_part = {{2, 0.3, 2, 2}, {4, -6, 4, 6}};
    EXPECT_EQ(seen(in_part, plane), ALE_VISIBILITY_SUPPORTED);
}

TEST_F(Ahead, AnUncertainPoseWidensTheToleranceAndAsksTheBeamsBeside)
{
    const ale_scan_t scan = scan_of({{2.3, -4, 2.3, 4}}, {0, 0, 0});
    EXPECT_EQ(points(scan, {0, 0, false}).violated, 3);
    EXPECT_EQ(points(scan, {200000, 0, false}).supported, 3);
    EXPECT_EQ(points(scan, {0, 100000, false}).supported, 3);
    const ale_scan_t gap = scan_of({{2, 0.06, 2, 4}, {2, -4, 2, -0.06}, {4, -4, 4, 4}}, {0, 0, 0});
    EXPECT_EQ(points(gap, {0, 0, false}).violated, 1);
    EXPECT_EQ(points(gap, {100000, 0, false}).violated, 0) << "the wall beside the gap may be meant";
}

TEST_F(Ahead, TheBearingsOfADeskewedScanAreFollowed)
{
    // A gap of three beams straight ahead; the bearings say that every beam points four steps further round.
    ale_scan_t scan = scan_of({{2, -4, 2, 4}}, {0, 0, 0});
    std::vector<uint32_t> bearing_bam(scan.beams);
    for (int k = 0; k < scan.beams; k++) {
        bearing_bam[k] = ale_scan_bearing(&scan, k) + 4 * static_cast<uint32_t>(scan.step_bam);
    }
    for (uint16_t k = 339; k <= 341; k++) {
        ale_scan_set_range(&scan, k, 4000000);
    }
    const ale_posed_scan_t regular = {&scan, nullptr, {0, 0, 0}};
    const ale_posed_scan_t moved = {&scan, bearing_bam.data(), {0, 0, 0}};
    const double aside = 2 * std::tan(4 * 2 * pi / 1024);
    EXPECT_EQ(ale_wall_point_visibility(&wall, 0, &regular), ALE_VISIBILITY_VIOLATED);
    EXPECT_EQ(ale_wall_point_visibility(&wall, 0, &moved), ALE_VISIBILITY_SUPPORTED);
    // the tangent of a wall that faces -x points to +y
    EXPECT_EQ(ale_wall_point_visibility(&wall, convert::um(aside), &regular), ALE_VISIBILITY_SUPPORTED);
    EXPECT_EQ(ale_wall_point_visibility(&wall, convert::um(aside), &moved), ALE_VISIBILITY_VIOLATED);
}

TEST_F(Ahead, AScannerThatTurnsClockwiseAnswersAlike)
{
    ale_scan_t scan = scan_of({{2, 0.1, 2, 4}, {4, -4, 4, 4}}, {0, 0, 0});
    ale_scan_t reversed = scan;
    reversed.first_bearing_bam = ale_scan_bearing(&scan, scan.beams - 1);
    reversed.step_bam = -scan.step_bam;
    for (int k = 0; k < scan.beams; k++) {
        reversed.range_um[k] = scan.range_um[scan.beams - 1 - k];
        reversed.flag[k] = scan.flag[scan.beams - 1 - k];
    }
    std::vector<uint32_t> bearing_bam(scan.beams);
    for (int k = 0; k < scan.beams; k++) { // deskewed: four steps further round
        bearing_bam[k] = ale_scan_bearing(&scan, k) + 4 * static_cast<uint32_t>(scan.step_bam);
    }
    const std::vector<uint32_t> reversed_bam(bearing_bam.rbegin(), bearing_bam.rend());
    const double edge_m = 2 * std::tan(std::atan(0.05) + 4 * 2 * pi / 1024);
    const ale_posed_scan_t forwards = {&scan, bearing_bam.data(), {0, 0, 0}};
    const ale_posed_scan_t backwards = {&reversed, reversed_bam.data(), {0, 0, 0}};
    for (int t_um = -790000; t_um < 800000; t_um += 53000) {
        if (std::abs(t_um - edge_m * 1e6) > 20000) {
            const auto expected = t_um > edge_m * 1e6 ? ALE_VISIBILITY_SUPPORTED : ALE_VISIBILITY_VIOLATED;
            EXPECT_EQ(ale_wall_point_visibility(&wall, t_um, &forwards), expected) << t_um;
            EXPECT_EQ(ale_wall_point_visibility(&wall, t_um, &backwards), expected) << t_um;
        }
    }
}
} // namespace
