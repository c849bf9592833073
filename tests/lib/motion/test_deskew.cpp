// lib/motion/deskew.c against the exact motion in double.
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "room.h"

extern "C" {
#include "base/turn.h"
#include "motion/deskew.h"
}

namespace
{
const double tick_s = 0.131072;
}

TEST(Deskew, MovesEveryBeamToWhereItWouldHaveBeenSeenFromTheStamp)
{
    std::mt19937 rng(1);
    std::uniform_real_distribution<double> unit(-1, 1);
    for (int n = 0; n < 50; n++) {
        const Eigen::Vector3d v(1.2 * unit(rng), 0.2 * unit(rng), 2.5 * unit(rng));
        ale_scan_t scan = {};
        scan.stamp_beam = 340;
        scan.beam_time_ns = 97656;
        scan.step_bam = n % 2 ? 4194304 : -4194304;
        scan.first_bearing_bam = static_cast<uint32_t>(-340 * int64_t{scan.step_bam});
        scan.beams = 682;
        std::vector<double> range(682);
        for (int k = 0; k < 682; k++) {
            range[static_cast<size_t>(k)] = 0.4 + 2.5 * (1 + unit(rng));
            scan.range_um[k] = convert::um(range[static_cast<size_t>(k)]);
        }
        const int32_t velocity[3] = {convert::um(v[0] * tick_s), convert::um(v[1] * tick_s),
                                     convert::um(v[2] * tick_s)};
        std::vector<uint32_t> bearing(682);
        ASSERT_TRUE(ale_deskew(&scan, velocity, bearing.data()));
        for (int k = 0; k < 682; k++) {
            const double a = convert::radians(ale_scan_bearing(&scan, k));
            const reference::Pose moved = reference::sweep(v, (k - 340) * 97.656e-6);
            const Eigen::Vector2d p = moved.head<2>() + reference::rotation(moved[2]) *
                                                            Eigen::Vector2d(std::cos(a), std::sin(a)) *
                                                            range[static_cast<size_t>(k)];
            const double b = convert::radians(bearing[static_cast<size_t>(k)]);
            EXPECT_NEAR(scan.range_um[k] * 1e-6 * std::cos(b), p[0], 20e-6);
            EXPECT_NEAR(scan.range_um[k] * 1e-6 * std::sin(b), p[1], 20e-6);
        }
    }
}

// What the series of ale_deskew leave out where a robot moves by a good part of the range within a turn: the
// next term of the square root, and of the arc tangent.
double cut_off(double range, double bearing, const reference::Pose &moved)
{
    const double reach = range + std::cos(bearing) * moved[0] + std::sin(bearing) * moved[1];
    const double z = std::abs(std::cos(bearing) * moved[1] - std::sin(bearing) * moved[0]) / reach;
    EXPECT_LT(z, 0.5) << "beyond that none is straightened rightly";
    return reach * (std::pow(z, 6) / 16 + std::pow(z, 9) / 9);
}

// A whole turn at bearings that stray from the grid, the last of them next to where the turn ends,
// straightened.
void expect_straightened(int beams, double turn_us, double way, const Eigen::Vector3d &v, std::mt19937 &rng)
{
    std::uniform_real_distribution<double> unit(-1, 1);
    ale_scan_t scan = {};
    scan.own_bearings = true;
    scan.beams = static_cast<uint16_t>(beams);
    scan.step_bam = static_cast<int32_t>(way * 0x1p32 / beams);
    scan.beam_time_ns = static_cast<int32_t>(turn_us * 1000 / beams);
    std::vector<double> range(static_cast<size_t>(beams));
    for (int k = 0; k < beams; k++) {
        const double place = k == 0 ? 0 : k == beams - 1 ? beams - 0.001 : k + 0.4 * unit(rng);
        scan.bearing_bam[k] = static_cast<uint32_t>(static_cast<int64_t>(place * scan.step_bam));
        range[static_cast<size_t>(k)] = 0.8 + 2.5 * (1 + unit(rng));
        scan.range_um[k] = convert::um(range[static_cast<size_t>(k)]);
    }
    const int32_t velocity[3] = {convert::um(v[0] * tick_s), convert::um(v[1] * tick_s),
                                 convert::um(v[2] * tick_s)};
    std::vector<uint32_t> bearing(static_cast<size_t>(beams));
    ASSERT_TRUE(ale_deskew(&scan, velocity, bearing.data()));
    for (int k = 0; k < beams; k++) {
        const double a = convert::radians(ale_scan_bearing(&scan, k));
        const double turned = static_cast<uint32_t>(static_cast<int64_t>(way) * scan.bearing_bam[k]) / 0x1p32;
        const reference::Pose moved = reference::sweep(v, turned * turn_us * 1e-6);
        const Eigen::Vector2d p = moved.head<2>() + reference::rotation(moved[2]) *
                                                        Eigen::Vector2d(std::cos(a), std::sin(a)) *
                                                        range[static_cast<size_t>(k)];
        const double b = convert::radians(bearing[static_cast<size_t>(k)]);
        const double most = 25e-6 + cut_off(range[static_cast<size_t>(k)], a + moved[2], moved);
        EXPECT_NEAR(scan.range_um[k] * 1e-6 * std::cos(b), p[0], most);
        EXPECT_NEAR(scan.range_um[k] * 1e-6 * std::sin(b), p[1], most);
    }
}

