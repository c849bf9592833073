// lib/motion/motion.c against the exact motion and Eigen in double.
#include <random>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "convert.h"

extern "C" {
#include "motion/motion.h"
}

namespace
{
const double tick_s = 0.131072;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

ale_motion_t moving(double v, double w)
{
    ale_motion_t m;
    ale_motion_init(&m, 1000000, {0, 0, 0}, 300, 500);
    m.velocity[0] = convert::um(v * tick_s);
    m.velocity[2] = convert::um(w * tick_s);
    return m;
}
} // namespace

TEST(Motion, SweepIsTheExactArcWithinFiveMicrometres)
{
    std::mt19937 rng(1);
    std::uniform_real_distribution<double> speed(-1, 1);
    for (int n = 0; n < 2000; n++) {
        const Eigen::Vector3d v(speed(rng), 0.2 * speed(rng), 3 * speed(rng));
        const double t = 0.1 * speed(rng);
        const int32_t velocity[3] = {convert::um(v[0] * tick_s), convert::um(v[1] * tick_s),
                                     convert::um(v[2] * tick_s)};
        const ale_pose_t got = ale_motion_sweep(velocity, std::llround(t * 1e6));
        const reference::Pose truth = reference::sweep(v, std::round(t * 1e6) * 1e-6);
        EXPECT_NEAR(got.x_um, truth[0] * 1e6, 5);
        EXPECT_NEAR(got.y_um, truth[1] * 1e6, 5);
        EXPECT_NEAR(convert::radians(got.theta_bam), truth[2], 3e-6);
    }
}

TEST(Motion, WithoutWheelsTheVelocityGoesOn)
{
    ale_motion_t m = moving(0.5, 1.0);
    ale_process_noise_t l;
    ale_process_noise_init(&l);
    ale_motion_predict(&m, 1100000, nullptr, &l);
    const reference::Pose truth = reference::sweep({0.5, 0, 1.0}, 0.1);
    EXPECT_NEAR(m.pose.x_um, truth[0] * 1e6, 10);
    EXPECT_NEAR(m.pose.y_um, truth[1] * 1e6, 10);
    EXPECT_NEAR(convert::radians(m.pose.theta_bam), 0.1, 1e-5);
    EXPECT_EQ(m.stamp_us, 1100000);
}

// Twin: F P F^T with the adjoint of the inverse displacement, and the constant acceleration's noise.
TEST(Motion, CovarianceGrowsAsItsTwinInDouble)
{
    ale_motion_t m = moving(0.6, 1.4);
    std::mt19937 rng(2);
    std::normal_distribution<double> normal;
    Matrix6 b;
    for (int i = 0; i < 36; i++) {
        b.data()[i] = 1000 * normal(rng);
    }
    const Matrix6 p = b * b.transpose();
    for (int i = 0; i < 6; i++) {
        for (int j = 0; j < 6; j++) {
            m.cov.m[i][j] = std::llround(p(i, j));
        }
    }
    ale_process_noise_t l;
    ale_process_noise_init(&l);
    ale_motion_predict(&m, 1100000, nullptr, &l);

    const reference::Pose d = reference::sweep({0.6, 0, 1.4}, 0.1);
    Matrix6 f = Matrix6::Identity();
    f.topLeftCorner<2, 2>() = reference::rotation(-d[2]);
    f.block<2, 1>(0, 2) = reference::rotation(-d[2]) * Eigen::Vector2d(-d[1], d[0]);
    f.topRightCorner<3, 3>() = Eigen::Matrix3d::Identity() * (0.1 / tick_s);
    Matrix6 truth = f * p * f.transpose();
    const double acceleration[3] = {1.5e6, 0.3e6, 5e6};
    for (int i = 0; i < 3; i++) {
        const double velocity = acceleration[i] * 0.1 * tick_s;
        const double way = velocity * 0.1 / tick_s / 2;
        truth(i, i) += way * way;
        truth(i, i + 3) += way * velocity;
        truth(i + 3, i) += way * velocity;
        truth(i + 3, i + 3) += velocity * velocity;
    }
    for (int i = 0; i < 6; i++) {
        for (int j = 0; j < 6; j++) {
            const double size = std::sqrt(truth(i, i) * truth(j, j));
            EXPECT_NEAR(static_cast<double>(m.cov.m[i][j]), truth(i, j), 2e-3 * size) << i << j;
        }
    }
}

TEST(Motion, AStepWithoutTimeOrOfMoreThanTwoSecondsGivesNoVelocity)
{
    for (int64_t stamp_us : {1000000, 900000, 3100000}) {
        ale_motion_t m = moving(0.5, 1.0);
        ale_process_noise_t l;
        ale_process_noise_init(&l);
        ale_motion_predict(&m, stamp_us, nullptr, &l);
        EXPECT_EQ(m.pose.x_um, 0);
        EXPECT_EQ(m.velocity[0], 0);
        EXPECT_EQ(m.velocity[2], 0);
        EXPECT_GT(m.cov.m[0][0], int64_t{10000} * 10000);
    }
}

