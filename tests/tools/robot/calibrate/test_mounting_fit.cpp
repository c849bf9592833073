// A made drive, known without error: what the calibration finds of it, and what it says it cannot find.
#include <gtest/gtest.h>

#include <cmath>
#include <Eigen/Geometry>
#include <functional>
#include <random>

#include "robot/calibrate/mounting_fit.h"
#include "robot/calibrate/mounting_report.h"

namespace
{

using mounting::Pose;

struct Truth {
    Pose sensor = {0.14, -0.06, 0.3};
    double lag = 0.12;
    double distance_factor = 1.03;
    double turn_factor = 0.95;
    double turn_bias = 0.015;
};

/* Forward speed and turn rate at a time. */
using Motion = std::function<Eigen::Vector2d(double)>;

Eigen::Vector2d lively(double t)
{
    return {0.4 + 0.2 * std::sin(0.9 * t), 0.9 * std::sin(0.5 * t) + 0.3 * std::sin(1.7 * t)};
}

Eigen::Vector2d straight(double t)
{
    return {0.4 + 0.2 * std::sin(0.9 * t), 0};
}

Eigen::Vector2d on_the_spot(double t)
{
    return {0, 0.9 * std::sin(0.5 * t)};
}

void roll(Pose &pose, double way, double turn)
{
    pose.head<2>() += Eigen::Rotation2Dd(pose.z() + turn / 2) * Eigen::Vector2d(way, 0);
    pose.z() += turn;
}

/* A minute; scans at 10 Hz, wheels at 20 Hz, integrated in steps of 5 ms. noise: one sigma of the scans'
 * poses, metres and radians, and of the wheels' heading for a root metre. */
mounting::Drive driven(const Motion &motion, const Truth &truth, double noise, double wheel_walk)
{
    std::mt19937 rng(3);
    std::normal_distribution<double> normal;
    std::vector<mounting::LaserPose> laser;
    std::vector<mounting::WheelPose> wheels;
    Pose robot(0, 0, 0);
    Pose counted(1, 2, 3);
    const Eigen::Vector2d arm = truth.sensor.head<2>();
    constexpr double step = 0.005;
    for (int ms = 0; ms <= 60000; ms += 5) {
        const double t = ms / 1000.0;
        const Eigen::Vector2d v = motion(t);
        const Eigen::Vector2d d = step * motion(t + step / 2);
        if (ms % 100 == 0) {
            Pose pose(0, 0, robot.z() + truth.sensor.z());
            pose.head<2>() = robot.head<2>() + Eigen::Rotation2Dd(robot.z()) * arm;
            pose += noise * Pose(normal(rng), normal(rng), normal(rng));
            const Eigen::Vector2d speed = Eigen::Rotation2Dd(-truth.sensor.z()) *
                                          Eigen::Vector2d(v[0] - v[1] * arm.y(), v[1] * arm.x());
            laser.push_back({t, pose, {speed.x(), speed.y(), v[1]}, true});
        }
        if (ms % 50 == 25) {
            wheels.push_back({t - truth.lag, counted});
        }
        roll(robot, d[0], d[1]);
        const double way = d[0] / truth.distance_factor;
        const double walk = wheel_walk * std::sqrt(std::fabs(way)) * normal(rng);
        roll(counted, way, d[1] / truth.turn_factor + truth.turn_bias * way + walk);
    }
    return {mounting::Laser(laser), wheels, 0.05, 3, 6};
}

std::array<double, mounting::QUANTITIES> values(const Truth &t)
{
    return {t.sensor.x(), t.sensor.y(), t.sensor.z(), t.lag, t.distance_factor, t.turn_factor, t.turn_bias};
}

TEST(Mounting, ADriveWithoutNoiseIsRecoveredExactly)
{
    const Truth truth;
    const mounting::Fit fit = mounting::fit(driven(lively, truth, 0, 0));
    const std::array<double, mounting::QUANTITIES> within = {1e-4, 1e-4, 1e-4, 5e-4, 1e-4, 2e-4, 2e-4};
    for (size_t k = 0; k < mounting::QUANTITIES; k++) {
        EXPECT_NEAR(fit.estimate[k].value, values(truth)[k], within[k]) << k;
        EXPECT_TRUE(fit.estimate[k].determined) << k;
    }
    EXPECT_NEAR(fit.way, 24, 1.5);
}

TEST(Mounting, WithNoiseTheErrorsAreWithinWhatIsStated)
{
    const Truth truth;
    const mounting::Fit fit = mounting::fit(driven(lively, truth, 0.003, 0.02));
    for (size_t k = 0; k < mounting::QUANTITIES; k++) {
        EXPECT_LT(std::fabs(fit.estimate[k].value - values(truth)[k]), 3 * fit.estimate[k].sigma) << k;
        EXPECT_TRUE(fit.estimate[k].determined) << k;
    }
}

TEST(Mounting, AStraightDriveShowsNeitherLeverNorTurns)
{
    const mounting::Fit fit = mounting::fit(driven(straight, Truth(), 0.003, 0.02));
    for (const auto k : {mounting::X, mounting::Y, mounting::TURN_FACTOR}) {
        EXPECT_FALSE(fit.estimate[k].determined) << k;
    }
    for (const auto k : {mounting::THETA, mounting::DISTANCE_FACTOR}) {
        EXPECT_TRUE(fit.estimate[k].determined) << k;
    }
    const std::string text = mounting::configuration(fit, "straight.log", mounting::Part::both);
    EXPECT_NE(text.find("not determined"), std::string::npos);
    EXPECT_EQ(text.find("\nx = "), std::string::npos) << text;
    EXPECT_NE(text.find("\ntheta = "), std::string::npos) << text;
}

TEST(Mounting, TurnsOnTheSpotShowTurnsAndLagOnly)
{
    const mounting::Fit fit = mounting::fit(driven(on_the_spot, Truth(), 0.003, 0));
    for (const auto k : {mounting::THETA, mounting::DISTANCE_FACTOR, mounting::TURN_BIAS}) {
        EXPECT_FALSE(fit.estimate[k].determined) << k;
    }
    EXPECT_NEAR(fit.estimate[mounting::TURN_FACTOR].value, Truth().turn_factor, 0.005);
    EXPECT_NEAR(fit.estimate[mounting::LAG].value, Truth().lag, 0.003);
}

TEST(Mounting, AWheelThatSlipsNowAndThenSpoilsNothing)
{
    const Truth truth;
    mounting::Drive drive = driven(lively, truth, 0.003, 0.02);
    for (size_t k = 0; k < drive.wheels.size(); k++) {
        drive.wheels[k].pose.x() += 0.12 * static_cast<double>(k / 300);
    }
    const mounting::Fit fit = mounting::fit(drive);
    EXPECT_GT(fit.set_aside, 3U);
    EXPECT_NEAR(fit.estimate[mounting::DISTANCE_FACTOR].value, truth.distance_factor, 0.01);
    EXPECT_NEAR(fit.estimate[mounting::X].value, truth.sensor.x(), 0.01);
}

TEST(Mounting, WheelsThatTurnTheOtherWayAreRefused)
{
    mounting::Drive drive = driven(lively, Truth(), 0, 0);
    for (mounting::WheelPose &wheel : drive.wheels) {
        wheel.pose.y() *= -1;
        wheel.pose.z() *= -1;
    }
    EXPECT_THROW(mounting::fit(drive), std::runtime_error);
}

TEST(Mounting, ADriveOfTwoMetresIsTooShort)
{
    mounting::Drive drive = driven(lively, Truth(), 0, 0);
    drive.wheels.resize(100);
    EXPECT_THROW(mounting::fit(drive), std::runtime_error);
}

} // namespace
