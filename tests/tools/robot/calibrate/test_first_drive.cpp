/* Each mistake that a sender of odometry can make, in a drive that is otherwise right: it is named, and
 * nothing else is. */
#include "robot/calibrate/first_drive.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <random>
#include <string>

namespace
{

using calibrate::FirstDrive;
using calibrate::TimedPose;
using calibrate::Verdict;

constexpr double pi = 3.14159265358979323846;

struct Leg {
    double seconds;
    double speed;
    double turn;
};

/* Ahead, left, ahead, right, ahead, back. */
const std::vector<Leg> legs = {{4, 0.2, 0},    {3, 0, 0.5},  {4, 0.2, 0},
                               {2, 0.1, -0.6}, {3, 0.25, 0}, {2, -0.15, 0}};

std::vector<TimedPose> driven(double period, double heading)
{
    constexpr double step = 0.01;
    std::vector<TimedPose> poses;
    TimedPose pose = {0, 0, 0, heading};
    double next = 0;
    for (const Leg &leg : legs) {
        for (double t = 0; t < leg.seconds; t += step) {
            if (pose.time >= next) {
                poses.push_back(pose);
                next += period;
            }
            pose.x += step * leg.speed * std::cos(pose.theta);
            pose.y += step * leg.speed * std::sin(pose.theta);
            pose.theta += step * leg.turn;
            pose.time += step;
        }
    }
    return poses;
}

Verdict judged(const std::function<void(TimedPose &)> &spoil, double scan_heading = 0.4,
               double wheel_heading = 0)
{
    std::mt19937 random(7);
    std::normal_distribution<double> noise(0, 0.002);
    FirstDrive drive = {driven(0.1, scan_heading), driven(0.05, wheel_heading)};
    for (TimedPose &pose : drive.seen) {
        pose.x += noise(random);
        pose.y += noise(random);
        pose.theta = std::remainder(pose.theta + noise(random), 2 * pi);
    }
    for (TimedPose &pose : drive.counted) {
        pose.theta = std::remainder(pose.theta, 2 * pi);
        spoil(pose);
    }
    return calibrate::judge(drive);
}

std::string wrong(const Verdict &verdict)
{
    std::string said;
    for (const calibrate::Finding &finding : verdict.findings) {
        said += finding.fine ? "" : finding.subject + ": " + finding.words + "\n";
    }
    return said;
}

struct Mistake {
    const char *name;
    std::function<void(TimedPose &)> spoil;
    const char *named; /* what must be said; empty: nothing is wrong */
    int others;        /* further things that are said with it */
};

class FirstDriveOf : public testing::TestWithParam<Mistake>
{
};

TEST_P(FirstDriveOf, IsNamed)
{
    for (const double wheel_heading : {0.0, -2.5}) {
        const Verdict verdict = judged(GetParam().spoil, 0.4, wheel_heading);
        EXPECT_EQ(verdict.missing, "");
        const std::string said = wrong(verdict);
        EXPECT_NE(said.find(GetParam().named), std::string::npos) << said;
        const auto lines = std::count(said.begin(), said.end(), '\n');
        EXPECT_EQ(lines, *GetParam().named ? 1 + GetParam().others : 0) << said;
    }
}

INSTANTIATE_TEST_SUITE_P(
    Mistakes, FirstDriveOf,
    testing::Values(Mistake{"None", [](TimedPose &) {}, "", 0},
                    Mistake{"Millimetres",
                            [](TimedPose &p) {
                                p.x *= 1000;
                                p.y *= 1000;
                            },
                            "millimetres", 0},
                    Mistake{"Centimetres",
                            [](TimedPose &p) {
                                p.x *= 100;
                                p.y *= 100;
                            },
                            "centimetres", 0},
                    Mistake{"Degrees", [](TimedPose &p) { p.theta *= 180 / pi; }, "theta is in degrees", 0},
                    Mistake{"DegreesOfAWholeTurn",
                            [](TimedPose &p) { p.theta = p.theta * 180 / pi + (p.theta < 0 ? 360 : 0); },
                            "theta is in degrees", 0},
                    Mistake{"MillimetresAndDegrees",
                            [](TimedPose &p) {
                                p.x *= 1000;
                                p.y *= 1000;
                                p.theta *= 180 / pi;
                            },
                            "millimetres", 1},
                    Mistake{"Scale",
                            [](TimedPose &p) {
                                p.x *= 1.1;
                                p.y *= 1.1;
                            },
                            "1.100 times the ticks per metre", 0},
                    Mistake{"WheelsExchanged",
                            [](TimedPose &p) {
                                p.y = -p.y;
                                p.theta = -p.theta;
                            },
                            "left and right wheel exchanged", 0},
                    Mistake{"Backward",
                            [](TimedPose &p) {
                                p.x = -p.x;
                                p.y = -p.y;
                            },
                            "forward counts backward", 0},
                    Mistake{"AxesSwapped", [](TimedPose &p) { std::swap(p.x, p.y); }, "axes are swapped", 0},
                    Mistake{"AxesTurned",
                            [](TimedPose &p) {
                                std::swap(p.x, p.y);
                                p.x = -p.x;
                            },
                            "axes are swapped", 0},
                    Mistake{"YToTheRight", [](TimedPose &p) { p.y = -p.y; }, "sign of y is wrong", 0},
                    Mistake{"Late", [](TimedPose &p) { p.time += 0.4; }, "odometry comes 0.4", 0},
                    Mistake{"NoTurns", [](TimedPose &p) { p.theta = 0; }, "count no turns", 1}),
    [](const testing::TestParamInfo<Mistake> &mistake) { return mistake.param.name; });

TEST(FirstDrive, WhatIsStillToBeDrivenIsSaid)
{
    FirstDrive drive;
    EXPECT_NE(calibrate::judge(drive).missing.find("straight ahead"), std::string::npos);
    drive.seen = driven(0.1, 0);
    drive.seen.resize(45); /* the first leg */
    drive.counted = drive.seen;
    const std::string missing = calibrate::judge(drive).missing;
    EXPECT_NE(missing.find("degrees of turns"), std::string::npos) << missing;
}

TEST(FirstDrive, NoOdometryIsSaid)
{
    FirstDrive drive;
    drive.seen = driven(0.1, 0);
    EXPECT_NE(wrong(calibrate::judge(drive)).find("nothing is heard on ALE_ODOMETRY"), std::string::npos);
}

} // namespace
