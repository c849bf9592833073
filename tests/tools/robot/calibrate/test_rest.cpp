// Scanners that stand and scanners that move: only the former are calibrated.
#include <gtest/gtest.h>

#include "robot/calibrate/rest.h"
#include "tools/robot/calibrate/simulated_recording.hpp"

namespace
{

using namespace simulated;
using Eigen::Vector3d;

std::string refusal_of(const calibrate::Recording &recording)
{
    try {
        calibrate::require_rest(recording, calibrate::beams_of(recording));
    } catch (const std::runtime_error &error) {
        return error.what();
    }
    return "";
}

std::string refusal_of(const Way &way, int scans = 120)
{
    return refusal_of(recording_of(simulation(usual), scans, way));
}

// A corridor whose sides show no motion along it: only its far end does.
bench::World corridor()
{
    bench::World world;
    world.walls = {{{-2, -0.7}, {3, -0.7}}, {{3, -0.7}, {3, 0.7}}, {{3, 0.7}, {-2, 0.7}}};
    return world;
}

class Standing : public testing::TestWithParam<Truth>
{
};

TEST_P(Standing, AScannerAtRestIsTakenWhateverItsNoise)
{
    for (const int scans : {20, 60, 400}) {
        EXPECT_EQ(refusal_of(recording_of(simulation(GetParam()), scans)), "") << scans << " scans";
    }
}

INSTANTIATE_TEST_SUITE_P(Noise, Standing,
                         testing::Values(usual, Truth{{3000, 2500, 3000, 3000, 8, 9000, 1500000}, 0.15},
                                         Truth{{4000, 5000, 0, 0, 12, 5000, 2000000}, 0.05},
                                         Truth{{0, 0, 0, 0, 12, 0, 0}, 0},
                                         Truth{{500, 0, 8000, 8000, 40, 0, 0}, 0}));

TEST(Rest, PeopleWhoWalkPastAreNoMotionOfTheScanner)
{
    calibrate::Recording recording = recording_of(simulation(usual), 120);
    for (int scan = 40; scan < 110; scan++) {
        recording.range.row(scan).segment(scan, 60).setConstant(0.5);
    }
    EXPECT_EQ(refusal_of(recording), "");
}

TEST(Rest, ADriveIsRefused)
{
    EXPECT_NE(refusal_of([](double t) {
                  return Vector3d(0.1 * t, 0, 0);
              }).find("of its beams measure other ranges"),
              std::string::npos);
}

TEST(Rest, ACreepOfMillimetresIsRefusedWithItsSizeAndTime)
{
    const std::string told = refusal_of([](double t) { return Vector3d(t < 6 ? 0 : 0.008, 0, 0); });
    EXPECT_NE(told.find("the scanner moves: after 6.5 s it stands"), std::string::npos) << told;
    const double millimetres = std::stod(told.substr(told.find("stands ") + 7));
    EXPECT_NEAR(millimetres, 8, 1) << told;
}

TEST(Rest, ATurnOfATenthOfADegreeOrTwoIsRefused)
{
    EXPECT_NE(refusal_of([](double t) { return Vector3d(0, 0, 0.0004 * t); }).find("the scanner moves"),
              std::string::npos);
}

TEST(Rest, WhoComesBackHasMovedToo)
{
    const auto there_and_back = [](double t) { return Vector3d(t > 4 && t < 8 ? 0.1 : 0, 0, 0); };
    EXPECT_NE(refusal_of(there_and_back).find("the scanner moves"), std::string::npos);
}

TEST(Rest, MotionAlongACorridorShowsAtItsEnd)
{
    const Simulation inside = simulation(usual, corridor());
    EXPECT_EQ(refusal_of(recording_of(inside, 120)), "");
    const auto forward = [](double t) { return Vector3d(0.005 * t, 0, 0); };
    EXPECT_NE(refusal_of(recording_of(inside, 120, forward)).find("the scanner moves"), std::string::npos);
}

} // namespace
