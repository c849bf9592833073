// lib/track/evidence/slip: which of two tales of the way is believed.
#include <gtest/gtest.h>

extern "C" {
#include "track/evidence/slip.h"
}

namespace
{

/* A motion that has come so far, known to 2 mm and 2 mrad. */
ale_motion_t motion(int32_t x_mm, int32_t turn_mrad)
{
    ale_motion_t m = {};
    m.pose = {x_mm * 1000, 0, static_cast<uint32_t>(turn_mrad * ALE_BAM_PER_MRAD)};
    for (int i = 0; i < ALE_AXES; i++) {
        m.cov.m[i][i] = 4000000;
    }
    return m;
}

ale_pose_t found(int32_t x_mm, int32_t turn_mrad)
{
    return motion(x_mm, turn_mrad).pose;
}

TEST(Slip, WheelsAreBelievedWhereTheTalesAgreeWhateverWasBefore)
{
    const ale_motion_t by_wheels = motion(50, 20);
    const ale_motion_t as_before = motion(46, 16);
    for (const bool slips : {false, true}) {
        const ale_ways_t ways = ale_ways_of(&by_wheels, &as_before, slips);
        EXPECT_FALSE(ways.part);
        EXPECT_TRUE(ways.counted);
        EXPECT_EQ(ways.believed.pose.x_um, 50000);
    }
}

TEST(Slip, WhereTheyPartTheOneIsBelievedThatWasRightTheLastTime)
{
    const ale_motion_t by_wheels = motion(50, -160);
    const ale_motion_t as_before = motion(48, 5);
    const ale_ways_t before = ale_ways_of(&by_wheels, &as_before, false);
    EXPECT_TRUE(before.part);
    EXPECT_TRUE(before.counted);
    EXPECT_TRUE(ale_ways_rival_is_nearer(&before, found(47, 2)));
    ASSERT_TRUE(ale_ways_slip(&before, found(47, 2), false));

    const ale_ways_t then = ale_ways_of(&by_wheels, &as_before, true);
    EXPECT_TRUE(then.part);
    EXPECT_FALSE(then.counted);
    EXPECT_EQ(then.believed.pose.theta_bam, as_before.pose.theta_bam);
    EXPECT_TRUE(ale_ways_slip(&then, found(47, 2), true)) << "still";
    EXPECT_FALSE(ale_ways_slip(&then, found(50, -150), true)) << "no more";
}

TEST(Slip, WhereTheyPartWheelsAreBelievedLessAlongTheLineBetweenTheTales)
{
    const ale_motion_t by_wheels = motion(50, 0);
    ale_motion_t as_before = motion(10, 30);
    as_before.velocity[2] = 40000;
    const ale_motion_t believed = ale_ways_of(&by_wheels, &as_before, false).believed;
    const double apart[ALE_STATES] = {-40000, 0, 30000, 0, 0, 40000};
    for (int i = 0; i < ALE_STATES; i++) {
        for (int j = 0; j < ALE_STATES; j++) {
            const double before = static_cast<double>(by_wheels.cov.m[i][j]);
            const double more = static_cast<double>(believed.cov.m[i][j]) - before;
            EXPECT_NEAR(more, apart[i] * apart[j] / 4, 4e4) << i << ' ' << j;
        }
    }
    EXPECT_EQ(believed.pose.x_um, 50000);
    const ale_motion_t near_by = motion(46, 4);
    EXPECT_EQ(ale_ways_of(&by_wheels, &near_by, false).believed.cov.m[0][0], by_wheels.cov.m[0][0]);
}

TEST(Slip, WheelsThatAreFarFromTheOtherTaleKeepTheirCovariance)
{
    const ale_motion_t by_wheels = motion(50, -160);
    const ale_motion_t as_before = motion(50, 5);
    const ale_ways_t ways = ale_ways_of(&by_wheels, &as_before, false);
    EXPECT_TRUE(ways.part);
    EXPECT_EQ(ways.believed.cov.m[2][2], by_wheels.cov.m[2][2]);
}

TEST(Slip, WheelsThatAreOffByLittleOrByAsMuchAsTheOtherTaleDoNotSlip)
{
    const ale_motion_t by_wheels = motion(50, 0);
    const ale_motion_t near_by = motion(30, 0);
    const ale_ways_t little = ale_ways_of(&by_wheels, &near_by, false);
    EXPECT_FALSE(ale_ways_slip(&little, found(31, 0), false));
    const ale_motion_t as_before = motion(250, 0);
    const ale_ways_t neither = ale_ways_of(&by_wheels, &as_before, false);
    EXPECT_FALSE(ale_ways_slip(&neither, found(170, 0), false));
}

TEST(Slip, AWayThatIsHardlyKnownIsNoRival)
{
    const ale_motion_t by_wheels = motion(50, -160);
    ale_motion_t as_before = motion(48, 5);
    as_before.cov.m[2][2] = INT64_C(40000000000);
    const ale_ways_t ways = ale_ways_of(&by_wheels, &as_before, true);
    EXPECT_FALSE(ways.part);
    EXPECT_TRUE(ways.counted);
}

} // namespace