TEST(Motion, GoodWheelsDecideTheWayAndPoorOnesHardly)
{
    const double vars[2] = {1e4, 1e12};
    double x[2];
    for (int k = 0; k < 2; k++) {
        ale_motion_t m = moving(0.5, 0);
        ale_process_noise_t l;
        ale_process_noise_init(&l);
        ale_wheel_motion_t wheels = {};
        wheels.displacement = convert::pose(reference::Pose(0.06, 0, 0));
        wheels.velocity[0] = convert::um(0.6 * tick_s);
        for (int i = 0; i < 3; i++) {
            wheels.displacement_var[i] = wheels.velocity_var[i] = static_cast<int64_t>(vars[k]);
        }
        ale_motion_predict(&m, 1100000, &wheels, &l);
        x[k] = m.pose.x_um;
    }
    EXPECT_NEAR(x[0], 60000, 200);
    EXPECT_NEAR(x[1], 50000, 200);
}

// Twin: Joseph's form with the gain's rows along the direction zero.
TEST(Motion, WhatAScanSaysNothingOfStaysAsPredicted)
{
    std::mt19937 rng(3);
    std::normal_distribution<double> normal;
    for (int n = 0; n < 200; n++) {
        Matrix6 b = Matrix6::Zero();
        Matrix6 h = Matrix6::Zero();
        Eigen::Matrix<double, 6, 1> error;
        for (int i = 0; i < 6; i++) {
            error[i] = 1000 * normal(rng);
            for (int j = 0; j < 6; j++) {
                b(i, j) = 3000 * normal(rng);
                h(i, j) = normal(rng);
            }
        }
        const Matrix6 p = b * b.transpose();
        const Matrix6 r = 1e6 * Matrix6::Identity();
        const Matrix6 gain = p * h.transpose() * (h * p * h.transpose() + r).inverse();
        const double heading = normal(rng);
        const double direction = normal(rng);
        const Eigen::Vector2d u(std::cos(direction - heading), std::sin(direction - heading));
        Matrix6 zero_motion = Matrix6::Identity();
        zero_motion.block<2, 2>(0, 0) -= u * u.transpose();
        zero_motion.block<2, 2>(3, 3) -= u * u.transpose();
        const Matrix6 left = Matrix6::Identity() - zero_motion * gain * h;
        const Matrix6 twin =
            left * p * left.transpose() + zero_motion * gain * r * gain.transpose() * zero_motion.transpose();

        ale_motion_t predicted = moving(0.5, 0);
        predicted.pose = convert::pose(reference::Pose(3, -2, heading));
        ale_motion_t found = predicted;
        const Eigen::Matrix<double, 6, 1> step = gain * error;
        found.pose =
            ale_pose_compose(predicted.pose, {convert::um(step[0] * 1e-6), convert::um(step[1] * 1e-6), 0});
        found.velocity[0] += convert::um(step[3] * 1e-6);
        found.velocity[1] += convert::um(step[4] * 1e-6);
        const Matrix6 less = p - gain * h * p;
        for (int i = 0; i < 6; i++) {
            for (int j = 0; j < 6; j++) {
                predicted.cov.m[i][j] = std::llround(p(i, j));
                found.cov.m[i][j] = std::llround(less(i, j));
            }
        }
        ale_motion_keep_along(&found, &predicted, convert::bam(direction));

        const Eigen::Matrix<double, 6, 1> kept = zero_motion * step;
        const ale_pose_t way = ale_pose_between(predicted.pose, found.pose);
        EXPECT_NEAR(way.x_um, kept[0], 4);
        EXPECT_NEAR(way.y_um, kept[1], 4);
        EXPECT_NEAR(found.velocity[0] - predicted.velocity[0], kept[3], 2);
        EXPECT_NEAR(found.velocity[1] - predicted.velocity[1], kept[4], 2);
        for (int i = 0; i < 6; i++) {
            for (int j = 0; j < 6; j++) {
                EXPECT_NEAR(static_cast<double>(found.cov.m[i][j]), twin(i, j),
                            1e-4 * std::sqrt(p(i, i) * p(j, j)) + 10)
                    << n << ": " << i << ", " << j;
            }
        }
    }
}

TEST(Motion, LivelinessGrowsWhenCorrectionsSurpriseAndFallsBack)
{
    ale_process_noise_t l;
    ale_process_noise_init(&l);
    ale_motion_t before = moving(0, 0);
    ale_motion_t after = before;
    before.cov.m[0][0] = 2000000;
    after.cov.m[0][0] = 1000000;
    after.pose.x_um = 5000;
    for (int k = 0; k < 50; k++) {
        ale_process_noise_learn(&l, &before, &after);
    }
    EXPECT_GT(l.factor_q8[0], 3 * 256);
    after.pose.x_um = 100;
    for (int k = 0; k < 200; k++) {
        ale_process_noise_learn(&l, &before, &after);
    }
    EXPECT_EQ(l.factor_q8[0], 256);
}

TEST(Motion, NumbersStayBoundedWithoutAnyScan)
{
    ale_motion_t m = moving(9, 9);
    ale_process_noise_t l;
    ale_process_noise_init(&l);
    for (int k = 1; k < 5000; k++) {
        ale_motion_predict(&m, 1000000 + 400000 * int64_t{k}, nullptr, &l);
        for (int i = 0; i < 6; i++) {
            ASSERT_GE(m.cov.m[i][i], 0);
            ASSERT_LE(m.cov.m[i][i], int64_t{9000000000000});
        }
    }
}
