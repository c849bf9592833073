// drivers/scanner/rotary: host time of what is only counted, or stamped in whole milliseconds.
#include <cstdlib>
#include <random>

#include <gtest/gtest.h>

extern "C" {
#include "scanner/rotary/rotary_clock.h"
}

namespace
{

struct Line {
    double slope = 1;        // seconds of the host for a second of the sensor
    double delay_us = 300;   // always
    double jitter_us = 8000; // at most, as of an adapter that bundles its bytes
    double packet_us = 2667;
};

// The largest error after so many seconds, without the constant delay.
double error_after(const Line &line, double settle_s, double end_s)
{
    std::mt19937 random(7);
    std::uniform_real_distribution<double> share(0, 1);
    ale_rotary_clock_t clock{};
    double worst_us = 0;
    for (double sensor_us = 0; sensor_us < end_s * 1e6; sensor_us += line.packet_us) {
        const double true_us = 5e6 + sensor_us * line.slope;
        const double arrival_us = true_us + line.delay_us + line.jitter_us * share(random);
        const int64_t host_us =
            ale_rotary_clock_take(&clock, std::llround(sensor_us), std::llround(arrival_us));
        if (sensor_us > settle_s * 1e6) {
            worst_us = std::max(worst_us, std::fabs(static_cast<double>(host_us) - true_us - line.delay_us));
        }
    }
    EXPECT_EQ(clock.jumps, 0U);
    return worst_us;
}

TEST(RotaryClock, BundledBytesAreSeenThrough)
{
    EXPECT_LT(error_after({}, 0.5, 60), 4000) << "before its slope is known";
    EXPECT_LT(error_after({}, 5, 60), 1000);
}

TEST(RotaryClock, ARateThatIsOffByAPercentIsFound)
{
    for (const double slope : {0.985, 0.99, 1.005, 1.01, 1.02}) {
        Line line;
        line.slope = slope;
        EXPECT_LT(error_after(line, 10, 60), 900) << slope;
    }
}

TEST(RotaryClock, AComputerThatWasBusyMovesItLittle)
{
    ale_rotary_clock_t clock{};
    for (int64_t us = 0; us < 10000000; us += 2500) {
        const int64_t late_us = us > 6000000 && us < 6300000 ? 6300000 - us : 0;
        const int64_t host_us = ale_rotary_clock_take(&clock, us, us + late_us);
        EXPECT_LE(std::llabs(host_us - us), 700) << us;
    }
}

TEST(RotaryClock, AnotherClockIsTakenAsOne)
{
    ale_rotary_clock_t clock{};
    ale_rotary_clock_take(&clock, 1000000, 5000000);
    ale_rotary_clock_take(&clock, 1010000, 5010000);
    EXPECT_EQ(ale_rotary_clock_take(&clock, 1020000, 7000000), 7000000) << "it stood still for two seconds";
    EXPECT_EQ(clock.jumps, 1U);
    EXPECT_EQ(ale_rotary_clock_take(&clock, 20000000, 7010000), 7010000) << "it began anew";
    EXPECT_EQ(clock.jumps, 2U);
}

} // namespace
