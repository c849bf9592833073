// lib/graph/optimise/mean_surface: against sums over all points.
#include <random>

#include <gtest/gtest.h>

#include "graph/optimise/mean_surface.h"

namespace
{

const Eigen::Vector2d low(-1, -2);
const Eigen::Vector2d high(3, 2);
const Eigen::Vector2d up(0, 1);

Eigen::Array2i cell_of(const Eigen::Vector2d &p)
{
    return ((p - low) / ale::MeanSurface::cell_m).array().floor().cast<int>();
}

TEST(MeanSurface, IsTheMeanOfThePointsInTheCellsAround)
{
    std::mt19937 random(5);
    std::uniform_real_distribution<double> anywhere(0, 0.3);
    std::vector<ale::SurfacePoint> points;
    ale::MeanSurface surface(low, high);
    for (int k = 0; k < 150; k++) {
        points.push_back({{anywhere(random), anywhere(random)}, up});
        surface.add(points.back());
    }
    for (const ale::SurfacePoint &point : points) {
        Eigen::Vector2d sum(0, 0);
        double count = 0;
        for (const ale::SurfacePoint &other : points) {
            if ((cell_of(other.p) - cell_of(point.p)).abs().maxCoeff() <= 1) {
                sum += other.p;
                count++;
            }
        }
        const auto mean = surface.around(point, count);
        ASSERT_TRUE(mean);
        EXPECT_LT((mean->p - sum / count).norm(), 1e-12);
        EXPECT_LT((mean->normal - up).norm(), 1e-12);
        EXPECT_FALSE(surface.around(point, count + 1));
    }
}

TEST(MeanSurface, TheSidesOfAThinPanelStayApart)
{
    ale::MeanSurface surface(low, high);
    for (int k = 0; k < 40; k++) {
        surface.add({{0.01 * k, 0.50}, up});
        surface.add({{0.01 * k, 0.52}, -up});
    }
    EXPECT_NEAR(surface.around({{0.2, 0.51}, up}, 8)->p.y(), 0.50, 1e-12);
    EXPECT_NEAR(surface.around({{0.2, 0.51}, -up}, 8)->p.y(), 0.52, 1e-12);
}

TEST(MeanSurface, PointsOutsideAreIgnored)
{
    ale::MeanSurface surface(low, high);
    const ale::SurfacePoint outside{{3.2, 0}, up};
    surface.add(outside);
    EXPECT_FALSE(surface.around(outside, 1));
}

} // namespace
