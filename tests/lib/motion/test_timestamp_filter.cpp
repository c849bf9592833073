// lib/motion/timestamp_filter.c: the even pace behind stamps that jitter.
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

extern "C" {
#include "motion/timestamp_filter.h"
}

TEST(Pace, EvenStampsAreTakenAsTheyAre)
{
    ale_timestamp_filter_t timestamp_filter;
    ale_timestamp_filter_init(&timestamp_filter);
    for (int k = 0; k < 200; k++) {
        const int64_t stamp_us = 5000000 + 100000 * k + k % 3;
        EXPECT_EQ(ale_timestamp_filter_instant(&timestamp_filter, stamp_us), stamp_us);
    }
}

TEST(Pace, JitterOfTwentyMillisecondsShrinksToAThird)
{
    std::mt19937 rng(3);
    std::uniform_real_distribution<double> jitter(-25000, 25000);
    ale_timestamp_filter_t timestamp_filter;
    ale_timestamp_filter_init(&timestamp_filter);
    double sum = 0;
    double raw = 0;
    for (int k = 0; k < 600; k++) {
        const double truth = 98690.0 * k;
        const double error = jitter(rng);
        const int64_t instant = ale_timestamp_filter_instant(&timestamp_filter, std::llround(truth + error));
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
    ale_timestamp_filter_t timestamp_filter;
    ale_timestamp_filter_init(&timestamp_filter);
    double worst = 0;
    for (int k = 0; k < 400; k++) {
        if (k % 50 == 47 || k % 50 == 48) {
            continue;
        }
        const double truth = 100000.0 * k;
        const int64_t instant =
            ale_timestamp_filter_instant(&timestamp_filter, std::llround(truth + jitter(rng)));
        if (k > 60) {
            worst = std::max(worst, std::abs(static_cast<double>(instant) - truth));
        }
    }
    EXPECT_LT(worst, 20000);
}

// Of scans that come after times by chance: how many do not keep their stamps.
static int changed_of_uneven(double least_us, double most_us, int scans, unsigned seed)
{
    std::mt19937 rng(seed);
    std::uniform_real_distribution<double> gap(least_us, most_us);
    ale_timestamp_filter_t timestamp_filter;
    ale_timestamp_filter_init(&timestamp_filter);
    double t = 0;
    int changed = 0;
    for (int k = 0; k < scans; k++) {
        t += gap(rng);
        const int64_t stamp_us = std::llround(t);
        changed += ale_timestamp_filter_instant(&timestamp_filter, stamp_us) != stamp_us;
    }
    return changed;
}

TEST(Pace, StampsWithoutAPaceAreTakenAsTheyAre)
{
    EXPECT_LT(changed_of_uneven(50000, 1900000, 200, 5), 5);
}

TEST(Pace, AStepBackOrALongPauseTakesThePaceUpAnew)
{
    ale_timestamp_filter_t timestamp_filter;
    ale_timestamp_filter_init(&timestamp_filter);
    for (int k = 0; k < 50; k++) {
        ale_timestamp_filter_instant(&timestamp_filter, 100000 * k);
    }
    EXPECT_EQ(ale_timestamp_filter_instant(&timestamp_filter, 1234), 1234);
    EXPECT_EQ(ale_timestamp_filter_instant(&timestamp_filter, 101234), 101234);
    EXPECT_EQ(ale_timestamp_filter_instant(&timestamp_filter, 10101234), 10101234);
    EXPECT_EQ(timestamp_filter.scans, 1u);
}

TEST(Pace, ALogThatHoldsAScanNowAndThenKeepsItsStamps)
{
    std::mt19937 rng(9);
    std::normal_distribution<double> jitter(0, 60000);
    ale_timestamp_filter_t timestamp_filter;
    ale_timestamp_filter_init(&timestamp_filter);
    for (int k = 0; k < 100; k++) {
        const int64_t stamp = 1000000 * int64_t{k} + std::llround(jitter(rng));
        EXPECT_EQ(ale_timestamp_filter_instant(&timestamp_filter, stamp), stamp);
    }
}

TEST(Pace, ScansStampedAtOnceAreNotBelievedToFollowAtOnce)
{
    ale_timestamp_filter_t timestamp_filter;
    ale_timestamp_filter_init(&timestamp_filter);
    EXPECT_TRUE(ale_timestamp_filter_accepts(&timestamp_filter, 0));
    for (int k = 0; k < 40; k++) {
        ale_timestamp_filter_instant(&timestamp_filter, 900000 * int64_t{k});
    }
    EXPECT_FALSE(ale_timestamp_filter_accepts(&timestamp_filter, 2000));
    EXPECT_TRUE(ale_timestamp_filter_accepts(&timestamp_filter, 500000));
    EXPECT_TRUE(ale_timestamp_filter_accepts(&timestamp_filter, 5000000));
}

TEST(Pace, AGapIsJudgedByWhatWasUsualBefore)
{
    ale_timestamp_filter_t timestamp_filter;
    ale_timestamp_filter_init(&timestamp_filter);
    EXPECT_EQ(timestamp_filter.usual_before_us, 0);
    for (int k = 0; k < 40; k++) {
        ale_timestamp_filter_instant(&timestamp_filter, 100000 * (k + 1));
    }
    ale_timestamp_filter_instant(&timestamp_filter, 12000000);
    EXPECT_EQ(timestamp_filter.usual_before_us, 100000);
    EXPECT_GT(timestamp_filter.usual_us, 200000);
    ale_timestamp_filter_instant(&timestamp_filter, 12100000);
    EXPECT_GT(timestamp_filter.usual_before_us, 200000);
}

TEST(Pace, StampsThatComeThreeAtOnceMakeASecondWithoutAScanUsualAndOneOutageDoesNot)
{
    ale_timestamp_filter_t crowded;
    ale_timestamp_filter_t even;
    ale_timestamp_filter_init(&crowded);
    ale_timestamp_filter_init(&even);
    for (int k = 0; k < 200; k++) {
        ale_timestamp_filter_instant(&crowded, 600000 * (k / 3) + 1000 * (k % 3));
        ale_timestamp_filter_instant(&even, 200000 * k);
    }
    EXPECT_GT(ale_timestamp_filter_usual_most_us(&crowded), 1000000);
    EXPECT_LT(ale_timestamp_filter_usual_most_us(&even), 210000);
    ale_timestamp_filter_instant(&even, 44000000);
    EXPECT_LT(ale_timestamp_filter_usual_most_us(&even), 400000) << "it is judged by what was usual before";
}

TEST(Pace, ALogOfEveryFifthScanIsNotDense)
{
    for (const bool dense : {true, false}) {
        ale_timestamp_filter_t timestamp_filter;
        ale_timestamp_filter_init(&timestamp_filter);
        EXPECT_FALSE(ale_timestamp_filter_is_dense(&timestamp_filter));
        for (int k = 0; k < 40; k++) {
            ale_timestamp_filter_instant(&timestamp_filter, int64_t{k} * (dense ? 100000 : 500000));
        }
        EXPECT_EQ(ale_timestamp_filter_is_dense(&timestamp_filter), dense);
    }
}

// A queue that lets go what it holds once in a while, and a part of it in the wrong order.
static std::vector<int64_t> queued_stamps(int scans, double period_us, std::mt19937 &rng)
{
    std::uniform_real_distribution<double> chance(0, 1);
    std::vector<int64_t> stamps;
    double flushed = 0;
    for (int k = 0; k < scans; k++) {
        const double taken = period_us * k;
        flushed = flushed < taken ? taken + chance(rng) * 4 * period_us : flushed;
        const double held_up = chance(rng) < 0.1 ? chance(rng) * 2 * period_us : 0;
        stamps.push_back(std::llround(flushed + held_up) + k % 3 * 500);
    }
    return stamps;
}

TEST(Pace, ScansThatAQueueHeldUpWereTakenAtAnEvenPace)
{
    for (const unsigned seed : {1U, 2U, 3U, 4U, 5U}) {
        std::mt19937 rng(seed);
        ale_timestamp_filter_t timestamp_filter;
        ale_timestamp_filter_init(&timestamp_filter);
        int64_t before = 0;
        int64_t at_once = 0;
        int uneven = 0;
        const std::vector<int64_t> stamps = queued_stamps(1000, 200000, rng);
        for (size_t k = 0; k < stamps.size(); k++) {
            const int64_t instant = ale_timestamp_filter_instant(&timestamp_filter, stamps[k]);
            uneven += k > 200 && std::abs(instant - before - 200000) > 50000;
            at_once += k > 200 && std::abs(stamps[k] - stamps[k - 1] - 200000) > 50000;
            before = instant;
        }
        EXPECT_GT(at_once, 500);
        EXPECT_LT(uneven, 10);
    }
}

TEST(Pace, ScansThatComeAtUnevenTimesAreNotTakenForQueued)
{
    for (const unsigned seed : {1U, 2U, 3U, 4U, 5U}) {
        EXPECT_LT(changed_of_uneven(50000, 350000, 1000, seed), 20);
    }
}

TEST(Pace, AQueueThatWasEmptyForALongTimeKeepsItsPace)
{
    std::mt19937 rng(6);
    ale_timestamp_filter_t timestamp_filter;
    ale_timestamp_filter_init(&timestamp_filter);
    const std::vector<int64_t> stamps = queued_stamps(600, 200000, rng);
    int64_t before = 0;
    for (size_t k = 0; k < stamps.size(); k++) {
        const int64_t pause = k < 300 ? 0 : 20000000;
        const int64_t instant = ale_timestamp_filter_instant(&timestamp_filter, stamps[k] + pause);
        if (k == 300) {
            EXPECT_EQ(instant, stamps[k] + pause);
        } else if (k > 200) {
            EXPECT_NEAR(static_cast<double>(instant - before), 200000, 60000);
        }
        before = instant;
    }
}
