// lib/motion/odometry.c: the buffer of the wheels.
#include <gtest/gtest.h>

#include "convert.h"

extern "C" {
#include "motion/odometry.h"
}

namespace
{
struct Wheels : testing::Test {
    ale_wheels_t wheels;
    void SetUp() override
    {
        ale_wheels_init(&wheels, 2000, 4000);
    }
    void add(int64_t t_ms, double x, double y, double h)
    {
        const ale_odometry_t s = {t_ms * 1000, convert::pose(reference::Pose(x, y, h))};
        ale_wheels_add(&wheels, &s);
    }
    bool at(int64_t t_ms, ale_pose_t *p)
    {
        return ale_wheels_at(&wheels, t_ms * 1000, p, &beyond_us);
    }
    int32_t beyond_us = 0;
};
} // namespace

TEST_F(Wheels, InterpolateBetweenSamplesAlsoAcrossTheWrapOfTheHeading)
{
    add(0, 0, 0, 3.10);
    add(100, 0.1, 0.02, -3.10);
    ale_pose_t p;
    ASSERT_TRUE(at(50, &p));
    EXPECT_EQ(beyond_us, 0);
    EXPECT_NEAR(p.x_um, 50000, 1);
    EXPECT_NEAR(p.y_um, 10000, 1);
    EXPECT_NEAR(std::abs(convert::radians(p.theta_bam)), reference::pi, 1e-6);
}

TEST_F(Wheels, ExtrapolateForAHundredAndFiftyMillisecondsAndNoFarther)
{
    add(0, 0, 0, 0);
    add(100, 0.05, 0, 0);
    ale_pose_t p;
    ASSERT_TRUE(at(250, &p));
    EXPECT_EQ(beyond_us, 150000);
    EXPECT_NEAR(p.x_um, 125000, 1);
    EXPECT_FALSE(at(251, &p));
}

TEST_F(Wheels, KnowNothingBeforeTheirFirstSampleOrOfASingleOne)
{
    ale_pose_t p;
    EXPECT_FALSE(at(0, &p));
    add(100, 0, 0, 0);
    EXPECT_FALSE(at(100, &p));
    add(200, 0, 0, 0);
    EXPECT_FALSE(at(99, &p));
    EXPECT_TRUE(at(100, &p));
}

TEST_F(Wheels, AResetOfTheCountersBeginsANewEpoch)
{
    add(0, 5, 5, 1);
    add(100, 5.05, 5, 1);
    add(200, 0, 0, 0);
    EXPECT_EQ(wheels.jumps, 1u);
    ale_pose_t p;
    EXPECT_FALSE(at(150, &p));
    add(300, 0.05, 0, 0);
    ale_pose_t d;
    ASSERT_TRUE(ale_wheels_motion(&wheels, 200000, 300000, &d, &beyond_us));
    EXPECT_NEAR(d.x_um, 50000, 1);
    EXPECT_FALSE(ale_wheels_motion(&wheels, 50000, 300000, &d, &beyond_us));
}

TEST_F(Wheels, AClockSetBackBeginsANewEpochButAnOldSampleIsOnlyIgnored)
{
    add(5000, 0, 0, 0);
    add(5100, 0.05, 0, 0);
    add(5050, 0.9, 0, 0);
    EXPECT_EQ(wheels.jumps, 0u);
    EXPECT_EQ(wheels.count, 2u);
    add(1000, 0.1, 0, 0);
    EXPECT_EQ(wheels.jumps, 1u);
    EXPECT_EQ(wheels.count, 1u);
}

TEST_F(Wheels, ASampleStampedTooEarlyCountsAsTakenNowIfTheWheelsHaveGoneOn)
{
    add(1000, 0, 0, 0);
    add(2000, 0.3, 0, 0);
    add(1800, 0.25, 0, 0); /* late: on the way that is known */
    EXPECT_EQ(wheels.count, 2u);
    add(1800, 0.6, 0, 0.3);
    EXPECT_EQ(wheels.count, 3u);
    EXPECT_EQ(wheels.jumps, 0u);
    ale_pose_t d;
    ASSERT_TRUE(ale_wheels_motion(&wheels, 2000000, 2000001, &d, &beyond_us));
    EXPECT_NEAR(d.x_um, 300000, 1);
}

TEST_F(Wheels, StampsThatCrowdMakeNoJump)
{
    for (int k = 0; k < 5; k++) {
        add(1000 * k, 0.4 * k, 0, 0);
    }
    add(4002, 2.0, 0, 0);
    EXPECT_EQ(wheels.jumps, 0u);
    EXPECT_EQ(ale_wheels_gap_us(&wheels, 2500000), 1000000);
    EXPECT_EQ(ale_wheels_gap_us(&wheels, 4001000), 2000);
}

