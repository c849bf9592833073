// Systematic errors of the wheels are taken off: against the same arithmetic in double precision.
#include <gtest/gtest.h>

#include <cmath>
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <random>

#include "convert.h"

extern "C" {
#include "motion/wheel_factors.h"
}

namespace
{

/* What wheels that err count of a step (way, turn) on an arc. */
reference::Pose after_step(const reference::Pose &from, double way, double turn)
{
    const Eigen::Vector2d to =
        from.head<2>() + Eigen::Rotation2Dd(from.z() + turn / 2) * Eigen::Vector2d(way, 0);
    return {to.x(), to.y(), from.z() + turn};
}

TEST(WheelFactors, WheelsThatErrSystematicallyTellTheTrueWayAgain)
{
    const double distance = 1.037;
    const double turn = 0.962;
    const double bias = -0.021;
    ale_wheel_factors_t factors;
    ale_wheel_factors_init(&factors, 1037000, 962000, -21000);
    std::mt19937 rng(5);
    std::uniform_real_distribution<double> way(-0.02, 0.08);
    std::uniform_real_distribution<double> angle(-0.15, 0.2);
    reference::Pose truth(0, 0, 0);
    reference::Pose counted(0, 0, 0);
    ale_pose_t corrected = ale_wheel_factors_correct(&factors, convert::pose(counted));
    for (int k = 0; k < 2000; k++) {
        const double counted_way = way(rng);
        const double counted_turn = angle(rng);
        counted = after_step(counted, counted_way, counted_turn);
        truth = after_step(truth, distance * counted_way, turn * (counted_turn - bias * counted_way));
        corrected = ale_wheel_factors_correct(&factors, convert::pose(counted));
    }
    const reference::Pose found = convert::pose(corrected);
    EXPECT_LT((found - truth).head<2>().norm(), 2e-4) << "metres, after 60 m in 2000 steps";
    EXPECT_LT(std::fabs(std::remainder(found.z() - truth.z(), 2 * M_PI)), 2e-5);
}

TEST(WheelFactors, FactorsOfOneChangeNoByte)
{
    ale_wheel_factors_t factors;
    ale_wheel_factors_init(&factors, ALE_WHEEL_FACTOR_ONE, ALE_WHEEL_FACTOR_ONE, 0);
    std::mt19937 rng(6);
    for (int k = 0; k < 100; k++) {
        const ale_pose_t any = {static_cast<int32_t>(rng()), static_cast<int32_t>(rng()),
                                static_cast<uint32_t>(rng())};
        const ale_pose_t same = ale_wheel_factors_correct(&factors, any);
        EXPECT_EQ(same.x_um, any.x_um);
        EXPECT_EQ(same.y_um, any.y_um);
        EXPECT_EQ(same.theta_bam, any.theta_bam);
    }
}

TEST(WheelFactors, AWayThatNoPoseCanHoldBeginsAnew)
{
    ale_wheel_factors_t factors;
    ale_wheel_factors_init(&factors, 2 * ALE_WHEEL_FACTOR_ONE, ALE_WHEEL_FACTOR_ONE, 0);
    ale_wheel_factors_correct(&factors, {1000000000, 0, 0});
    const ale_pose_t far = ale_wheel_factors_correct(&factors, {2000000000, 0, 0});
    EXPECT_EQ(far.x_um, 2000000000);
}

} // namespace
