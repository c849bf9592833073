// lib/motion/lag.c: the lag between scanner and wheels is found from turns.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "convert.h"

extern "C" {
#include "motion/lag.h"
#include "motion/motion.h"
}

namespace
{
// A robot that turns to and fro; its heading and turning speed at a time.
double heading(double t, double size)
{
    return size * (1 - std::cos(1.3 * t)) + 0.2 * size * std::sin(2.9 * t);
}

double turning(double t, double size)
{
    return size * 1.3 * std::sin(1.3 * t) + 0.2 * size * 2.9 * std::cos(2.9 * t);
}

ale_lag_t drive(double lag_s, double size, int32_t prior_us, double noise, double wheel_period_s = 0.1)
{
    ale_lag_t lag;
    ale_wheels_t wheels;
    ale_lag_init(&lag, prior_us);
    ale_wheels_init(&wheels, 2000, 6000);
    std::mt19937 rng(7);
    std::normal_distribution<double> normal;
    double error = 0;
    double next_wheel = 0;
    for (int k = 0; k < 300; k++) {
        const double t = 1 + 0.1 * k;
        for (; next_wheel <= t; next_wheel += wheel_period_s) {
            error += noise * normal(rng) * std::sqrt(wheel_period_s / 0.1);
            const double h = heading(next_wheel + lag_s, size) + error;
            const ale_odometry_t s = {std::llround(next_wheel * 1e6),
                                      convert::pose(reference::Pose(0, 0, h))};
            ale_wheels_add(&wheels, &s);
        }
        const double tick_s = 0.131072;
        const ale_heading_t seen = {std::llround(t * 1e6),
                                    convert::bam(heading(t, size) + 0.001 * normal(rng)),
                                    static_cast<int32_t>(turning(t, size) * tick_s * 1e6)};
        ale_lag_add_heading(&lag, &seen);
        ale_lag_update(&lag, &wheels);
    }
    return lag;
}
} // namespace

TEST(Lag, IsFoundWithinItsOwnSigmasWhateverThePriorSays)
{
    for (double lag_s : {-0.05, 0.0, 0.04, 0.11, 0.155, 0.2}) {
        const ale_lag_t lag = drive(lag_s, 1.0, 0, 0.007);
        EXPECT_NEAR(lag.lag_us, lag_s * 1e6, 10000) << lag_s;
        EXPECT_LT(std::abs(lag.lag_us - lag_s * 1e6), 4 * lag.sigma_us + 2000) << lag_s;
    }
}

TEST(Lag, IsFoundWithFastWheelsToo)
{
    EXPECT_NEAR(drive(0.12, 1.0, 0, 0.004, 0.02).lag_us, 120000, 10000);
}

TEST(Lag, OfARobotThatDrivesStraightStaysThePriorAndUnsure)
{
    const ale_lag_t lag = drive(0.1, 0.001, 155000, 0.007);
    EXPECT_EQ(lag.lag_us, 155000);
    EXPECT_EQ(lag.sigma_us, ALE_LAG_PRIOR_SIGMA_US);
}

TEST(Lag, IsNotLearntFromWheelsThatSlip)
{
    ale_lag_t lag;
    ale_wheels_t wheels;
    ale_lag_init(&lag, 0);
    ale_wheels_init(&wheels, 2000, 6000);
    for (int k = 0; k < 100; k++) {
        const ale_odometry_t s = {100000 * k, convert::pose(reference::Pose(0, 0, 0.3 * k))};
        const ale_heading_t h = {100000 * k, convert::bam(0.05 * std::sin(0.9 * k)), 0};
        ale_wheels_add(&wheels, &s);
        ale_lag_add_heading(&lag, &h);
        ale_lag_update(&lag, &wheels);
    }
    EXPECT_EQ(lag.lag_us, 0);
}
