#include <gtest/gtest.h>

#include <cmath>
#include <random>

extern "C" {
#include "scanner/urg/sensor_clock.h"
}

namespace
{

constexpr int64_t latency_us = 100000;

// A sensor whose quartz runs `ppm` slow, and a host that sees each reply with a one-sided delay.
class SensorClock : public testing::Test
{
  protected:
    ale_sensor_clock_t clock{};
    std::mt19937 random{21};
    double ppm = 0;
    uint32_t first_stamp_ms = 1234;
    int64_t worst_late_us = 4000;

    void SetUp() override
    {
        ale_sensor_clock_reset(&clock, latency_us);
    }
    int64_t true_us(int scan) const
    {
        return 7000000 + static_cast<int64_t>(std::llround(scan * 100000.0 * (1.0 + ppm * 1e-6)));
    }
    uint32_t stamp_ms(int scan) const
    {
        return (first_stamp_ms + static_cast<uint32_t>(scan) * 100U) & 0xffffffU;
    }
    int64_t arrival_us(int scan)
    {
        return true_us(scan) + latency_us +
               static_cast<int64_t>(random() % static_cast<uint64_t>(worst_late_us + 1));
    }
    int64_t update(int scan)
    {
        return ale_sensor_clock_update(&clock, stamp_ms(scan), arrival_us(scan));
    }
};

TEST_F(SensorClock, offset_is_that_of_the_least_delayed_reply)
{
    for (int k = 0; k < 2000; k++) {
        const int64_t error_us = update(k) - true_us(k);
        if (k > 100) {
            ASSERT_GE(error_us, -200) << k;
            ASSERT_LE(error_us, 600) << k;
        }
    }
}

TEST_F(SensorClock, rate_of_the_quartz_is_found)
{
    for (const double slow : {-80.0, 0.0, 35.0, 80.0}) {
        SetUp();
        ppm = slow;
        for (int k = 0; k < 3000; k++) {
            const int64_t error_us = update(k) - true_us(k);
            if (k > 700) {
                ASSERT_NEAR(static_cast<double>(error_us), 0.0, 1200.0) << slow << " ppm, scan " << k;
            }
        }
        EXPECT_NEAR(clock.rate_ppb, slow * 1000, 5000.0);
    }
}

TEST_F(SensorClock, distance_of_two_stamps_is_hardly_touched)
{
    ppm = 30;
    int64_t before_us = update(0);
    for (int k = 1; k < 3000; k++) {
        const int64_t now_us = update(k);
        if (k > 100) {
            ASSERT_NEAR(static_cast<double>(now_us - before_us), 100000.0, 1000.0) << k;
            ASSERT_LE(now_us - before_us, 100000 + ALE_CLOCK_SLEW_US + 60);
        }
        before_us = now_us;
    }
}

TEST_F(SensorClock, wrap_of_24_bits_is_invisible)
{
    first_stamp_ms = 0xffffff - 5000;
    worst_late_us = 0;
    const int64_t first_us = update(0);
    for (int k = 1; k < 200; k++) {
        ASSERT_EQ(ale_sensor_clock_judge(&clock, stamp_ms(k), arrival_us(k)), ALE_STAMP_NEW);
        ASSERT_EQ(update(k) - first_us, int64_t{k} * 100000);
    }
}

TEST_F(SensorClock, busy_host_that_reads_late_disturbs_nothing)
{
    for (int k = 0; k < 600; k++) {
        const bool late = k >= 300 && k < 303;
        const int64_t seen_us = late ? true_us(303) + latency_us : arrival_us(k);
        ASSERT_EQ(ale_sensor_clock_judge(&clock, stamp_ms(k), seen_us), ALE_STAMP_NEW) << k;
        const int64_t stamp_us = ale_sensor_clock_update(&clock, stamp_ms(k), seen_us);
        if (k > 100) {
            ASSERT_NEAR(static_cast<double>(stamp_us - true_us(k)), 0.0, 700.0) << k;
        }
    }
}

TEST_F(SensorClock, repeated_and_older_stamps_are_told_from_a_counter_that_was_set)
{
    for (int k = 0; k < 100; k++) {
        update(k);
    }
    const int64_t at_us = true_us(100) + latency_us;
    EXPECT_EQ(ale_sensor_clock_judge(&clock, stamp_ms(99), at_us), ALE_STAMP_REPEATED);
    EXPECT_EQ(ale_sensor_clock_judge(&clock, stamp_ms(97), at_us), ALE_STAMP_REPEATED);
    EXPECT_EQ(ale_sensor_clock_judge(&clock, stamp_ms(100), at_us), ALE_STAMP_NEW);
    EXPECT_EQ(ale_sensor_clock_judge(&clock, 100, at_us), ALE_STAMP_JUMPED) << "the sensor was reset";
    EXPECT_EQ(ale_sensor_clock_judge(&clock, stamp_ms(600), at_us), ALE_STAMP_JUMPED);
    EXPECT_EQ(ale_sensor_clock_judge(&clock, stamp_ms(600), true_us(600) + latency_us), ALE_STAMP_NEW)
        << "a minute of silence";
}

TEST_F(SensorClock, a_recording_whose_time_runs_backwards_is_no_overflow)
{
    constexpr int64_t step_ms = (1 << 23) - 1; /* 2.3 hours, the most that one stamp can be after another */
    constexpr int steps = 400;
    int64_t now_ms = 0;
    for (int k = 0; k < 2 * steps + 8; k++) {
        const int64_t late_us = k < steps ? 0 : 1000;
        now_ms += k < steps ? -step_ms : step_ms;
        const uint32_t stamp = static_cast<uint32_t>(now_ms & 0xffffff);
        const int64_t at_us = now_ms * 1000 + latency_us + late_us;
        ASSERT_EQ(ale_sensor_clock_judge(&clock, stamp, at_us), ALE_STAMP_NEW) << k;
        ASSERT_NEAR(static_cast<double>(ale_sensor_clock_update(&clock, stamp, at_us) - now_ms * 1000), 0,
                    2000)
            << k;
    }
    EXPECT_GT(clock.blocks_seen, static_cast<uint64_t>(ALE_CLOCK_RATE_BLOCKS));
}

TEST_F(SensorClock, samples_give_the_same_times_in_every_run)
{
    int64_t sum[2] = {0, 0};
    for (int64_t &total : sum) {
        SetUp();
        random.seed(5);
        for (int k = 0; k < 1000; k++) {
            total += update(k) * (k + 1);
        }
    }
    EXPECT_EQ(sum[0], sum[1]);
}

TEST(StampDifference, is_modular)
{
    EXPECT_EQ(ale_stamp_difference_ms(5, 0xfffffe), 7);
    EXPECT_EQ(ale_stamp_difference_ms(0xfffffe, 5), -7);
    EXPECT_EQ(ale_stamp_difference_ms(100, 100), 0);
}

} // namespace
