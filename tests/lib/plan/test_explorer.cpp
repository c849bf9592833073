// lib/plan/explorer.c: its states, in a room whose poses are known. Whole explorations:
// tests/tools/lab/explore.
#include <cmath>
#include <memory>

#include <gtest/gtest.h>

#include "lib/motion/room.h"

extern "C" {
#include "plan/explorer.h"
}

namespace
{

class Explorer : public ::testing::Test
{
  protected:
    Explorer() : explorer_(std::make_unique<ale_explorer_t>())
    {
        const ale_explorer_config_t config = ale_explorer_default_config();
        ale_explorer_init(explorer_.get(), &config);
    }

    // One scan at the robot's place; then the robot does at once what it is told, for a tenth of a second.
    ale_velocity_t step(uint8_t state = ALE_STATE_GOOD, bool predicted = false)
    {
        room::Sensor sensor;
        sensor.beam_time_ns = 0;
        const ale_scan_t scan = room::scan_at(
            walls_, sensor, [&](double) { return pose_; }, 0.1 * steps_, rng_);
        ale_estimate_t estimate = {};
        estimate.stamp_us = scan.stamp_us;
        estimate.map = convert::pose(pose_);
        estimate.state = state;
        estimate.scan = static_cast<uint32_t>(steps_);
        estimate.epoch = epoch_;
        estimate.predicted = predicted;
        const ale_velocity_t velocity = ale_explorer_step(explorer_.get(), &scan, &estimate, scan.stamp_us);
        pose_ = reference::compose(pose_, {velocity.speed_um_s * 1e-7, 0, velocity.turn_urad_s * 1e-7});
        steps_++;
        return velocity;
    }

    static bool stands(const ale_velocity_t &velocity)
    {
        return velocity.speed_um_s == 0 && velocity.turn_urad_s == 0;
    }

    std::unique_ptr<ale_explorer_t> explorer_;
    std::vector<room::Wall> walls_ = room::l_shape();
    reference::Pose pose_{0.5, -0.5, 0.3};
    std::mt19937 rng_{1};
    int steps_ = 0;
    uint32_t epoch_ = 0;
};

} // namespace

TEST_F(Explorer, StandsUntilItIsAskedAndWhenItIsToldToStop)
{
    EXPECT_TRUE(stands(step()));
    EXPECT_EQ(explorer_->state, ALE_EXPLORER_OFF);
    ale_explorer_request(explorer_.get(), true);
    EXPECT_FALSE(stands(step()));
    EXPECT_EQ(explorer_->state, ALE_EXPLORER_EXPLORING);
    ale_explorer_request(explorer_.get(), false);
    EXPECT_TRUE(stands(step()));
    EXPECT_EQ(explorer_->state, ALE_EXPLORER_OFF);
}

TEST_F(Explorer, LostItStandsFirst)
{
    ale_explorer_request(explorer_.get(), true);
    EXPECT_FALSE(stands(step()));
    EXPECT_TRUE(stands(step(ALE_STATE_LOST)));
    EXPECT_FALSE(stands(step()));
}

TEST_F(Explorer, FoundAgainItGoesOnWhereverItHasWandered)
{
    ale_explorer_request(explorer_.get(), true);
    step();
    const reference::Pose before = pose_;
    while (steps_ < 300) {
        step(ALE_STATE_LOST);
    }
    EXPECT_GT(std::hypot(pose_[0] - before[0], pose_[1] - before[1]), 0.5);
    EXPECT_FALSE(stands(step()));
    EXPECT_EQ(explorer_->state, ALE_EXPLORER_EXPLORING);
    EXPECT_EQ(explorer_->home.x_um, convert::pose(before).x_um) << "home is where it was";
    EXPECT_EQ(explorer_->wander.steps, 0u);
}

TEST_F(Explorer, SeesTheWholeRoomAndComesBackToPlaceAndHeading)
{
    const reference::Pose start = pose_;
    ale_explorer_request(explorer_.get(), true);
    while (explorer_->state != ALE_EXPLORER_FINISHED && steps_ < 2000) {
        step();
        for (int k = 0; k < 36; k++) {
            ASSERT_GT(room::distance(walls_, pose_[0], pose_[1], k * reference::pi / 18), 0.2)
                << "step " << steps_;
        }
    }
    ASSERT_EQ(explorer_->state, ALE_EXPLORER_FINISHED);
    EXPECT_LT(std::hypot(pose_[0] - start[0], pose_[1] - start[1]), 0.05);
    EXPECT_LT(std::fabs(reference::wrap(pose_[2] - start[2])), 0.1);
    EXPECT_EQ(explorer_->planner.refused_count, 0u);
    for (double y = -1.8; y < 0.8; y += 0.1) {
        for (double x = -0.8; x < 3.4; x += 0.1) {
            EXPECT_TRUE(ale_grid_is_free(&explorer_->grid,
                                         ale_grid_cell(&explorer_->grid, {convert::um(x), convert::um(y)})))
                << x << ' ' << y;
        }
    }
    EXPECT_TRUE(stands(step())) << "and then stands";
    ale_explorer_request(explorer_.get(), true);
    step();
    EXPECT_EQ(explorer_->state, ALE_EXPLORER_EXPLORING) << "asked again, it begins anew";
}