TEST_F(Wheels, CountAcrossAPauseOfMinutesButNotOfMore)
{
    add(0, 1, 2, 0);
    add(300000, 1.8, 2, 0.5);
    EXPECT_EQ(wheels.jumps, 0u);
    ale_pose_t d;
    ASSERT_TRUE(ale_wheels_motion(&wheels, 0, 300000000, &d, &beyond_us));
    EXPECT_NEAR(d.x_um, 800000, 1);
    ale_pose_t p;
    ASSERT_TRUE(at(150000, &p));
    EXPECT_NEAR(p.x_um, 1400000, 1);
    add(901000, 1.8, 2, 0.5);
    EXPECT_EQ(wheels.jumps, 1u);
}

TEST_F(Wheels, AFullBufferForgetsTheOldestSample)
{
    for (int k = 0; k < ALE_WHEELS_SAMPLES + 10; k++) {
        add(10 * k, 0.001 * k, 0, 0);
    }
    ale_pose_t p;
    EXPECT_FALSE(at(95, &p));
    ASSERT_TRUE(at(105, &p));
    EXPECT_NEAR(p.x_um, 10500, 1);
    EXPECT_EQ(wheels.count, static_cast<uint32_t>(ALE_WHEELS_SAMPLES));
}

TEST_F(Wheels, MotionIsSeenFromTheEarlierPose)
{
    add(0, 1, 2, reference::pi / 2);
    add(100, 1, 2.1, reference::pi / 2);
    ale_pose_t d;
    ASSERT_TRUE(ale_wheels_motion(&wheels, 0, 100000, &d, &beyond_us));
    EXPECT_NEAR(d.x_um, 100000, 2);
    EXPECT_NEAR(d.y_um, 0, 2);
}

TEST_F(Wheels, HaveMovedOnceTheyHaveToldTwoPoses)
{
    add(0, 1, 2, 0.5);
    add(100, 1, 2, 0.5);
    EXPECT_FALSE(wheels.moved);
    add(200, 1, 2, 0.501);
    EXPECT_TRUE(wheels.moved);
    add(300, 1, 2, 0.501);
    EXPECT_TRUE(wheels.moved);
}

TEST_F(Wheels, TellTheWholeWayFromTheInstantThatIsKeptHoweverMuchComes)
{
    const auto on_the_way = [](int64_t t_ms) {
        const double t = 1e-3 * static_cast<double>(t_ms);
        return reference::Pose(2 * std::sin(0.3 * t), 0.4 * t, 0.5 * std::sin(0.2 * t));
    };
    const auto told_at = [&](int64_t t_ms) {
        const reference::Pose pose = on_the_way(t_ms);
        add(t_ms, pose.x(), pose.y(), pose.z());
    };
    for (const int64_t every_ms : {10, 50, 100}) {
        ale_wheels_init(&wheels, 2000, 4000);
        int64_t now_ms = 0;
        for (; now_ms <= 5000; now_ms += every_ms) {
            told_at(now_ms);
        }
        const int64_t kept_ms = 5000 - 30;
        ale_wheels_keep(&wheels, kept_ms * 1000);
        for (; now_ms <= 180000; now_ms += every_ms) {
            told_at(now_ms);
            ale_pose_t from;
            ale_pose_t to;
            ASSERT_TRUE(at(kept_ms, &from)) << now_ms;
            ASSERT_TRUE(at(now_ms - every_ms, &to)) << now_ms;
            EXPECT_NEAR(from.x_um, 1e6 * on_the_way(kept_ms).x(), 300) << now_ms;
            EXPECT_NEAR(to.x_um, 1e6 * on_the_way(now_ms - every_ms).x(), 1) << now_ms;
            EXPECT_NEAR(to.y_um, 1e6 * on_the_way(now_ms - every_ms).y(), 1) << now_ms;
        }
        ale_wheels_keep(&wheels, now_ms * 1000);
        for (const int64_t end_ms = now_ms + 30000; now_ms <= end_ms; now_ms += every_ms) {
            told_at(now_ms);
        }
        ale_pose_t p;
        EXPECT_FALSE(at(kept_ms, &p)) << "what is no longer kept makes room";
    }
}

TEST_F(Wheels, CountWaysAndTurnsThatCancel)
{
    for (int k = 0; k <= 100; k++) {
        add(int64_t{100} * k, 0.02 * (k <= 50 ? k : 100 - k), 0, 0.01 * (k % 2));
    }
    int64_t turned_urad = 0;
    EXPECT_NEAR(static_cast<double>(ale_wheels_way_um(&wheels, 0, 10000000, &turned_urad)), 2000000, 200);
    EXPECT_NEAR(static_cast<double>(turned_urad), 1000000, 200);
    EXPECT_NEAR(static_cast<double>(ale_wheels_way_um(&wheels, 1000000, 2000000, &turned_urad)), 200000, 100);
    EXPECT_EQ(ale_wheels_way_um(&wheels, 1010000, 1090000, &turned_urad), 0);
}
