/* The two small text formats: .scan lines and Odometry/Laser pairs. */
#include <gtest/gtest.h>

#include "log_text.hpp"

using ale_test::read_bytes;
using ale_test::repeated;

namespace
{

TEST(ScanLines, HoldAWholeTurnOfSteps)
{
    const auto log =
        read_bytes("1483992048.552206" + repeated("19", 44) + " 3318" + repeated("7", 681) + "\n");
    const ale_scan_t scan = log.scans().at(0);
    EXPECT_EQ(scan.beams, 726);
    EXPECT_EQ(scan.stamp_us, 1483992048552206);
    EXPECT_EQ(ale_scan_bearing(&scan, 384), 0U);
    EXPECT_EQ(scan.flag[43], ALE_BEAM_BLIND) << "19: not part of the field of view";
    EXPECT_EQ(scan.range_um[44], 3318000);
    EXPECT_EQ(scan.code[45], 7);
    EXPECT_FALSE(log.info.has_odometry);
}

TEST(ScanLines, OtherLinesAreBad)
{
    const std::string good = "1.5" + repeated("1000", 726) + "\n";
    const auto log = read_bytes(good + "2.5 1 2 3\n" + "3.5" + repeated("x", 726) + "\n" + good);
    EXPECT_EQ(log.scans().size(), 2U);
    EXPECT_EQ(log.statistics.bad_lines, 2U);
}

TEST(Pairs, OdometryBelongsToTheLaserLineThatFollows)
{
    const auto log = read_bytes("Odometry 1 2 0.5\nLaser 181" + repeated("1.5", 180) + " 8.183001\n" +
                                "Odometry 1.5 2 0.5\nLaser 181" + repeated("1.25", 181) + "\n");
    ASSERT_EQ(log.events.size(), 4U);
    EXPECT_EQ(log.events[0].kind, ALE_LOG_ODOMETRY);
    EXPECT_EQ(log.events[0].odometry.pose.x_um, 1000000);
    EXPECT_EQ(log.events[2].odometry.pose.x_um, 1500000);
    const ale_scan_t scan = log.scans().at(0);
    EXPECT_EQ(scan.beams, 181);
    EXPECT_EQ(scan.range_um[0], 1500000);
    EXPECT_EQ(scan.flag[180], ALE_BEAM_NO_RETURN);
    EXPECT_EQ(log.events[3].stamp_us, 100000) << "no stamps: ten scans a second";
    EXPECT_EQ(log.events[2].stamp_us, 100000);
}

TEST(Pairs, AMissingPartIsNoHarm)
{
    const auto log =
        read_bytes("Laser 3 1 2 3\nOdometry 1 2 x\nOdometry 1 2 3\nLaser 3 1 2\nLaser 3 1 2 3\n");
    EXPECT_EQ(log.scans().size(), 2U);
    EXPECT_EQ(log.statistics.bad_lines, 2U);
}

} // namespace
