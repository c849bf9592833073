#include <gtest/gtest.h>

#include "log_text.hpp"

extern "C" {
#include "base/trig.h"
}

using ale_test::error_of;
using ale_test::read_bytes;
using ale_test::repeated;

namespace
{

constexpr int32_t degree_bam = 11930465;

std::string flaser(int beams, const std::string &tail, const std::string &range = "1.5")
{
    return "FLASER " + std::to_string(beams) + repeated(range, beams) + " " + tail + "\n";
}

std::string robot_laser(const std::string &head, int beams, const std::string &tail)
{
    return "ROBOTLASER1 " + head + " " + std::to_string(beams) + repeated("1.5", beams) + " 0 " + tail + "\n";
}

TEST(Carmen, BeamsOfAFlaserLieByTheirNumber)
{
    struct Case {
        int beams;
        double first_degrees;
        double step_degrees;
    };
    for (const Case &c : {Case{180, -90, 1}, Case{181, -90, 1}, Case{360, -90, 0.5}, Case{361, -90, 0.5},
                          Case{721, -90, 0.25}, Case{1081, -135, 0.25}, Case{541, -135, 0.5},
                          Case{401, -50, 0.25}, Case{91, -90, 2}}) {
        const auto scans = read_bytes(flaser(c.beams, "0 0 0 0 0 0 12.5 host 1")).scans();
        ASSERT_EQ(scans.size(), 1U);
        EXPECT_EQ(scans[0].beams, c.beams);
        EXPECT_NEAR(ale_bam_diff(scans[0].first_bearing_bam, 0), c.first_degrees * degree_bam, 60) << c.beams;
        EXPECT_NEAR(scans[0].step_bam, c.step_degrees * degree_bam, 1) << c.beams;
        EXPECT_EQ(scans[0].stamp_us, 12500000);
        EXPECT_EQ(scans[0].range_um[c.beams - 1], 1500000);
        EXPECT_EQ(scans[0].beam_time_ns, 0);
    }
}

TEST(Carmen, OdometryComesFromColumnsFourToSixAndBeforeItsScan)
{
    const auto log = read_bytes(flaser(3, "9 9 9 1.25 -2.5 3 7 h 1") + flaser(3, "9 9 9 1.5 -2.5 -3 8 h 1"));
    ASSERT_EQ(log.events.size(), 4U);
    EXPECT_EQ(log.events[0].kind, ALE_LOG_ODOMETRY);
    EXPECT_EQ(log.events[1].kind, ALE_LOG_SCAN);
    EXPECT_EQ(log.events[0].odometry.stamp_us, 7000000);
    EXPECT_EQ(log.events[0].odometry.pose.x_um, 1250000);
    EXPECT_EQ(log.events[0].odometry.pose.y_um, -2500000);
    EXPECT_NEAR(static_cast<double>(ale_bam_to_nrad(ale_bam_diff(log.events[0].odometry.pose.theta_bam, 0))),
                3e9, 2);
    EXPECT_FALSE(log.info.has_sensor) << "poses that do not move together are no mounting";
}

TEST(Carmen, PosesOfLaserAndRobotFarApartAreNoMountingAndDisturbNothing)
{
    const auto log = read_bytes(flaser(3, "112 -2132 5 -2132 112 3 7 h 1") + flaser(3, "1 2 0 1 2 0 8 h 1"));
    EXPECT_EQ(log.scans().size(), 2U);
    EXPECT_FALSE(log.info.has_sensor);
}

TEST(Carmen, ColumnsThatNeverChangeAreNoOdometry)
{
    const auto log = read_bytes(flaser(3, "0 0 0 0 0 0 1 h 1") + flaser(3, "0 0 0 0 0 0 2 h 1"));
    EXPECT_FALSE(log.info.has_odometry);
    EXPECT_EQ(log.events.size(), 2U);
}

TEST(Carmen, ValuesThatMeanNoReturnAreNoRanges)
{
    const auto log =
        read_bytes("FLASER 10 0 31.9 32.767 32.763 50 81.83 81.91 nan 49.9 0.01 0 0 0 0 0 0 1 h 1\n");
    const ale_scan_t scan = log.scans().at(0);
    for (int k = 0; k < 8; k++) {
        EXPECT_EQ(scan.flag[k], ALE_BEAM_NO_RETURN) << k;
        EXPECT_EQ(scan.range_um[k], 0) << k;
    }
    EXPECT_EQ(scan.flag[8], ALE_BEAM_VALID);
    EXPECT_EQ(scan.range_um[8], 49900000);
    EXPECT_EQ(scan.flag[9], ALE_BEAM_TOO_NEAR);
}

TEST(Carmen, RobotLaserStatesGeometryMaximumAndMounting)
{
    const std::string poses = "1.145 2 0 1 2 0 0.5 0.1 0 0 0 33.25 sim 1";
    const auto log = read_bytes("# beam_time_us 97.656 stamp_beam 340\n" +
                                robot_laser("4 -2.086213872 4.178563666 0.006135923 1.5 0.01 0", 682, poses) +
                                robot_laser("4 -2.086213872 4.178563666 0.006135923 4.094 0.01 0", 682,
                                            "1 2.145 1.570796327 1 2 1.570796327 0 0 0 0 0 33.35 sim 1"));
    const auto scans = log.scans();
    ASSERT_EQ(scans.size(), 2U);
    EXPECT_EQ(scans[0].step_bam, 1 << 22) << "1/1024 of a turn exactly";
    EXPECT_EQ(ale_scan_bearing(&scans[0], 340), 0U);
    EXPECT_EQ(scans[0].stamp_us, 33250000);
    EXPECT_EQ(scans[0].beam_time_ns, 97656);
    EXPECT_EQ(scans[0].stamp_beam, 340);
    EXPECT_EQ(scans[0].flag[5], ALE_BEAM_NO_RETURN) << "from the stated maximum on";
    EXPECT_EQ(scans[1].flag[5], ALE_BEAM_VALID);
    EXPECT_TRUE(log.info.has_sensor);
    EXPECT_NEAR(log.info.sensor.x_um, 145000, 2);
    EXPECT_NEAR(log.info.sensor.y_um, 0, 2);
    EXPECT_TRUE(log.info.urg_noise);
    EXPECT_EQ(log.odometry().at(1).pose.x_um, 1000000) << "the robot's pose, not the laser's";
}

TEST(Carmen, RemissionsAreSkippedAndNegativeStepsKept)
{
    const auto log = read_bytes("ROBOTLASER1 0 1.570796 3.141593 -0.017453 50 0.1 0 3 1 2 3 3 7 8 9 "
                                "1 2 0.5 1 2 0.5 0 0 0 0 0 5 h 1\n");
    const ale_scan_t scan = log.scans().at(0);
    EXPECT_EQ(scan.step_bam, -degree_bam);
    EXPECT_EQ(scan.stamp_us, 5000000);
    EXPECT_EQ(scan.range_um[2], 3000000);
}

TEST(Carmen, OdomLinesAreEventsOfTheirOwn)
{
    const auto log = read_bytes("ODOM 0 0 0 0 0 0 1 h 1\nODOM 8e-06 0 0 0 0 0 1.5 h 1\n" +
                                flaser(3, "0.5 0 0 0.5 0 0 2 h 1"));
    ASSERT_EQ(log.odometry().size(), 3U);
    EXPECT_EQ(log.odometry()[1].pose.x_um, 8);
    EXPECT_EQ(log.odometry()[1].stamp_us, 1500000);
}

TEST(Carmen, OdomLinesBesideScansThatHaveOdometryAreNotUsed)
{
    const auto log = read_bytes("ODOM 0 0 0 0 0 0 1 h 1\n" + flaser(3, "0 0 0 0 0 0 1.1 h 1") +
                                "ODOM 0.4 0 0 0 0 0 0.5 h 1\nODOM 0.5 0 0 0 0 0 2 h 1\n" +
                                flaser(3, "0.4 0 0 0.4 0 0 2.1 h 1"));
    ASSERT_EQ(log.odometry().size(), 2U);
    EXPECT_EQ(log.odometry()[0].stamp_us, 1100000);
    EXPECT_EQ(log.odometry()[1].pose.x_um, 400000);
    EXPECT_EQ(log.odometry()[1].stamp_us, 2100000);
    EXPECT_EQ(log.scans().size(), 2U);
}

TEST(Carmen, ColumnsLeftEmptyBesideOdomLinesAreNotUsed)
{
    const auto log = read_bytes("ODOM 1 0 0 0 0 0 1 h 1\n" + flaser(3, "0 0 0 0 0 0 1.1 h 1") +
                                "ODOM 1.5 0 0 0 0 0 2 h 1\n" + flaser(3, "0 0 0 0 0 0 2.1 h 1"));
    ASSERT_EQ(log.odometry().size(), 2U);
    EXPECT_EQ(log.odometry()[0].pose.x_um, 1000000);
    EXPECT_EQ(log.odometry()[1].pose.x_um, 1500000);
}

TEST(Carmen, TheOffsetParameterIsTheMounting)
{
    const auto log =
        read_bytes("PARAM robot_frontlaser_offset -0.04 nohost 0\n" + flaser(3, "1 2 3 1 2 3 1 h 1"));
    EXPECT_TRUE(log.info.has_sensor);
    EXPECT_EQ(log.info.sensor.x_um, -40000);
}

TEST(Carmen, TheFirstLaserIsFollowedAndARearLaserLooksBack)
{
    const std::string front = flaser(3, "0 0 0 0 0 0 1 h 1");
    std::string rear = front;
    rear[0] = 'R';
    const auto both = read_bytes(front + rear + front);
    EXPECT_EQ(both.scans().size(), 2U);
    const auto alone = read_bytes(rear);
    EXPECT_EQ(alone.scans().size(), 1U);
    EXPECT_TRUE(alone.info.has_sensor);
    EXPECT_EQ(alone.info.sensor.theta_bam, ALE_BAM_HALF_TURN);
}

TEST(Carmen, StampsThatDoNotAdvanceAreReplacedByTenASecond)
{
    std::string falling;
    for (int k = 0; k < 5; k++) {
        falling += flaser(3, "0 0 0 0 0 " + std::to_string(k) + " " + std::to_string(-0.4 * k) + " h 1");
    }
    const auto scans = read_bytes(falling).scans();
    ASSERT_EQ(scans.size(), 5U);
    for (int k = 0; k < 5; k++) {
        EXPECT_EQ(scans[static_cast<size_t>(k)].stamp_us, k * 100000);
    }
}

TEST(Carmen, ASingleStepBackInTheStampsIsHandedOnAsItIs)
{
    const auto scans = read_bytes(flaser(3, "0 0 0 0 0 0 1 h 1") + flaser(3, "0 0 0 0 0 0 2 h 1") +
                                  flaser(3, "0 0 0 0 0 0 1.5 h 1") + flaser(3, "0 0 0 0 0 0 3 h 1"))
                           .scans();
    EXPECT_EQ(scans.at(2).stamp_us, 1500000);
}

TEST(Carmen, BadLinesAreCountedAndTheRestIsRead)
{
    const std::string good = flaser(3, "0 0 0 0 0 0 1 h 1");
    const auto log = read_bytes(good + "FLASER 5 1 2 3\n" + "FLASER x\n" + "FLASER 0 0 0 0 0 0 0 1 h 1\n" +
                                "FLASER 2 1 zwei 0 0 0 0 0 0 1 h 1\n" + "12 13 14\n" + "ODOM 1 2\n" +
                                "NEFF 12 is another message\n# a comment\n\n" + good);
    EXPECT_EQ(log.scans().size(), 2U);
    EXPECT_EQ(log.statistics.bad_lines, 6U);
    EXPECT_EQ(log.last_error, "memory: line 7: unreadable ODOM line");
}

TEST(Carmen, AScanWhoseOdometryNoPoseHoldsIsReadWithoutIt)
{
    const auto log = read_bytes(flaser(3, "0 0 0 1 2 0.5 1 h 1") + flaser(3, "0 0 0 2147.5 0 0 2 h 1") +
                                flaser(3, "0 0 0 0 -31234.5 0 3 h 1") + flaser(3, "0 0 0 nan nan nan 4 h 1") +
                                flaser(3, "0 0 0 2147.25 0 0 5 h 1") + flaser(3, "0 0 0 1 x 0 6 h 1"));
    const auto scans = log.scans();
    ASSERT_EQ(scans.size(), 5U);
    EXPECT_EQ(scans[3].stamp_us, 4000000);
    const auto odometry = log.odometry();
    ASSERT_EQ(odometry.size(), 2U);
    EXPECT_EQ(odometry[1].stamp_us, 5000000);
    EXPECT_EQ(odometry[1].pose.x_um, 2147250000);
    EXPECT_EQ(log.statistics.poses_beyond, 3U);
    EXPECT_EQ(log.statistics.bad_lines, 1U);
}

TEST(Carmen, TimesThatNoClockAndNoScannerHasLeaveOutTheirScan)
{
    const auto log = read_bytes(flaser(3, "0 0 0 0 0 0 1 h 1") + flaser(3, "0 0 0 0 0 0 4e12 h 1") +
                                flaser(3, "0 0 0 0 0 0 -4e12 h 1") + flaser(3, "0 0 0 0 0 0 2 h 1"));
    EXPECT_EQ(log.scans().size(), 2U);
    EXPECT_EQ(log.statistics.times_beyond, 2U);
    EXPECT_NE(log.last_error.find("a stamp or a sweep that no clock and no scanner has"), std::string::npos);
    const auto swept =
        read_bytes("# beam_time_us 97.656 stamp_beam 340000000\n" + flaser(3, "0 0 0 0 0 0 1 h 1"));
    EXPECT_EQ(swept.scans().size(), 0U);
    EXPECT_EQ(swept.statistics.times_beyond, 1U);
}

TEST(Carmen, ALaserPoseThatIsBeyondStatesNoMountingAndLeavesTheOdometry)
{
    const auto log = read_bytes(flaser(3, "5000 0 0 1 2 0.5 1 h 1") + flaser(3, "1.3 2 0 1 2 0 2 h 1"));
    EXPECT_EQ(log.odometry().size(), 2U);
    EXPECT_EQ(log.statistics.poses_beyond, 0U);
    EXPECT_EQ(log.info.sensor.x_um, 300000);
}

TEST(Carmen, OdomLinesBeyondAPoseAreCountedAndLeftOut)
{
    const auto log = read_bytes("ODOM 5000 0 0 0 0 0 1 h 1\nODOM 1 0 0 0 0 0 2 h 1\n" +
                                flaser(3, "0 0 0 0 0 0 2 h 1") + "ODOM 2 0 0 0 0 0 3 h 1\n");
    EXPECT_EQ(log.odometry().size(), 3U); // and that of the scan
    EXPECT_EQ(log.statistics.poses_beyond, 1U);
    EXPECT_EQ(log.last_error,
              "memory: line 1: odometry that no pose holds (farther than 2147 m, or no number)");
}

TEST(Carmen, ScansOfTooManyBeamsAreAnErrorAtTheStartAndCountedLater)
{
    const std::string large = flaser(1082, "0 0 0 0 0 0 1 h 1");
    EXPECT_EQ(error_of(large), "memory: scan of 1082 beams; at most 1081 are possible");
    const auto log = read_bytes(flaser(3, "0 0 0 0 0 0 1 h 1") + large);
    EXPECT_EQ(log.scans().size(), 1U);
    EXPECT_EQ(log.statistics.too_many_beams, 1U);
}

TEST(Carmen, ALastLineWithoutItsEndIsReadIfComplete)
{
    std::string text = flaser(3, "0 0 0 0 0 0 1 h 1") + flaser(3, "0 0 0 0 0 0 2 h 1");
    text.pop_back();
    EXPECT_EQ(read_bytes(text).scans().size(), 2U);
    text.resize(text.size() - 20);
    const auto cut = read_bytes(text);
    EXPECT_EQ(cut.scans().size(), 1U);
    EXPECT_EQ(cut.statistics.bad_lines, 1U);
}

} // namespace