TEST_F(Explorer, PredictedScansAddNothing)
{
    ale_explorer_request(explorer_.get(), true);
    step(ALE_STATE_WEAK, true);
    EXPECT_EQ(explorer_->grid.seen, 0u);
    step(ALE_STATE_WEAK, false);
    EXPECT_GT(explorer_->grid.seen, 1000u);
}

TEST_F(Explorer, WhenLoopsMoveTheMapHomeAndGridMoveWithIt)
{
    ale_explorer_request(explorer_.get(), true);
    const reference::Pose start = pose_;
    while (steps_ < 60) {
        step();
    }
    auto correction = std::make_unique<ale_correction_t>();
    correction->count = 1;
    correction->epoch = 7;
    correction->shift[0].shift = {300000, -200000, convert::bam(0.2)};
    ale_explorer_correct(explorer_.get(), correction.get());
    EXPECT_EQ(explorer_->home.x_um, convert::pose(start).x_um) << "that was another map";
    correction->epoch = explorer_->epoch;
    ale_explorer_correct(explorer_.get(), correction.get());
    const ale_point_t home =
        ale_pose_apply(correction->shift[0].shift, {convert::um(start[0]), convert::um(start[1])});
    EXPECT_NEAR(explorer_->home.x_um, home.x_um, 2);
    EXPECT_NEAR(explorer_->home.y_um, home.y_um, 2);
    uint32_t hit = 0;
    uint32_t seen = 0;
    for (double x = -1; x < 5; x += 0.1, seen++) { // the long wall below, where it lies now
        const ale_point_t p = ale_pose_apply(correction->shift[0].shift, {convert::um(x), convert::um(-2)});
        hit += ale_grid_is_occupied(&explorer_->grid, ale_grid_cell(&explorer_->grid, p));
    }
    EXPECT_GT(hit * 10, seen * 6);
}

TEST_F(Explorer, ANewMapIsExploredFromWhereTheRobotStands)
{
    ale_explorer_request(explorer_.get(), true);
    while (steps_ < 60) {
        step();
    }
    epoch_ = 1;
    const reference::Pose here = pose_;
    step();
    EXPECT_EQ(explorer_->home.x_um, convert::pose(here).x_um);
    EXPECT_EQ(explorer_->kept.count, 1u);
}

TEST_F(Explorer, AGoalThatCannotBeReachedIsGivenUpAndTheRobotGoesHome)
{
    // Something that the scanner does not see holds the robot: it never gets on.
    ale_explorer_request(explorer_.get(), true);
    const reference::Pose held = pose_;
    while (explorer_->state == ALE_EXPLORER_EXPLORING && steps_ < 20000) {
        step();
        pose_.head<2>() = held.head<2>();
    }
    EXPECT_GT(explorer_->planner.refused_count, 0u);
    for (int k = 0; k < 200 && explorer_->state != ALE_EXPLORER_FINISHED; k++) {
        step();
    }
    EXPECT_EQ(explorer_->state, ALE_EXPLORER_FINISHED) << "home is where it stands";
}

namespace
{

std::unique_ptr<ale_map_t> map_of(const std::vector<room::Wall> &walls, uint32_t map_id = 0)
{
    auto map = std::make_unique<ale_map_t>();
    for (const room::Wall &wall : walls) {
        ale_map_line_t &line = map->line[map->line_count++];
        line.start = {convert::um(wall.x1), convert::um(wall.y1)};
        line.end = {convert::um(wall.x2), convert::um(wall.y2)};
        line.map_id = map_id;
    }
    return map;
}

} // namespace

class Going : public Explorer
{
  protected:
    void go(double x, double y, const ale_map_t *map = nullptr)
    {
        ale_explorer_go(explorer_.get(), {convert::um(x), convert::um(y)}, map);
    }
    // Steps until it is over, 600 at most; how far it then is from there.
    double drive(double x, double y)
    {
        for (int k = 0; k < 600 && ale_explorer_is_active(explorer_.get()); k++) {
            step();
        }
        return std::hypot(pose_.x() - x, pose_.y() - y);
    }
};

