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
    console::Commander commander{console::Credentials{}};
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

TEST_F(RobotWatched, WheelsAreShownBesideTheScansOfTheSameWay)
{
    for (int k = 0; k < 3; k++) {
        ale::odometry_t sample{};
        sample.utime = 100000 * k;
        sample.x = 0.03F * static_cast<float>(k);
        watch.odometry(sample);
        ale::pose_t pose = pose_of(k);
        pose.utime = sample.utime;
        pose.x = 0.02F * static_cast<float>(k);
        watch.pose(pose);
    }
    const auto odometry = board.newest(Topic::odometry);
    EXPECT_EQ(odometry.number, 2U);
    EXPECT_NE(odometry.text->find(R"("wheels":[0.3,0.0])"), std::string::npos) << *odometry.text;
    EXPECT_NE(odometry.text->find(R"("scans":[0.2,0.0])"), std::string::npos) << *odometry.text;
    ale::odometry_t nowhere{};
    nowhere.x = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THROW(watch.odometry(nowhere), std::runtime_error);
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

/* Two walls, one of them in another map, told before the map, after it, and of another version. */
TEST_F(RobotWatched, AWallInAnotherMapIsToldAsSuchWheneverThatComes)
{
    ale::map_t map{};
    map.version = 4;
    map.parts = 1;
    map.lines.resize(2);
    map.lines[0].id = 10;
    map.lines[1].id = 11;
    ale::map_pieces_t pieces{};
    pieces.version = 4;
    pieces.parts = 1;
    pieces.num_lines = 1;
    pieces.line_id = {11};
    pieces.map_id = {2};
    const auto apart = [&] {
        return board.newest(Topic::map).text->find("\"map_id\":2") != std::string::npos;
    };

    watch.map(map);
    EXPECT_FALSE(apart());
    watch.map_pieces(pieces);
    EXPECT_TRUE(apart()) << "overtaken by the map";
    const uint64_t told = board.newest(Topic::map).number;
    watch.map_pieces(pieces);
    EXPECT_EQ(board.newest(Topic::map).number, told) << "which is not told again for nothing";
    ale::map_pieces_t of_another = pieces;
    of_another.version = 3;
    watch.map_pieces(of_another);
    EXPECT_EQ(board.newest(Topic::map).number, told) << "nor for a map that is not shown";
    pieces.num_lines = 0;
    pieces.line_id.clear();
    pieces.map_id.clear();
    watch.map_pieces(pieces);
    EXPECT_FALSE(apart()) << "joined";
    pieces.num_lines = 1;
    pieces.line_id = {11};
    pieces.map_id = {2};
    watch.map_pieces(pieces);
    watch.map(map);
    EXPECT_TRUE(apart());
    map.version = 5;
    watch.map(map);
    EXPECT_FALSE(apart()) << "of this one nothing is known yet";
}

TEST_F(RobotWatched, WhichMapAndWhatTheWheelsDoIsPinned)
{
    ale::tracking_t tracking{};
    tracking.map_id = 1;
    tracking.maps = 2;
    tracking.wheel_word = "stalled";
    watch.tracking(tracking);
    const std::string text = *board.newest(Topic::tracking).text;
    for (const char *part : {"\"map_id\":1", "\"maps\":2", "\"wheels\":\"stalled\""}) {
        EXPECT_NE(text.find(part), std::string::npos) << text;
    }
}

TEST_F(RobotWatched, WhereTheRobotDrivesByItselfIsPinned)
{
    ale::plan_t plan{};
    plan.state = 3;
    plan.words = "drives to 1.00 2.00: 3 m to go";
    plan.has_place = 1;
    plan.place_x = 1;
    plan.place_y = 2;
    plan.num_points = 2;
    plan.x = {0, 1};
    plan.y = {0, 2};
    watch.plan(plan);
    const std::string text = *board.newest(Topic::plan).text;
    for (const char *part : {"\"state\":\"goes\"", "\"place\":[1.0,2.0]", "\"path\":[0.0,0.0,1.0,2.0]"}) {
        EXPECT_NE(text.find(part), std::string::npos) << text;
    }
    plan.x[1] = std::numeric_limits<float>::infinity();
    EXPECT_THROW(watch.plan(plan), std::runtime_error);
    plan.x[1] = 1;
    plan.state = 6;
    EXPECT_THROW(watch.plan(plan), std::runtime_error);
    plan.state = 0;
    plan.num_points = 1000;
    EXPECT_THROW(watch.plan(plan), std::runtime_error);
}

ale::graph_t graph_of_three()
{
    ale::graph_t graph{};
    graph.version = 4;
    graph.keyframes_left_out = 5;
    graph.num_keyframes = 3;
    graph.scan = {0, 10, 20};
    graph.x = {0, 0.5F, 1};
    graph.y = {0, 0, 0.25F};
    graph.theta = {0, 0, 1};
    graph.map_id = {0, 0, 1};
    graph.tied = {1, 1, 0};
    graph.num_loops = 1;
    graph.loop_from = {0};
    graph.loop_to = {1};
    graph.loop_kind = {1};
    return graph;
}

TEST_F(RobotWatched, TheGraphOfTheMapperIsPinned)
{
    watch.graph(graph_of_three());
    const std::string text = *board.newest(Topic::graph).text;
    for (const char *part :
         {R"({"at":[0.0,0.0,0.0],"map_id":0,"tied":false})", R"({"at":[0.5,0.0,0.0],"map_id":0,"tied":true})",
          R"({"at":[1.0,0.25,1.0],"map_id":1,"tied":false})",
          R"("loops":[{"from":0,"kind":"closed","to":1}])", R"("left_out":[5,0])", R"("version":4)"}) {
        EXPECT_NE(text.find(part), std::string::npos) << text;
    }
}

TEST_F(RobotWatched, AGraphThatCannotBeIsRefused)
{
    const auto refused = [this](const auto &spoil) {
        ale::graph_t graph = graph_of_three();
        spoil(graph);
        EXPECT_THROW(watch.graph(graph), std::runtime_error);
    };
    refused([](ale::graph_t &graph) { graph.num_keyframes = 513; });
    refused([](ale::graph_t &graph) { graph.num_loops = 513; });
    refused([](ale::graph_t &graph) { graph.loops_left_out = -1; });
    refused([](ale::graph_t &graph) { graph.theta[2] = std::numeric_limits<float>::quiet_NaN(); });
    refused([](ale::graph_t &graph) { graph.loop_to[0] = 3; });
    refused([](ale::graph_t &graph) { graph.loop_from[0] = -1; });
    refused([](ale::graph_t &graph) { graph.loop_from[0] = 1; });
    refused([](ale::graph_t &graph) { graph.loop_kind[0] = 3; });
    EXPECT_FALSE(board.newest(Topic::graph).text);
}

TEST_F(RobotWatched, MessagesOutOfThisWorldAreRefused)
{
    ale::tracking_t tracking{};
    tracking.maps = -1;
    EXPECT_THROW(watch.tracking(tracking), std::runtime_error);
    tracking.maps = 1;
    tracking.wheel_word.assign(1000, 'w');
    EXPECT_THROW(watch.tracking(tracking), std::runtime_error);
    ale::map_pieces_t pieces{};
    pieces.num_lines = 100000;
    EXPECT_THROW(watch.map_pieces(pieces), std::runtime_error);

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