// A whole turn of 100 to 200 ms, clockwise or not: 0.5 rad of the robot's own turn lie between its ends.
TEST(Deskew, MovesTheBeamsOfAWholeTurnByTheirOwnTimes)
{
    std::mt19937 rng(2);
    std::uniform_real_distribution<double> unit(-1, 1);
    for (int n = 0; n < 40; n++) {
        const Eigen::Vector3d v(1.2 * unit(rng), 0.2 * unit(rng), 2.5 * unit(rng));
        expect_straightened(300 + n * 15, n % 4 < 2 ? 100000 : 200000, n % 2 ? 1 : -1, v, rng);
    }
}

// As many beams, and as slow, as a scan may have.
TEST(Deskew, MovesTheBeamsOfTheSlowestTurnToItsEnd)
{
    std::mt19937 rng(3);
    for (const double way : {1.0, -1.0}) {
        expect_straightened(ALE_MAX_BEAMS, ALE_MAX_SWEEP_US, way, {0.1, 0.02, 0.25}, rng);
    }
}

// A robot that begins to turn, straightened by its velocity at the stamp: what is left is the acceleration's
// part, a quarter of what it would be from the turn's beginning.
TEST(Deskew, AnAccelerationBendsAWholeTurnByAnEighthOfItsSquareAtMost)
{
    const double begun = 0.5, acceleration = 3, turn_s = 0.1, points = 450; // rad/s, rad/s^2
    const double eighth = acceleration * turn_s * turn_s / 8;
    for (const double way : {1.0, -1.0}) {
        const auto turn = std::make_unique<ale_turn_t>();
        const auto scan = std::make_unique<ale_scan_t>();
        ale_turn_begin(turn.get());
        for (int k = 0; k < points; k++) {
            const auto bearing = static_cast<int64_t>(way * k / points * 0x1p32);
            ale_turn_add(turn.get(), static_cast<uint32_t>(bearing), 2000000, ALE_BEAM_VALID);
        }
        turn->last_us = std::llround(turn_s * 1e6 * (points - 1) / points);
        scan->range_min_um = 20000;
        scan->range_max_um = 12000000;
        ASSERT_EQ(ale_turn_to_scan(turn.get(), scan.get()), ALE_TURN_FINE);
        const double stamp_s = static_cast<double>(scan->stamp_us) * 1e-6;
        const int32_t velocity[3] = {0, 0, convert::um((begun + acceleration * stamp_s) * tick_s)};
        std::vector<uint32_t> bearing(scan->beams);
        ASSERT_TRUE(ale_deskew(scan.get(), velocity, bearing.data()));
        double most = 0;
        for (int k = 0; k < scan->beams; k++) {
            const double at_s = ale_scan_beam_offset_us(scan.get(), k) * 1e-6;
            const double turned =
                convert::radians(bearing[static_cast<size_t>(k)] - ale_scan_bearing(scan.get(), k));
            const double true_turned =
                (begun + acceleration * stamp_s) * at_s + acceleration * at_s * at_s / 2;
            most = std::max(most, std::fabs(turned - true_turned));
        }
        EXPECT_NEAR(most, eighth, 0.02 * eighth);
    }
}

TEST(Deskew, LeavesWholeScansAndRestingSensorsAlone)
{
    ale_scan_t scan = {};
    scan.beams = 100;
    scan.step_bam = 4194304;
    uint32_t bearing[100];
    const int32_t fast[3] = {100000, 0, 200000};
    const int32_t still[3] = {0, 0, 0};
    EXPECT_FALSE(ale_deskew(&scan, fast, bearing));
    scan.beam_time_ns = 97656;
    EXPECT_FALSE(ale_deskew(&scan, still, bearing));
    EXPECT_TRUE(ale_deskew(&scan, fast, bearing));
}

TEST(Deskew, TheSensorsOwnVelocityHoldsTheTurnOfItsLever)
{
    const int32_t robot[3] = {convert::um(0.5 * tick_s), 0, convert::um(2 * tick_s)};
    int32_t own[3];
    ale_sensor_velocity(robot, convert::pose(reference::Pose(0.145, -0.1, reference::pi / 2)), own);
    // at the sensor: (0.5 + 2 * 0.1, 2 * 0.145), seen a quarter turn round
    EXPECT_NEAR(own[0], 2 * 0.145 * tick_s * 1e6, 2);
    EXPECT_NEAR(own[1], -0.7 * tick_s * 1e6, 2);
    EXPECT_EQ(own[2], robot[2]);
}
