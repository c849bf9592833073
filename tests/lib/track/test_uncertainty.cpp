// lib/track/uncertainty.c: the covariance that is said, against random walks that make it.
#include <random>

#include <gtest/gtest.h>

#include "convert.h"

extern "C" {
#include "track/uncertainty.h"
}

TEST(Uncertainty, AHeadingThatDriftsOnTheWayMovesThePlaceAsManyRandomWalksDo)
{
    const Eigen::Vector2d place(6, 8);
    const double sigma = 0.02;
    const int steps = 100;
    std::mt19937 rng(4);
    std::normal_distribution<double> normal(0, sigma / std::sqrt(steps));
    Eigen::Matrix3d expected = Eigen::Matrix3d::Zero();
    const int walks = 6000;
    for (int k = 0; k < walks; k++) {
        Eigen::Vector3d error(0, 0, 0);
        for (int i = 0; i < steps; i++) {
            error[2] += normal(rng);
            error[0] -= error[2] * place[1] / steps;
            error[1] += error[2] * place[0] / steps;
        }
        expected += error * error.transpose() / walks;
    }
    ale_motion_t motion;
    ale_motion_init(&motion, 0, {convert::um(place[0]), convert::um(place[1]), convert::bam(0.7)}, 1, 1);
    int64_t cov[9];
    const ale_drift_here_t drift = {0, 0, 0, std::llround(sigma * sigma * 1e12)};
    ale_map_covariance(&motion, &drift, cov);
    for (int i = 0; i < 9; i++) {
        const double unit = (i / 3 == 2 ? 1e-9 : 1e-6) * (i % 3 == 2 ? 1e-9 : 1e-6);
        const double scale = std::sqrt(expected(i / 3, i / 3) * expected(i % 3, i % 3));
        EXPECT_NEAR(static_cast<double>(cov[i]) * unit, expected(i / 3, i % 3), 0.06 * scale) << i;
    }
}

TEST(Uncertainty, InformationIsThatOfTheScanInMillimetresAndMilliradians)
{
    ale_information_t sum = {};
    sum.matrix.m[0][0] = int64_t{1} << (ALE_MATRIX_BITS - 20);
    int64_t out[6];
    ale_scan_information(&sum, out);
    EXPECT_EQ(out[0], 1000000);
    EXPECT_EQ(out[3], 0);
}
