#include <gtest/gtest.h>

#include <chrono>
#include <random>

extern "C" {
#include "realtime/clock.h"
#include "realtime/rt.h"
}

namespace
{

int64_t since_1970_us()
{
    return std::chrono::duration_cast<std::chrono::microseconds>(
               std::chrono::system_clock::now().time_since_epoch())
        .count();
}

TEST(Clock, ScalingIsExactToAMicrosecond)
{
    std::mt19937_64 random(6);
    for (int k = 0; k < 20000; k++) {
        const auto us = static_cast<int64_t>(random() % 7000000000000000);
        const auto ppm = static_cast<int32_t>(10000 + random() % 99990000);
        const long double exact = static_cast<long double>(us) * ppm / 1e6L;
        EXPECT_NEAR(static_cast<double>(ale_clock_scaled(us, ppm) - exact), 0, 1.01);
    }
}

TEST(Clock, AMessagesTimeIsTheTimeOfDayTimesTheScale)
{
    for (const int32_t ppm : {ALE_CLOCK_REAL, 10 * ALE_CLOCK_REAL, ALE_CLOCK_REAL / 4}) {
        const ale_clock_t clock = ale_clock_start(ppm);
        const int64_t before = ale_clock_scaled(since_1970_us(), ppm);
        const int64_t utime = ale_clock_to_utime(&clock, ale_clock_now_us(&clock));
        const int64_t after = ale_clock_scaled(since_1970_us(), ppm);
        EXPECT_GE(utime, before - 100 * ppm / 1000000 - 10);
        EXPECT_LE(utime, after + 100 * ppm / 1000000 + 10);
    }
}

TEST(Clock, ConversionsAreInverse)
{
    const ale_clock_t clock = ale_clock_start(3 * ALE_CLOCK_REAL);
    EXPECT_EQ(ale_clock_from_utime(&clock, ale_clock_to_utime(&clock, 987654321)), 987654321);
    EXPECT_EQ(ale_clock_real_ns(&clock, 3000), 1000000);
}

TEST(Clock, ItRunsAtItsScale)
{
    const ale_clock_t clock = ale_clock_start(20 * ALE_CLOCK_REAL);
    const int64_t outer_ns = ale_rt_now_ns();
    const int64_t before = ale_clock_now_us(&clock);
    const int64_t inner_ns = ale_rt_now_ns();
    while (ale_rt_now_ns() < inner_ns + 20000000) {
    }
    const int64_t passed = ale_clock_now_us(&clock) - before;
    EXPECT_GE(passed, 20 * 20000 - 40);
    EXPECT_LE(passed, 20 * (ale_rt_now_ns() - outer_ns) / 1000 + 40);
}

} // namespace
