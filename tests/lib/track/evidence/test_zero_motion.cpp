// lib/track/evidence/zero_motion: scans from the same place are not so many independent ones.
#include <cmath>

#include <gtest/gtest.h>

extern "C" {
#include "track/evidence/zero_motion.h"
}

namespace
{

ale_pose_t at(int32_t x_mm, int32_t heading_mrad)
{
    return {x_mm * 1000, 0, static_cast<uint32_t>(heading_mrad * ALE_BAM_PER_MRAD)};
}

/* What so many scans from a place are worth, in independent ones. */
double worth(int work)
{
    ale_zero_motion_t zero_motion;
    double sum = 0;
    ale_zero_motion_clear(&zero_motion);
    for (int k = 0; k < work; k++) {
        ale_zero_motion_update(&zero_motion, at(k % 7, k % 5));
        sum += 1.0 / ale_zero_motion_dilution(&zero_motion);
    }
    return sum;
}

TEST(Rest, the_first_scans_count_whole)
{
    EXPECT_EQ(worth(ALE_ZERO_MOTION_WHOLE), ALE_ZERO_MOTION_WHOLE);
}

TEST(Rest, an_hour_counts_like_a_few_seconds)
{
    const double whole = ALE_ZERO_MOTION_WHOLE;
    EXPECT_NEAR(worth(36000), whole * (1 + std::log(36000 / whole)), whole);
    EXPECT_LT(worth(864000) - worth(36000), 90) << "a day hardly more";
}

TEST(Rest, a_robot_that_goes_on_scans_anew)
{
    ale_zero_motion_t zero_motion;
    ale_zero_motion_clear(&zero_motion);
    for (int k = 0; k < 100; k++) {
        ale_zero_motion_update(&zero_motion, at(0, 0));
    }
    EXPECT_GT(ale_zero_motion_dilution(&zero_motion), 1);
    ale_zero_motion_update(&zero_motion, at(25, 0));
    EXPECT_EQ(ale_zero_motion_dilution(&zero_motion), 1) << "on the way";
    for (int k = 0; k < 100; k++) {
        ale_zero_motion_update(&zero_motion, at(25, 0));
    }
    ale_zero_motion_update(&zero_motion, at(25, 15));
    EXPECT_EQ(ale_zero_motion_dilution(&zero_motion), 1) << "turned";
}

TEST(Rest, a_robot_that_creeps_is_not_at_rest)
{
    ale_zero_motion_t zero_motion;
    ale_zero_motion_clear(&zero_motion);
    for (int k = 0; k < 1000; k++) {
        ale_zero_motion_update(&zero_motion, at(2 * k, 0));
        EXPECT_EQ(ale_zero_motion_dilution(&zero_motion), 1);
    }
}

} // namespace
