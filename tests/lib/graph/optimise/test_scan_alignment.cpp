// lib/graph/optimise/scan_alignment: scans of a room with poses good to centimetres, against the truth.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "graph/optimise/scan_alignment.h"

namespace
{

constexpr int scans = 40;

// Along the room and back, turning slowly.
ale::Pose truth(int k)
{
    const double a = 2 * ale::pi * k / scans;
    return {3 - 1.5 * std::cos(a), 2 + 0.8 * std::sin(a), 0.5 * std::sin(a)};
}

// Walls of a room of 6 m by 4 m, every 10 cm a point.
std::vector<ale::SurfacePoint> seen_from(const ale::Pose &pose, std::mt19937 *random)
{
    std::normal_distribution<double> noise(0, 0.004);
    std::vector<ale::SurfacePoint> points;
    const ale::Pose back = ale::inverse(pose);
    const auto put = [&](const Eigen::Vector2d &p, const Eigen::Vector2d &normal) {
        points.push_back({ale::apply(back, p + noise(*random) * normal), ale::rotation(back.theta) * normal});
    };
    for (double x = 0.02; x < 6; x += 0.1) {
        put({x, 0}, {0, 1});
        put({x, 4}, {0, -1});
    }
    for (double y = 0.02; y < 4; y += 0.1) {
        put({0, y}, {1, 0});
        put({6, y}, {-1, 0});
    }
    return points;
}

// Slow drift between keyframes.
ale::Pose disturbed(const ale::Pose &pose, int k)
{
    return {pose.x + 0.02 * std::sin(0.7 * k), pose.y + 0.02 * std::sin(0.5 * k),
            pose.theta + 0.01 * std::sin(0.6 * k)};
}

std::vector<ale::AlignedScan> drive(unsigned seed)
{
    std::mt19937 random(seed);
    std::vector<ale::AlignedScan> drive;
    for (int k = 0; k < scans; k++) {
        drive.push_back({disturbed(truth(k), k), k > 0, seen_from(truth(k), &random)});
    }
    return drive;
}

std::vector<ale::Pose> aligned(const std::vector<ale::AlignedScan> &drive)
{
    ale::ScanAlignment alignment(drive);
    while (alignment.step()) {
    }
    return alignment.poses();
}

double error_m(const ale::Pose &pose, int k)
{
    return ale::length(pose.x - truth(k).x, pose.y - truth(k).y);
}

TEST(ScanAlignment, ScansMoveToTheMeanOfAll)
{
    const std::vector<ale::AlignedScan> before = drive(1);
    const std::vector<ale::Pose> after = aligned(before);
    double sum2_before = 0;
    double sum2_after = 0;
    for (int k = 0; k < scans; k++) {
        const auto at = static_cast<size_t>(k);
        sum2_before += std::pow(error_m(before[at].pose, k), 2);
        sum2_after += std::pow(error_m(after[at], k), 2);
    }
    EXPECT_LT(std::sqrt(sum2_after), 0.33 * std::sqrt(sum2_before));
}

TEST(ScanAlignment, AScanWithoutPointsMovesWithItsNeighbours)
{
    std::vector<ale::AlignedScan> blind = drive(2);
    blind[20].points.clear();
    const std::vector<ale::Pose> after = aligned(blind);
    const ale::Pose shift_before = ale::between(blind[19].pose, blind[20].pose);
    const ale::Pose shift_after = ale::between(after[19], after[20]);
    EXPECT_NEAR(shift_after.x, shift_before.x, 0.015);
    EXPECT_NEAR(shift_after.y, shift_before.y, 0.015);
}

TEST(ScanAlignment, ScansWithoutTiesAndPointsStay)
{
    std::vector<ale::AlignedScan> broken = drive(3);
    for (size_t k = 20; k < broken.size(); k++) {
        broken[k].points.clear();
    }
    broken[20].tied = false;
    const std::vector<ale::Pose> after = aligned(broken);
    for (size_t k = 20; k < broken.size(); k++) {
        EXPECT_NEAR(after[k].x, broken[k].pose.x, 1e-9);
        EXPECT_NEAR(after[k].y, broken[k].pose.y, 1e-9);
    }
}

TEST(ScanAlignment, WallsSeenBentTurnNoPartOfThePath)
{
    // In the second half the few points are turned by a degree, as by a wavy wall; the headings are right.
    constexpr double bent = 0.0175;
    std::vector<ale::AlignedScan> scans_turned = drive(4);
    for (size_t k = 0; k < scans_turned.size(); k++) {
        scans_turned[k].pose = truth(static_cast<int>(k));
        if (k < scans_turned.size() / 2) {
            continue;
        }
        std::vector<ale::SurfacePoint> few;
        for (size_t i = 0; i < scans_turned[k].points.size(); i += 20) {
            const ale::SurfacePoint &point = scans_turned[k].points[i];
            few.push_back({ale::rotation(bent) * point.p, ale::rotation(bent) * point.normal});
        }
        scans_turned[k].points = few;
    }
    const std::vector<ale::Pose> after = aligned(scans_turned);
    double turned = 0;
    for (size_t k = scans_turned.size() / 2; k < scans_turned.size(); k++) {
        turned += ale::wrapped(after[k].theta - scans_turned[k].pose.theta) /
                  static_cast<double>(scans_turned.size() / 2);
    }
    EXPECT_LT(std::abs(turned), 0.5 * bent);
}

TEST(ScanAlignment, ADriveWithoutScansIsDoneAtOnce)
{
    EXPECT_FALSE(ale::ScanAlignment({}).step());
}

} // namespace
