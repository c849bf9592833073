#include <random>

#include <gtest/gtest.h>

extern "C" {
#include "motion/smooth_pose.h"
}

namespace
{

bool is_same(ale_pose_t a, ale_pose_t b)
{
    return a.x_um == b.x_um && a.y_um == b.y_um && a.theta_bam == b.theta_bam;
}

ale_pose_t random_pose(std::mt19937 &random, int32_t reach_um)
{
    std::uniform_int_distribution<int32_t> place(-reach_um, reach_um);
    return {place(random), place(random), static_cast<uint32_t>(random())};
}

TEST(SmoothPose, IsTheMapPoseToTheMicrometreWhileNothingIsCorrected)
{
    std::mt19937 random(1);
    ale_smooth_t smooth;
    ale_pose_t map = random_pose(random, 1000000);
    ale_smooth_init(&smooth, map);
    for (int k = 0; k < 10000; k++) {
        map = ale_pose_compose(map, random_pose(random, 30000));
        ale_smooth_follow(&smooth, map);
        ASSERT_TRUE(is_same(smooth.pose, map)) << k;
    }
}

TEST(SmoothPose, StaysWhenTheMapPoseIsPutElsewhere)
{
    std::mt19937 random(2);
    ale_smooth_t smooth;
    ale_smooth_init(&smooth, random_pose(random, 100000000));
    for (int k = 0; k < 1000; k++) {
        const ale_pose_t before = smooth.pose;
        const ale_pose_t map = random_pose(random, 100000000);
        ale_smooth_hold(&smooth, map);
        ASSERT_TRUE(is_same(smooth.pose, before));
        ale_smooth_follow(&smooth, map);
        ASSERT_TRUE(is_same(smooth.pose, before)) << "the shift must say where it was to the micrometre";
    }
}

TEST(SmoothPose, GoesItsOwnWayWhenTheMapPoseJumps)
{
    ale_smooth_t smooth;
    ale_smooth_init(&smooth, {1000000, 0, 0x40000000u});
    ale_smooth_step(&smooth, {50000, 0, 0}, {7000000, 3000000, 0});
    EXPECT_TRUE(is_same(smooth.pose, {1000000, 50000, 0x40000000u}));
    ale_smooth_follow(&smooth, {7100000, 3000000, 0});
    EXPECT_TRUE(is_same(smooth.pose, {1000000, 150000, 0x40000000u}));
}

} // namespace
