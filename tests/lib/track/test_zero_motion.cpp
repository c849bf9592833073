// lib/track/zero_motion: looks from the same place are not so many independent ones.
#include <cmath>

#include <gtest/gtest.h>

extern "C" {
#include "track/zero_motion.h"
}

namespace
{

ale_pose_t at(int32_t x_mm, int32_t heading_mrad)
{
    return {x_mm * 1000, 0, static_cast<uint32_t>(heading_mrad * ALE_BAM_PER_MRAD)};
}

/* What so many looks from a place are worth, in independent ones. */
double worth(int looks)
{
    ale_rest_t rest;
    double sum = 0;
    ale_rest_clear(&rest);
    for (int k = 0; k < looks; k++) {
        ale_rest_look(&rest, at(k % 7, k % 5));
        sum += 1.0 / ale_rest_dilution(&rest);
    }
    return sum;
}

TEST(Rest, the_first_looks_count_whole)
{
    EXPECT_EQ(worth(ALE_REST_WHOLE), ALE_REST_WHOLE);
}

TEST(Rest, an_hour_counts_like_a_few_seconds)
{
    const double whole = ALE_REST_WHOLE;
    EXPECT_NEAR(worth(36000), whole * (1 + std::log(36000 / whole)), whole);
    EXPECT_LT(worth(864000) - worth(36000), 90) << "a day hardly more";
}

TEST(Rest, a_robot_that_goes_on_looks_anew)
{
    ale_rest_t rest;
    ale_rest_clear(&rest);
    for (int k = 0; k < 100; k++) {
        ale_rest_look(&rest, at(0, 0));
    }
    EXPECT_GT(ale_rest_dilution(&rest), 1);
    ale_rest_look(&rest, at(25, 0));
    EXPECT_EQ(ale_rest_dilution(&rest), 1) << "on the way";
    for (int k = 0; k < 100; k++) {
        ale_rest_look(&rest, at(25, 0));
    }
    ale_rest_look(&rest, at(25, 15));
    EXPECT_EQ(ale_rest_dilution(&rest), 1) << "turned";
}

TEST(Rest, a_robot_that_creeps_is_not_at_rest)
{
    ale_rest_t rest;
    ale_rest_clear(&rest);
    for (int k = 0; k < 1000; k++) {
        ale_rest_look(&rest, at(2 * k, 0));
        EXPECT_EQ(ale_rest_dilution(&rest), 1);
    }
}

} // namespace
