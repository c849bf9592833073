// lib/base/trig.c against the mathematics library.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <random>

extern "C" {
#include "base/trig.h"
}

namespace
{

constexpr double pi = 3.14159265358979323846;
constexpr double q30 = 1073741824.0;

double radians(uint32_t bam)
{
    return bam * (2 * pi / 4294967296.0);
}

TEST(Trig, SineAndCosineAreWithinTwoUnits)
{
    std::mt19937 engine(3);
    for (int k = 0; k < 300000; k++) {
        const uint32_t angle = static_cast<uint32_t>(engine());
        EXPECT_NEAR(ale_sin_q30(angle), std::sin(radians(angle)) * q30, 2.0);
        EXPECT_NEAR(ale_cos_q30(angle), std::cos(radians(angle)) * q30, 2.0);
        EXPECT_EQ(ale_direction(angle).sin_q30, ale_sin_q30(angle));
        EXPECT_NEAR(ale_direction(angle).cos_q30, std::cos(radians(angle)) * q30, 2.0);
    }
}

TEST(Trig, EveryTableEntryIsTheNearestInteger)
{
    for (uint32_t k = 0; k < 1024; k++) {
        const ale_direction_t direction = ale_direction(k << 22);
        EXPECT_EQ(direction.sin_q30, std::lround(std::sin(radians(k << 22)) * q30)) << k;
        EXPECT_EQ(direction.cos_q30, std::lround(std::cos(radians(k << 22)) * q30)) << k;
    }
}

TEST(Trig, SymmetryIsExact)
{
    std::mt19937 engine(4);
    constexpr uint32_t half_step = 1u << 21;
    for (uint32_t k = 0; k < 100000; k++) {
        const uint32_t angle = k < 2048 ? k * half_step : static_cast<uint32_t>(engine());
        EXPECT_EQ(ale_sin_q30(0u - angle), -ale_sin_q30(angle));
        EXPECT_EQ(ale_cos_q30(0u - angle), ale_cos_q30(angle));
        EXPECT_EQ(ale_sin_q30(angle + ALE_BAM_HALF_TURN), -ale_sin_q30(angle));
        EXPECT_EQ(ale_cos_q30(angle), ale_sin_q30(angle + ALE_BAM_QUARTER_TURN));
        EXPECT_EQ(ale_direction(0u - angle).cos_q30, ale_direction(angle).cos_q30);
        EXPECT_EQ(ale_direction(angle + ALE_BAM_HALF_TURN).cos_q30, -ale_direction(angle).cos_q30);
    }
}

TEST(Trig, ArcTangentIsWithinThreeBam)
{
    std::mt19937_64 engine(5);
    for (int k = 0; k < 300000; k++) {
        const unsigned bits = 2 + static_cast<unsigned>(engine() % 60);
        const int64_t x = static_cast<int64_t>(engine() >> (64 - bits)) - (int64_t{1} << (bits - 1));
        const int64_t y = static_cast<int64_t>(engine() >> (64 - bits)) - (int64_t{1} << (bits - 1));
        if (x == 0 && y == 0) {
            continue;
        }
        const double expected = std::atan2(static_cast<double>(y), static_cast<double>(x));
        const double error = std::remainder(radians(ale_atan2_bam(y, x)) - expected, 2 * pi);
        EXPECT_NEAR(error / (2 * pi) * 4294967296.0, 0.0, 3.0) << y << ", " << x;
    }
    EXPECT_EQ(ale_atan2_bam(0, 0), 0u);
    EXPECT_EQ(ale_atan2_bam(1, 0), ALE_BAM_QUARTER_TURN);
    EXPECT_EQ(ale_atan2_bam(0, -1), ALE_BAM_HALF_TURN);
}

TEST(Trig, BamAndNanoradiansConvertBothWays)
{
    std::mt19937 engine(6);
    for (int k = 0; k < 100000; k++) {
        const int32_t angle = static_cast<int32_t>(static_cast<uint32_t>(engine()));
        EXPECT_NEAR(static_cast<double>(ale_bam_to_nrad(angle)), angle * (pi / 2147483648.0) * 1e9, 1.0);
        EXPECT_NEAR(ale_nrad_to_bam(ale_bam_to_nrad(angle)), angle, 1.0);
    }
}

} // namespace
