// What comes from the robot, checked and pinned: restarts, overtaken scans, and messages out of this world.
#include "operator/console/robot_watch.h"

#include <cmath>
#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>

using console::Board;
using console::RobotWatch;
using console::Topic;

namespace
{

ale::pose_t pose_of(int32_t scan, float x = 0)
{
    ale::pose_t pose{};
    pose.scan = scan;
    pose.state = 2;
    pose.map_x = x;
    return pose;
}

ale::status_t status_of(int64_t boot)
{
    ale::status_t status{};
    status.boot = boot;
    return status;
}

class RobotWatched : public testing::Test
{
  protected:
    Board board;
    console::Commander commander{"", ""};
    RobotWatch watch{board, commander};
};

} // namespace

TEST_F(RobotWatched, GapsInTheScanNumbersAreLostPoses)
{
    for (const int scan : {3, 4, 8, 9}) {
        watch.pose(pose_of(scan));
    }
    EXPECT_EQ(board.link(Board::Clock::now()).lost_poses, 3U);
    EXPECT_EQ(board.link(Board::Clock::now()).poses, 4U);
}

TEST_F(RobotWatched, AnOvertakenScanIsLeftOut)
{
    watch.pose(pose_of(20));
    const auto before = board.newest(Topic::pose);
    watch.pose(pose_of(19));
    watch.pose(pose_of(20));
    EXPECT_EQ(board.newest(Topic::pose).number, before.number);
    EXPECT_EQ(board.life(), 1U);
}

TEST_F(RobotWatched, ScanNumbersThatBeginAgainAreANewLife)
{
    watch.pose(pose_of(500));
    watch.pose(pose_of(0));
    EXPECT_EQ(board.life(), 2U);
    EXPECT_EQ(board.link(Board::Clock::now()).poses, 1U);
}

TEST_F(RobotWatched, ARestartIsNoticedOnceByPoseAndStatusTogether)
{
    watch.status(status_of(1));
    watch.pose(pose_of(500));
    watch.pose(pose_of(0));
    watch.status(status_of(2));
    EXPECT_EQ(board.life(), 2U);
    EXPECT_TRUE(board.newest(Topic::pose).text) << "the new life's pose must survive the status";
}

TEST_F(RobotWatched, ARestartThatThePosesDoNotShowIsNoticedByTheStatus)
{
    watch.status(status_of(1));
    watch.pose(pose_of(3));
    watch.status(status_of(2));
    EXPECT_EQ(board.life(), 2U);
    watch.status(status_of(2));
    EXPECT_EQ(board.life(), 2U);
}

TEST_F(RobotWatched, AJumpOfTheMapPoseBreaksTheTrail)
{
    watch.pose(pose_of(0, 0));
    watch.pose(pose_of(1, 0.1F));
    watch.pose(pose_of(2, 5.0F));
    const auto trail = board.trail(0, 0, 100);
    ASSERT_EQ(trail.points.size(), 3U);
    EXPECT_TRUE(trail.points[0].first);
    EXPECT_FALSE(trail.points[1].first);
    EXPECT_TRUE(trail.points[2].first);
}

TEST_F(RobotWatched, MessagesOutOfThisWorldAreRefused)
{
    const float nan = std::numeric_limits<float>::quiet_NaN();
    auto pose = pose_of(1, nan);
    EXPECT_THROW(watch.pose(pose), std::runtime_error);
    pose = pose_of(1, 2e6F);
    EXPECT_THROW(watch.pose(pose), std::runtime_error);
    pose = pose_of(-1);
    EXPECT_THROW(watch.pose(pose), std::runtime_error);
    pose = pose_of(1);
    pose.state = 3;
    EXPECT_THROW(watch.pose(pose), std::runtime_error);
    EXPECT_FALSE(board.newest(Topic::pose).text);

    ale::features_t features{};
    features.lines.resize(1);
    features.lines[0].x2 = nan;
    EXPECT_THROW(watch.features(features), std::runtime_error);

    ale::map_t map{};
    map.parts = 1;
    map.corners.resize(1);
    map.corners[0].y = nan;
    EXPECT_THROW(watch.map(map), std::runtime_error);

    ale::scan_t scan{};
    scan.num_ranges = scan.num_codes = 2000;
    EXPECT_THROW(watch.scan(scan), std::runtime_error);
    scan.num_ranges = 3;
    scan.num_codes = 2;
    EXPECT_THROW(watch.scan(scan), std::runtime_error);
}

TEST_F(RobotWatched, AScanNumberOutOfAllProportionDoesNotCountAsLoss)
{
    watch.pose(pose_of(1));
    EXPECT_THROW(watch.pose(pose_of(2000000000)), std::runtime_error);
    EXPECT_EQ(board.link(Board::Clock::now()).lost_poses, 0U);
}
