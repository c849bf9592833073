#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <vector>

extern "C" {
#include "telemetry/durations.h"
}

namespace
{

TEST(Durations, AnEmptyOneIsZero)
{
    const auto durations = std::make_unique<ale_durations_t>();
    EXPECT_EQ(ale_durations_quantile(durations.get(), 990), 0);
}

TEST(Durations, OneValueIsEveryQuantile)
{
    auto durations = std::make_unique<ale_durations_t>();
    ale_durations_add(durations.get(), 123456);
    EXPECT_EQ(ale_durations_quantile(durations.get(), 0), 0);
    EXPECT_EQ(ale_durations_quantile(durations.get(), 500), 123456);
    EXPECT_EQ(durations->worst_ns, 123456);
    EXPECT_EQ(durations->last_ns, 123456);
}

TEST(Durations, QuantilesAreNeverTooSmallAndAtMostAnEighthTooLarge)
{
    std::mt19937_64 random(5);
    std::lognormal_distribution<double> spread(11, 2);
    for (int trial = 0; trial < 20; trial++) {
        auto durations = std::make_unique<ale_durations_t>();
        std::vector<int64_t> values(2000);
        for (int64_t &value : values) {
            value = static_cast<int64_t>(spread(random));
            ale_durations_add(durations.get(), value);
        }
        std::sort(values.begin(), values.end());
        for (const uint32_t permille : {1u, 100u, 500u, 900u, 990u, 1000u}) {
            const int64_t exact = values[(values.size() * permille + 999) / 1000 - 1];
            const int64_t found = ale_durations_quantile(durations.get(), permille);
            EXPECT_GE(found, exact);
            EXPECT_LE(static_cast<double>(found), static_cast<double>(exact) * 1.125 + 1);
        }
        EXPECT_EQ(durations->worst_ns, values.back());
    }
}

TEST(Durations, OctavesAreAHistogramOfEveryValue)
{
    std::mt19937 random(5);
    std::uniform_real_distribution<double> exponent(-1, 41);
    auto durations = std::make_unique<ale_durations_t>();
    std::vector<uint32_t> expected(43);
    for (int k = 0; k < 5000; k++) {
        const auto value = static_cast<int64_t>(std::exp2(exponent(random)));
        expected[value < 2 ? 0 : static_cast<size_t>(std::ilogb(static_cast<double>(value)))]++;
        ale_durations_add(durations.get(), value);
    }
    for (uint32_t octave = 0; octave < expected.size(); octave++) {
        EXPECT_EQ(ale_durations_octave(durations.get(), octave), expected[octave]) << "octave " << octave;
    }
}

TEST(Durations, ExtremesAreTaken)
{
    auto durations = std::make_unique<ale_durations_t>();
    ale_durations_add(durations.get(), -5);
    ale_durations_add(durations.get(), INT64_MAX);
    EXPECT_EQ(durations->count, 2u);
    EXPECT_EQ(ale_durations_quantile(durations.get(), 500), 0);
    EXPECT_EQ(durations->worst_ns, INT64_MAX);
}

} // namespace
