// One wall or two: residuals that a second wall explains, and those that it does not.
#include <gtest/gtest.h>

#include <cmath>
#include <Eigen/QR>
#include <random>

#include "robot/calibrate/bend.h"

namespace
{

constexpr Eigen::Index beams = 120;
constexpr Eigen::Index least = 15;

/* Of ranges by parabola, line and constant: what bias, angle and distance do to them. */
Eigen::MatrixXd jacobian()
{
    Eigen::MatrixXd j(beams, 3);
    for (Eigen::Index k = 0; k < beams; k++) {
        const double x = static_cast<double>(k) / beams - 0.5;
        j.row(k) << 1, x, x * x;
    }
    return j;
}

Eigen::VectorXd residual_of(const Eigen::VectorXd &ranges)
{
    const Eigen::MatrixXd j = jacobian();
    return ranges - j * j.colPivHouseholderQr().solve(ranges);
}

Eigen::VectorXd noise(double sigma)
{
    std::mt19937 rng(4);
    std::normal_distribution<double> normal(0, sigma);
    return Eigen::VectorXd::NullaryExpr(beams, [&] { return normal(rng); });
}

TEST(Bend, TwoWallsAreCutWhereTheyMeet)
{
    Eigen::VectorXd ranges = noise(0.0003);
    for (Eigen::Index k = 70; k < beams; k++) {
        ranges(k) += 0.001 * static_cast<double>(k - 70);
    }
    const auto bend = calibrate::bend_of(jacobian(), residual_of(ranges), least);
    ASSERT_TRUE(bend);
    EXPECT_NEAR(static_cast<double>(*bend), 70, 3);
}

TEST(Bend, NoiseMakesNone)
{
    EXPECT_FALSE(calibrate::bend_of(jacobian(), residual_of(noise(0.005)), least));
}

TEST(Bend, NeitherDoWavesAlongTheWall)
{
    Eigen::VectorXd ranges = noise(0.0003);
    for (Eigen::Index k = 0; k < beams; k++) {
        ranges(k) += 0.01 * std::sin(0.4 * static_cast<double>(k));
    }
    EXPECT_FALSE(calibrate::bend_of(jacobian(), residual_of(ranges), least));
}

TEST(Bend, AWallTooShortForTwoIsOne)
{
    const Eigen::MatrixXd j = jacobian().topRows(2 * least - 1);
    EXPECT_FALSE(calibrate::bend_of(j, Eigen::VectorXd::LinSpaced(2 * least - 1, 0, 1), least));
}

} // namespace
