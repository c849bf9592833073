// lib/graph/fields/likelihood_field: against a plain search, and with views larger than it holds.
#include "graph/fields/likelihood_field.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace
{

using ale::LikelihoodField;
using ale::SurfacePoint;

constexpr double spacing_m = 0.10;

// Points along a straight wall from a to b.
void add_wall(const Eigen::Vector2d &a, const Eigen::Vector2d &b, std::vector<SurfacePoint> *points)
{
    const Eigen::Vector2d d = b - a;
    const Eigen::Vector2d along = d.normalized();
    const Eigen::Vector2d normal(-along.y(), along.x());
    const int last = static_cast<int>(d.norm() / spacing_m);
    for (int k = 0; k <= last; k++) {
        points->push_back({a + k * spacing_m * along, normal});
    }
}

std::vector<SurfacePoint> room()
{
    std::vector<SurfacePoint> points;
    add_wall({-3, -2}, {3, -2}, &points);
    add_wall({3, -2}, {3, 2}, &points);
    add_wall({3, 2}, {-3, 2}, &points);
    return points;
}

double distance_to(const std::vector<SurfacePoint> &points, const Eigen::Vector2d &p)
{
    double nearest = INFINITY;
    for (const SurfacePoint &point : points) {
        nearest = std::min(nearest, (point.p - p).norm());
    }
    return nearest;
}

TEST(LikelihoodField, FindsWhatAPlainSearchFinds)
{
    const std::vector<SurfacePoint> points = room();
    const LikelihoodField field(points);
    int found = 0;
    for (double x = -3.5; x < 3.5; x += 0.073) {
        for (double y = -2.5; y < 2.5; y += 0.067) {
            const Eigen::Vector2d p(x, y);
            const double nearest = distance_to(points, p);
            const SurfacePoint *point = field.nearest(p);
            if (nearest < LikelihoodField::reach_m - LikelihoodField::cell_m) {
                ASSERT_NE(point, nullptr) << p.transpose();
                EXPECT_LT((point->p - p).norm(), nearest + 2 * LikelihoodField::cell_m) << p.transpose();
                found++;
            } else if (nearest > LikelihoodField::reach_m + LikelihoodField::cell_m) {
                EXPECT_EQ(point, nullptr) << p.transpose();
                EXPECT_EQ(field.likelihood(p), 0) << p.transpose();
            }
        }
    }
    EXPECT_GT(found, 1000);
}

// A hall, seen from one end: everything near the sensor is kept.
TEST(LikelihoodField, KeepsTheRoomAroundTheSensorWhenBeamsReachFar)
{
    std::vector<SurfacePoint> points = room();
    const std::vector<SurfacePoint> near = points;
    add_wall({50, -20}, {50, 20}, &points);
    add_wall({10, 30}, {50, 30}, &points);
    const LikelihoodField field(points);
    for (const SurfacePoint &point : near) {
        EXPECT_NE(field.nearest(point.p), nullptr) << point.p.transpose();
        EXPECT_GT(field.likelihood(point.p), 0.5) << point.p.transpose();
    }
    EXPECT_EQ(field.nearest({50, 0}), nullptr);
}

TEST(LikelihoodField, HoldsAWholeCorridor)
{
    std::vector<SurfacePoint> points;
    add_wall({-30, -1}, {30, -1}, &points);
    add_wall({30, 1}, {-30, 1}, &points);
    const LikelihoodField field(points);
    for (const SurfacePoint &point : points) {
        EXPECT_NE(field.nearest(point.p), nullptr) << point.p.transpose();
    }
}

TEST(LikelihoodField, WithoutPointsIsEmpty)
{
    const LikelihoodField field({});
    EXPECT_EQ(field.nearest({0, 0}), nullptr);
    EXPECT_EQ(field.likelihood({0, 0}), 0);
}

} // namespace
