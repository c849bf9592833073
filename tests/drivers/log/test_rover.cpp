#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "log_text.hpp"

using ale_test::read_bytes;
using ale_test::repeated;

namespace
{

constexpr double metres_per_count = 2 * M_PI * 0.077 / 2000;
constexpr double half_axle = 0.165;

std::string line(long stamp_us, int left, int right, const std::string &ranges)
{
    return std::to_string(stamp_us) + " 14710 " + std::to_string(left) + " " + std::to_string(right) +
           repeated("3", 21) + " " + ranges + "\n";
}

std::string old_line(long stamp_us, int left, int right, const std::string &ranges)
{
    return std::to_string(stamp_us) + " " + std::to_string(left) + " " + std::to_string(-right) +
           repeated("0", 10) + " " + ranges + "\n";
}

const std::string wall = repeated("1500", 682);

TEST(Rover, RangesBeginWithTheTokenAfterTheHeader)
{
    const auto log = read_bytes(line(1000000, 0, 0, " 0 1234" + repeated("1500", 679) + " 777"));
    const ale_scan_t scan = log.scans().at(0);
    EXPECT_STREQ(log.info.format, "rover");
    EXPECT_EQ(scan.beams, 682);
    EXPECT_EQ(scan.range_um[1], 1234000);
    EXPECT_EQ(scan.range_um[681], 777000);
    EXPECT_EQ(ale_scan_bearing(&scan, 340), 0U) << "beam 340 looks straight ahead";
    EXPECT_EQ(scan.step_bam, 1 << 22);
}

TEST(Rover, TheSensorsGeometryTimingAndLagAreStated)
{
    const auto log = read_bytes(line(1000000, 0, 0, wall));
    const ale_scan_t scan = log.scans().at(0);
    EXPECT_EQ(scan.beam_time_ns, 97656);
    EXPECT_EQ(scan.stamp_beam, 340);
    EXPECT_EQ(scan.stamp_us, 1000000);
    EXPECT_EQ(log.info.lag_prior_us, 155000);
    EXPECT_TRUE(log.info.has_sensor);
    EXPECT_EQ(log.info.sensor.x_um, 145000);
    EXPECT_TRUE(log.info.urg_noise);
}

TEST(Rover, ErrorCodesKeepTheirMeaningAndTheBodyIsBlind)
{
    const auto log = read_bytes(line(1, 0, 0, repeated("0", 60) + " 7 16 0 5601 19" + repeated("1500", 617)));
    const ale_scan_t scan = log.scans().at(0);
    EXPECT_EQ(scan.flag[10], ALE_BEAM_BLIND);
    EXPECT_EQ(scan.flag[59], ALE_BEAM_NO_RETURN);
    EXPECT_EQ(scan.flag[60], ALE_BEAM_UNKNOWN);
    EXPECT_EQ(scan.code[60], 7);
    EXPECT_EQ(scan.code[61], 16);
    EXPECT_EQ(scan.flag[63], ALE_BEAM_NO_RETURN) << "beyond what the sensor measures";
    EXPECT_EQ(scan.flag[64], ALE_BEAM_BLIND);
}

TEST(Rover, BothColumnLayoutsGiveTheSameMotion)
{
    const auto a = read_bytes(line(1, 0, 0, wall) + line(100001, 100, 160, wall)).odometry();
    const auto b = read_bytes(old_line(1, 0, 0, wall) + old_line(100001, 100, 160, wall)).odometry();
    ASSERT_EQ(a.size(), 2U);
    ASSERT_EQ(b.size(), 2U);
    EXPECT_EQ(a[1].pose.x_um, b[1].pose.x_um);
    EXPECT_EQ(a[1].pose.y_um, b[1].pose.y_um);
    EXPECT_EQ(a[1].pose.theta_bam, b[1].pose.theta_bam);
    EXPECT_GT(a[1].pose.x_um, 0);
    EXPECT_GT(a[1].pose.theta_bam, 0U);
}

TEST(Rover, WheelsAreFollowedAsInDoublePrecision)
{
    std::mt19937 random(5);
    std::uniform_int_distribution<int> counts(-200, 800);
    std::string text = line(0, 0, 0, wall);
    double x = 0;
    double y = 0;
    double heading = 0;
    int left = 0;
    int right = 0;
    for (int k = 1; k <= 300; k++) {
        const int dl = counts(random);
        const int dr = counts(random);
        left += dl;
        right += dr;
        const double forward = (dl + dr) * metres_per_count / 2;
        const double turn = (dr - dl) * metres_per_count / (2 * half_axle);
        x += forward * std::cos(heading + turn / 2);
        y += forward * std::sin(heading + turn / 2);
        heading += turn;
        text += line(k * 100000L, left, right, wall);
    }
    const ale_pose_t last = read_bytes(text).odometry().back().pose;
    EXPECT_NEAR(last.x_um, x * 1e6, 2);
    EXPECT_NEAR(last.y_um, y * 1e6, 2);
    const double expected_bam = std::remainder(heading, 2 * M_PI) / (2 * M_PI) * 4294967296.0;
    EXPECT_NEAR(static_cast<int32_t>(last.theta_bam - static_cast<uint32_t>(std::llround(expected_bam))), 0,
                2);
}

TEST(Rover, ALineCutShortIsCountedAndNamed)
{
    const auto log = read_bytes(line(1, 0, 0, wall) + line(100001, 0, 5, wall) + "200001 1 2 3 4\n");
    EXPECT_EQ(log.scans().size(), 2U);
    EXPECT_EQ(log.statistics.bad_lines, 1U);
    EXPECT_EQ(log.last_error, "memory: line 3: 5 numbers instead of 707");
}

// Counts that leap as far as 32 bits go: forward, half a turn, back, half a turn, so that it adds up.
TEST(Rover, DamagedCountsTakeItNoFartherThanAPoseCanTell)
{
    const int half_turn = 4286; // counts between the wheels
    const int high = INT32_MAX - half_turn;
    const int low = INT32_MIN;
    std::string text;
    for (int k = 0; k < 10; k++) {
        text += line(400000L * k, low, low, wall) + line(400000L * k + 100000, high, high, wall) +
                line(400000L * k + 200000, high, high + half_turn, wall) +
                line(400000L * k + 300000, low, low + half_turn, wall);
    }
    const auto odometry = read_bytes(text).odometry();
    ASSERT_EQ(odometry.size(), 40U);
    EXPECT_EQ(odometry.back().pose.x_um, INT32_MAX);
}

} // namespace
