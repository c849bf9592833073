// lib/base/pose.c against rotations in double.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <random>

#include <Eigen/Geometry>

extern "C" {
#include "base/pose.h"
}

namespace
{

constexpr double pi = 3.14159265358979323846;

double radians(uint32_t bam)
{
    return bam * (2 * pi / 4294967296.0);
}

Eigen::Isometry2d isometry(const ale_pose_t &p)
{
    Eigen::Isometry2d m = Eigen::Isometry2d::Identity();
    m.translate(Eigen::Vector2d(p.x_um, p.y_um));
    m.rotate(radians(p.theta_bam));
    return m;
}

void expect_same(const ale_pose_t &p, const Eigen::Isometry2d &m, double bound_um)
{
    EXPECT_NEAR(p.x_um, m.translation().x(), bound_um);
    EXPECT_NEAR(p.y_um, m.translation().y(), bound_um);
    const double turn = std::atan2(m.linear()(1, 0), m.linear()(0, 0));
    EXPECT_NEAR(std::remainder(radians(p.theta_bam) - turn, 2 * pi), 0.0, 1e-8);
}

class Poses
{
  public:
    ale_pose_t any()
    {
        return {place(engine), place(engine), static_cast<uint32_t>(engine())};
    }

  private:
    std::mt19937 engine{11};
    std::uniform_int_distribution<int32_t> place{-100000000, 100000000};
};

TEST(Pose, MapsPointsAsTheRotationDoes)
{
    Poses poses;
    for (int k = 0; k < 20000; k++) {
        const ale_pose_t pose = poses.any();
        const ale_pose_t q = poses.any();
        const ale_point_t got = ale_pose_apply(pose, {q.x_um, q.y_um});
        const Eigen::Vector2d expected = isometry(pose) * Eigen::Vector2d(q.x_um, q.y_um);
        EXPECT_NEAR(got.x_um, expected.x(), 1.0);
        EXPECT_NEAR(got.y_um, expected.y(), 1.0);
    }
}

TEST(Pose, ComposeAndBetweenAgreeWithDouble)
{
    Poses poses;
    for (int k = 0; k < 20000; k++) {
        const ale_pose_t a = poses.any();
        const ale_pose_t b = poses.any();
        expect_same(ale_pose_compose(a, b), isometry(a) * isometry(b), 1.0);
        expect_same(ale_pose_between(a, b), isometry(a).inverse() * isometry(b), 1.5);
    }
}

TEST(Pose, BetweenIsWhatComposeUndoes)
{
    Poses poses;
    for (int k = 0; k < 20000; k++) {
        const ale_pose_t a = poses.any();
        const ale_pose_t p = ale_pose_compose(a, ale_pose_between(a, ale_pose_t{}));
        EXPECT_NEAR(p.x_um, 0, 2);
        EXPECT_NEAR(p.y_um, 0, 2);
        EXPECT_EQ(p.theta_bam, 0u);
        const ale_pose_t nothing = ale_pose_between(a, a);
        EXPECT_EQ(nothing.x_um, 0);
        EXPECT_EQ(nothing.y_um, 0);
    }
}

TEST(Pose, PosesFartherApartThanCanBeToldAreAsFarApartAsCanBe)
{
    const ale_pose_t far = ale_pose_between({-2132000000, 359, 0}, {112000000, 359, 5});
    EXPECT_EQ(far.x_um, INT32_MAX);
    EXPECT_EQ(far.y_um, 0);
    EXPECT_EQ(far.theta_bam, 5u);
    EXPECT_EQ(ale_pose_between({INT32_MAX, 0, 0}, {INT32_MIN, 0, 0}).x_um, INT32_MIN);
}

} // namespace
