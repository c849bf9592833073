// lib/match/uncertainty.c: the covariance that is said.
#include <gtest/gtest.h>

#include "lib/motion/convert.h"

extern "C" {
#include "match/uncertainty.h"
}

TEST(Uncertainty, OfAPoseIsThatToTheWallsAndTheDriftWhereItIsAndWhatTheWheelsHaveMadeOfIt)
{
    ale_motion_t motion;
    ale_motion_init(&motion, 0, {6000000, 8000000, convert::bam(0.7)}, 1, 1);
    ale_motion_widen(&motion, 2000, 1000);
    const double turn = 0.02;
    const ale_map_uncertainty_t map_uncertainty = {9000000, 0, 9000000,
                                                   0,       0, std::llround(turn * turn * 1e12)};
    const ale_scale_error_t scale_error = {30000, -40000};
    int64_t cov[9];
    ale_map_covariance(&motion, &map_uncertainty, &scale_error, cov);
    const double white = 4e-6 + 9e-6;
    const double expected[9] = {white + turn * turn * 64 + 9e-4,
                                -turn * turn * 48 - 12e-4,
                                -turn * turn * 8,
                                -turn * turn * 48 - 12e-4,
                                white + turn * turn * 36 + 16e-4,
                                turn * turn * 6,
                                -turn * turn * 8,
                                turn * turn * 6,
                                turn * turn + 1e-6};
    for (int i = 0; i < 9; i++) {
        const double unit = (i / 3 == 2 ? 1e-9 : 1e-6) * (i % 3 == 2 ? 1e-9 : 1e-6);
        EXPECT_NEAR(static_cast<double>(cov[i]) * unit, expected[i], 1e-4 * std::abs(expected[i]) + 1e-9)
            << i;
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
