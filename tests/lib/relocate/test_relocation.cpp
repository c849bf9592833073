// lib/relocate/relocation: lost in a known map.
#include <gtest/gtest.h>

#include "lib/track/room_pipeline.h"

extern "C" {
#include "track/pipeline_state.h"
}

namespace
{

// A rectangle looks the same after half a turn.
std::vector<room::Wall> rectangle()
{
    return {{-1.5, -2, 4.5, -2}, {4.5, -2, 4.5, 2.4}, {4.5, 2.4, -1.5, 2.4}, {-1.5, 2.4, -1.5, -2}};
}

// Two long walls, and a board that stands out from one of them.
std::vector<room::Wall> corridor(double board)
{
    return {{-20, -2, 20, -2}, {20, 2.4, -20, 2.4}, {board, 2.4, board, 1.9}};
}

struct Robot {
    room::Pipeline pipeline = room::make(ale_pipeline_default_config());
    ale_estimate_t last = {};
    std::mt19937 rng{17};

    void see(const std::vector<room::Wall> &walls, double t)
    {
        see(walls, t, room::path);
    }
    template <typename Path> void count(double t, Path path)
    {
        const ale_odometry_t sample = {std::llround(t * 1e6), convert::pose(path(t))};
        ale_pipeline_odometry(pipeline.get(), &sample);
    }
    template <typename Path> void see(const std::vector<room::Wall> &walls, double t, Path path)
    {
        room::Sensor sensor;
        sensor.noise = 0.003;
        const ale_scan_t scan = room::scan_at(walls, sensor, path, t, rng);
        ale_pipeline_scan(pipeline.get(), &scan, &last);
    }
};

std::unique_ptr<ale_map_t> map_of(const std::vector<room::Wall> &walls)
{
    Robot robot;
    for (int k = 0; k < 150; k++) {
        robot.see(walls, 1 + 0.1 * k);
    }
    auto map = std::make_unique<ale_map_t>();
    ale_pipeline_copy_map(robot.pipeline.get(), map.get());
    return map;
}

TEST(Relocation, APlaceThatIsRecognisedGoesWithTheRobotAndIsAskedForOnce)
{
    const auto relocation = std::make_unique<ale_relocation_t>();
    ale_pose_t at;
    ale_relocation_clear(relocation.get());
    EXPECT_FALSE(ale_relocation_recognised(relocation.get(), &at));
    ale_relocation_recognise(relocation.get(), {1000000, 2000000, ALE_BAM_QUARTER_TURN});
    ale_relocation_follow(relocation.get(), {300000, 0, 0}, true);
    ASSERT_TRUE(ale_relocation_recognised(relocation.get(), &at));
    EXPECT_NEAR(at.x_um, 1000000, 1);
    EXPECT_NEAR(at.y_um, 2300000, 1);
    EXPECT_FALSE(ale_relocation_recognised(relocation.get(), &at));
    ale_relocation_recognise(relocation.get(), at);
    ale_relocation_clear(relocation.get());
    EXPECT_FALSE(ale_relocation_recognised(relocation.get(), &at));
}

TEST(Relocation, TheRobotFindsItselfWhereOnlyOnePlaceFits)
{
    const auto map = map_of(room::l_shape());
    for (const double start : {3.0, 7.0, 12.0}) {
        Robot robot;
        ale_pipeline_load_map(robot.pipeline.get(), map.get(), 1, {0, 0, 0}, false);
        int found_at = -1;
        for (int k = 0; k < 60; k++) {
            const double t = start + 0.1 * k;
            robot.see(room::l_shape(), t);
            const reference::Pose truth = room::since_start(room::path(1), room::path(t));
            const double off_m = (convert::pose(robot.last.map) - truth).head<2>().norm();
            if (robot.last.state != ALE_STATE_LOST) {
                EXPECT_LT(off_m, 0.03) << start << " " << k;
                found_at = found_at < 0 ? k : found_at;
            }
        }
        EXPECT_GT(found_at, 0) << "not before the places have been compared";
        EXPECT_LT(found_at, 40);
        EXPECT_EQ(robot.last.state, ALE_STATE_GOOD);
    }
}

// What the wheels' scale has made of the way is no part of a pose that the way did not lead to.
class WheelDrift : public testing::Test
{
  protected:
    WheelDrift()
    {
        robot.pipeline->scale_error = {800000, -600000};
    }
    void is_gone() const
    {
        EXPECT_EQ(robot.pipeline->scale_error.x_um, 0);
        EXPECT_EQ(robot.pipeline->scale_error.y_um, 0);
    }
    Robot robot;
};

TEST_F(WheelDrift, EndsWhereARobotThatWasLostIsFound)
{
    const auto map = map_of(room::l_shape());
    ale_pipeline_load_map(robot.pipeline.get(), map.get(), 1, {0, 0, 0}, false);
    robot.pipeline->scale_error = {800000, -600000};
    for (int k = 0; k < 60 && (k == 0 || robot.last.state == ALE_STATE_LOST); k++) {
        robot.see(room::l_shape(), 3 + 0.1 * k);
    }
    EXPECT_NE(robot.last.state, ALE_STATE_LOST);
    is_gone();
}

TEST_F(WheelDrift, EndsWhereTheRobotIsShownAPlace)
{
    ale_pipeline_relocate(robot.pipeline.get(), {1000000, 0, 0});
    is_gone();
}

TEST_F(WheelDrift, EndsWithTheMap)
{
    ale_pipeline_reset(robot.pipeline.get());
    is_gone();
}

// About 1 m/s: what was told of its rivals has to last longer than from one scan to the next.
TEST(Relocation, ARobotThatDrivesOnFastFindsItselfToo)
{
    const auto map = map_of(room::l_shape());
    const auto fast = [](double t) { return room::path(2.5 * t); };
    for (const double start : {1.0, 2.0, 3.0, 4.0}) {
        Robot robot;
        ale_pipeline_load_map(robot.pipeline.get(), map.get(), 1, {0, 0, 0}, false);
        int found_at = -1;
        for (int k = 0; k < 60 && found_at < 0; k++) {
            robot.count(start + 0.1 * k, fast);
            robot.see(room::l_shape(), start + 0.1 * k, fast);
            found_at = robot.last.state != ALE_STATE_LOST ? k : -1;
        }
        EXPECT_GT(found_at, 0) << start;
    }
}

// The places that are kept move on with the robot through scans that were damaged on the line.
TEST(Relocation, ARobotOfWhichThreeScansInFourAreDroppedFindsItselfToo)
{
    const auto map = map_of(room::l_shape());
    const auto fast = [](double t) { return room::path(2.5 * t); };
    for (const double start : {1.0, 2.0, 3.0, 4.0}) {
        Robot robot;
        ale_pipeline_load_map(robot.pipeline.get(), map.get(), 1, {0, 0, 0}, false);
        int found_at = -1;
        for (int k = 0; k < 240 && found_at < 0; k++) {
            const double t = start + 0.1 * k;
            robot.count(t, fast);
            if (k % 4 == 0) {
                robot.see(room::l_shape(), t, fast);
            } else {
                ale_pipeline_dropped(robot.pipeline.get(), std::llround(t * 1e6), &robot.last);
            }
            found_at = robot.last.state != ALE_STATE_LOST ? k : -1;
        }
        EXPECT_GT(found_at, 0) << start;
        const reference::Pose truth = room::since_start(room::path(1), fast(start + 0.1 * found_at));
        EXPECT_LT((convert::pose(robot.last.map) - truth).head<2>().norm(), 0.1) << start;
    }
}

TEST(Relocation, WhereTwoPlacesFitItSaysLostForAsLongAsThatLasts)
{
    const auto map = map_of(rectangle());
    Robot robot;
    ale_pipeline_load_map(robot.pipeline.get(), map.get(), 1, {0, 0, 0}, false);
    for (int k = 0; k < 150; k++) {
        robot.see(rectangle(), 5 + 0.1 * k);
        EXPECT_EQ(robot.last.state, ALE_STATE_LOST) << k;
    }
}

TEST(Relocation, WhereNextToNothingTellsHowFarAlongACorridorItSaysLost)
{
    const auto map = map_of(corridor(1.5));
    Robot robot;
    ale_pipeline_load_map(robot.pipeline.get(), map.get(), 1, {0, 0, 0}, false);
    for (int k = 0; k < 150; k++) {
        robot.see(corridor(2.5), 5 + 0.1 * k); // the board has been moved, or is another one
        EXPECT_EQ(robot.last.state, ALE_STATE_LOST) << k;
    }
}

TEST(Relocation, AnotherBuildingIsNotTaken)
{
    const auto map = map_of(room::l_shape());
    Robot robot;
    ale_pipeline_load_map(robot.pipeline.get(), map.get(), 1, {0, 0, 0}, false);
    for (int k = 0; k < 100; k++) {
        robot.see(rectangle(), 5 + 0.1 * k);
        EXPECT_EQ(robot.last.state, ALE_STATE_LOST) << k;
    }
}

} // namespace
