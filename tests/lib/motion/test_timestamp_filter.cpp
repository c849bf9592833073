// lib/motion/timestamp_filter.c: the even pace behind stamps that jitter.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

extern "C" {
#include "motion/timestamp_filter.h"
}

TEST(Pace, EvenStampsAreTakenAsTheyAre)
{
    ale_pace_t pace;
    ale_pace_init(&pace);
    for (int k = 0; k < 200; k++) {
        const int64_t stamp_us = 5000000 + 100000 * k + k % 3;
        EXPECT_EQ(ale_pace_instant(&pace, stamp_us), stamp_us);
    }
}

TEST(Pace, JitterOfTwentyMillisecondsShrinksToAThird)
{
    std::mt19937 rng(3);
    std::uniform_real_distribution<double> jitter(-25000, 25000);
    ale_pace_t pace;
    ale_pace_init(&pace);
    double sum = 0;
    double raw = 0;
    for (int k = 0; k < 600; k++) {
        const double truth = 98690.0 * k;
        const double error = jitter(rng);
        const int64_t instant = ale_pace_instant(&pace, std::llround(truth + error));
        if (k >= 60) {
            sum += (static_cast<double>(instant) - truth) * (static_cast<double>(instant) - truth);
            raw += error * error;
        }
    }
    EXPECT_LT(std::sqrt(sum / 540), std::sqrt(raw / 540) / 3);
}

TEST(Pace, GoesOnAfterScansThatAreMissing)
{
    std::mt19937 rng(4);
    std::uniform_real_distribution<double> jitter(-20000, 20000);
    ale_pace_t pace;
    ale_pace_init(&pace);
    double worst = 0;
    for (int k = 0; k < 400; k++) {
        if (k % 50 == 47 || k % 50 == 48) {
            continue;
        }
        const double truth = 100000.0 * k;
        const int64_t instant = ale_pace_instant(&pace, std::llround(truth + jitter(rng)));
        if (k > 60) {
            worst = std::max(worst, std::abs(static_cast<double>(instant) - truth));
        }
    }
    EXPECT_LT(worst, 20000);
}

TEST(Pace, StampsWithoutAPaceAreTakenAsTheyAre)
{
    std::mt19937 rng(5);
    std::uniform_real_distribution<double> gap(50000, 1900000);
    ale_pace_t pace;
    ale_pace_init(&pace);
    double t = 0;
    int changed = 0;
    for (int k = 0; k < 200; k++) {
        t += gap(rng);
        changed += k > 40 && ale_pace_instant(&pace, std::llround(t)) != std::llround(t);
    }
    EXPECT_LT(changed, 5);
}

TEST(Pace, AStepBackOrALongPauseTakesThePaceUpAnew)
{
    ale_pace_t pace;
    ale_pace_init(&pace);
    for (int k = 0; k < 50; k++) {
        ale_pace_instant(&pace, 100000 * k);
    }
    EXPECT_EQ(ale_pace_instant(&pace, 1234), 1234);
    EXPECT_EQ(ale_pace_instant(&pace, 101234), 101234);
    EXPECT_EQ(ale_pace_instant(&pace, 10101234), 10101234);
    EXPECT_EQ(pace.scans, 1u);
}

TEST(Pace, ALogThatHoldsAScanNowAndThenKeepsItsStamps)
{
    std::mt19937 rng(9);
    std::normal_distribution<double> jitter(0, 60000);
    ale_pace_t pace;
    ale_pace_init(&pace);
    for (int k = 0; k < 100; k++) {
        const int64_t stamp = 1000000 * int64_t{k} + std::llround(jitter(rng));
        EXPECT_EQ(ale_pace_instant(&pace, stamp), stamp);
    }
}

TEST(Pace, ScansStampedAtOnceAreNotBelievedToFollowAtOnce)
{
    ale_pace_t pace;
    ale_pace_init(&pace);
    EXPECT_TRUE(ale_pace_believes(&pace, 0));
    for (int k = 0; k < 40; k++) {
        ale_pace_instant(&pace, 900000 * int64_t{k});
    }
    EXPECT_FALSE(ale_pace_believes(&pace, 2000));
    EXPECT_TRUE(ale_pace_believes(&pace, 500000));
    EXPECT_TRUE(ale_pace_believes(&pace, 5000000));
}