TEST_F(Going, DrivesToThePlaceAndStandsThere)
{
    go(1.5, 0.5);
    EXPECT_TRUE(ale_explorer_is_active(explorer_.get()));
    EXPECT_LT(drive(1.5, 0.5), 0.05);
    EXPECT_EQ(explorer_->state, ALE_EXPLORER_ARRIVED);
    EXPECT_TRUE(stands(step()));
}

TEST_F(Going, StopsWhenItIsToldTo)
{
    go(1.5, 0.5);
    EXPECT_FALSE(stands(step()));
    ale_explorer_request(explorer_.get(), false);
    EXPECT_TRUE(stands(step()));
    EXPECT_EQ(explorer_->state, ALE_EXPLORER_OFF);
}

TEST_F(Going, ExploringAndGoingTakeEachOthersPlace)
{
    ale_explorer_request(explorer_.get(), true);
    step();
    go(1.5, 0.5);
    step();
    EXPECT_EQ(explorer_->state, ALE_EXPLORER_GOING);
    ale_explorer_request(explorer_.get(), true);
    step();
    EXPECT_EQ(explorer_->state, ALE_EXPLORER_EXPLORING);
    EXPECT_EQ(explorer_->walls.count, 0U);
}

TEST_F(Going, APlaceInAWallIsGivenUpForWantOfRoom)
{
    const auto map = map_of(walls_);
    const ale_point_t in_wall = map->line[0].start;
    ale_explorer_go(explorer_.get(), in_wall, map.get());
    drive(0, 0);
    EXPECT_EQ(explorer_->state, ALE_EXPLORER_GIVEN_UP);
    EXPECT_EQ(explorer_->why, ALE_GIVEN_UP_TAKEN);
    EXPECT_LT(steps_, 20) << "at once, not after a search on wheels";
}

TEST_F(Going, APlaceBehindWallsThatTheMapKnowsIsGivenUpWithoutAMove)
{
    std::vector<room::Wall> walls = walls_;
    const std::vector<room::Wall> box = {{6, 6, 9, 6}, {9, 6, 9, 9}, {9, 9, 6, 9}, {6, 9, 6, 6}};
    walls.insert(walls.end(), box.begin(), box.end());
    const auto map = map_of(walls);
    go(7.5, 7.5, map.get());
    drive(7.5, 7.5);
    EXPECT_EQ(explorer_->state, ALE_EXPLORER_GIVEN_UP);
    EXPECT_EQ(explorer_->why, ALE_GIVEN_UP_CLOSED);
}

TEST_F(Going, WallsOfAMapThatIsNotJoinedDoNotStandInTheWay)
{
    const std::vector<room::Wall> across = {{1.0, -5, 1.0, 5}};
    const auto other = map_of(across, 7);
    go(1.5, 0.5, other.get());
    EXPECT_LT(drive(1.5, 0.5), 0.05);
    EXPECT_EQ(explorer_->state, ALE_EXPLORER_ARRIVED);
}

TEST_F(Going, AWallOfTheMapThatIsNotThereAnyMoreIsSeenThrough)
{
    const std::vector<room::Wall> across = {{1.0, -5, 1.0, 5}};
    const auto map = map_of(across);
    go(1.5, 0.5, map.get());
    EXPECT_LT(drive(1.5, 0.5), 0.05);
}

TEST_F(Going, FartherThanTheGridIsTooFar)
{
    go(80, 0);
    drive(0, 0);
    EXPECT_EQ(explorer_->why, ALE_GIVEN_UP_FAR);
}

TEST_F(Going, LostItDoesNotSetOffAndOnTheWayItStandsForSomeSecondsBeforeItGivesUp)
{
    go(1.5, 0.5);
    EXPECT_TRUE(stands(step(ALE_STATE_LOST)));
    EXPECT_EQ(explorer_->why, ALE_GIVEN_UP_LOST);
    go(1.5, 0.5);
    EXPECT_FALSE(stands(step()));
    for (int k = 0; k < 50; k++) {
        EXPECT_TRUE(stands(step(ALE_STATE_LOST)));
    }
    EXPECT_EQ(explorer_->state, ALE_EXPLORER_GOING);
    EXPECT_FALSE(stands(step()));
    for (int k = 0; k < 90; k++) {
        EXPECT_TRUE(stands(step(ALE_STATE_LOST)));
    }
    EXPECT_EQ(explorer_->state, ALE_EXPLORER_GIVEN_UP);
    EXPECT_EQ(explorer_->why, ALE_GIVEN_UP_LOST);
}

TEST_F(Going, InAnotherMapThePlaceMeansNothing)
{
    go(1.5, 0.5);
    step();
    epoch_++;
    EXPECT_TRUE(stands(step()));
    EXPECT_EQ(explorer_->why, ALE_GIVEN_UP_MAP);
}
