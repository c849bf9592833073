// lib/plan/planner.c on drawn floors.
#include <cmath>
#include <memory>

#include <gtest/gtest.h>

#include "lib/motion/convert.h"
#include "maze.h"

extern "C" {
#include "plan/planner.h"
}

namespace
{

constexpr int scale = 6; // a character is 30 cm
const ale_planner_config_t small_robot = {28, 23, 20, 43, 20};

struct Floor {
    explicit Floor(const std::vector<std::string> &drawing, const ale_planner_config_t &config = small_robot)
        : lines(drawing), grid(maze::drawn(drawing, scale)), planner(std::make_unique<ale_planner_t>())
    {
        ale_planner_init(planner.get(), &config);
        ale_planner_update(planner.get(), grid.get());
    }

    ale_point_t at(char c) const
    {
        return maze::place(*grid, lines, c, scale);
    }
    bool go(char from, char to)
    {
        return ale_planner_go(planner.get(), grid.get(), at(from), at(to), &route);
    }
    bool explore(char from, ale_cell_t last = ALE_GRID_NONE)
    {
        return ale_planner_explore(planner.get(), grid.get(), at(from), last, &route);
    }
    double goal_distance_cm(char c) const
    {
        const ale_point_t goal = ale_grid_middle(grid.get(), route.goal);
        return std::hypot(goal.x_um - at(c).x_um, goal.y_um - at(c).y_um) * 1e-4;
    }

    std::vector<std::string> lines;
    std::unique_ptr<ale_grid_t> grid;
    std::unique_ptr<ale_planner_t> planner;
    ale_route_t route = {};
};

const std::vector<std::string> two_rooms = {
    "####################", "#........#.........#", "#........#.........#", "#..A.....#.........#",
    "#........#....B....#", "#........#.........#", "#..................#", "#..................#",
    "#........#.........#", "####################"};
const std::vector<std::string> narrow_door = {
    "####################", "#........#.........#", "#........#.........#", "#..A..........B....#",
    "#........#.........#", "#........#.........#", "####################"};
const std::vector<std::string> open_end = {"############################", "#............C..............",
                                           "#..A........................", "#...........................",
                                           "############################"};

} // namespace

TEST(Planner, GoesThroughTheDoorAndKeepsItsWidthClear)
{
    Floor floor(two_rooms);
    ASSERT_TRUE(floor.go('A', 'B'));
    EXPECT_EQ(floor.route.cell[0], ale_grid_cell(floor.grid.get(), floor.at('A')));
    EXPECT_EQ(floor.route.goal, ale_grid_cell(floor.grid.get(), floor.at('B')));
    for (uint32_t k = 0; k < floor.route.count; k++) {
        EXPECT_GE(floor.planner->clearance.to_occupied_cm[floor.route.cell[k]], small_robot.body_cm);
        if (k > 0) {
            const auto step = static_cast<int64_t>(floor.route.cell[k]) - floor.route.cell[k - 1];
            EXPECT_TRUE(std::abs(step) == 1 || std::abs(std::abs(step) - ALE_GRID_SIDE) <= 1)
                << "cells adjoin";
        }
    }
}

TEST(Planner, ADoorNarrowerThanTheRobotIsNoWay)
{
    Floor floor(narrow_door); // 30 cm
    EXPECT_FALSE(floor.go('A', 'B'));
    EXPECT_EQ(floor.route.count, 0u);
    const ale_planner_config_t thin = {12, 11, 10, 20, 10};
    Floor passable(narrow_door, thin);
    EXPECT_TRUE(passable.go('A', 'B'));
}

TEST(Planner, ATightPassageIsTakenOnlyWhereThereIsNoOther)
{
    const ale_planner_config_t wide = {28, 12, 10, 43, 20}; // the door has 15 cm on either side
    Floor tight(narrow_door, wide);
    ASSERT_TRUE(tight.go('A', 'B'));
    std::vector<std::string> with_another = narrow_door;
    with_another[4][9] = '.';
    with_another[5][9] = '.';
    Floor both(with_another, wide);
    ASSERT_TRUE(both.go('A', 'B'));
    for (uint32_t k = 0; k < both.route.count; k++) {
        EXPECT_GE(both.planner->clearance.to_occupied_cm[both.route.cell[k]], 28);
    }
    EXPECT_TRUE(ale_planner_is_tight(tight.planner.get(), &tight.route, 3000000));
    EXPECT_FALSE(ale_planner_is_tight(both.planner.get(), &both.route, 3000000));
}

TEST(Planner, WhereTheRobotHasBeenItMayGoAgain)
{
    const ale_planner_config_t wide = {28, 23, 22, 43, 20};
    Floor floor(narrow_door, wide);
    ASSERT_FALSE(floor.go('A', 'B'));
    const ale_point_t a = floor.at('A');
    for (int32_t x_um = a.x_um; x_um <= floor.at('B').x_um; x_um += 40000) {
        ale_grid_add_disc(floor.grid.get(), {x_um, a.y_um}, 50000);
    }
    EXPECT_FALSE(floor.go('A', 'B')) << "15 cm are too few even so";
    const ale_planner_config_t squeezes = {28, 23, 18, 43, 20};
    Floor again(narrow_door, squeezes);
    EXPECT_FALSE(again.go('A', 'B'));
    for (int32_t x_um = a.x_um; x_um <= floor.at('B').x_um; x_um += 40000) {
        ale_grid_add_disc(again.grid.get(), {x_um, a.y_um}, 50000);
    }
    EXPECT_TRUE(again.go('A', 'B'));
}

TEST(Planner, PrefersTheWideWayToTheNarrowOne)
{
    Floor floor(two_rooms);
    ASSERT_TRUE(floor.go('A', 'B'));
    int tight = 0;
    for (uint32_t k = 0; k < floor.route.count; k++) {
        tight += floor.planner->clearance.to_occupied_cm[floor.route.cell[k]] < 30 ? 1 : 0;
    }
    EXPECT_LE(tight, 6) << "only in the door, if at all";
}

TEST(Planner, AClosedFloorThatWasSeenWholeHasNothingLeft)
{
    Floor floor(two_rooms);
    EXPECT_FALSE(floor.explore('A'));
}

TEST(Planner, TheOpenEndIsWhatIsExplored)
{
    Floor floor(open_end);
    ASSERT_TRUE(floor.explore('A'));
    const ale_point_t goal = ale_grid_middle(floor.grid.get(), floor.route.goal);
    EXPECT_GT(goal.x_um, floor.at('C').x_um + 4000000);
    EXPECT_LE(floor.planner->clearance.to_unknown_cm[floor.route.goal], small_robot.see_cm);
    EXPECT_EQ(floor.route.count, static_cast<uint32_t>(ALE_ROUTE_CELLS)) << "the way's beginning";
    EXPECT_NEAR(floor.route.cost, (goal.x_um - floor.at('A').x_um) * 1e-4, 60);
}

TEST(Planner, TheNearerOfTwoOpenEndsIsTakenAndTheLastOneIsKept)
{
    const std::vector<std::string> both = {"############################", "............................",
                                           "..........A.................", "............................",
                                           "############################"};
    Floor floor(both);
    ASSERT_TRUE(floor.explore('A'));
    const ale_cell_t near = floor.route.goal;
    EXPECT_LT(ale_grid_middle(floor.grid.get(), near).x_um, floor.at('A').x_um);
    ASSERT_TRUE(ale_planner_refuse(floor.planner.get(), near, 0));
    ASSERT_TRUE(floor.explore('A'));
    EXPECT_NE(floor.route.goal, near);
}

TEST(Planner, AGoalIsKeptWhileTheOtherIsNotClearlyNearer)
{
    const std::vector<std::string> both = {"############################", "............................",
                                           ".............A..............", "............................",
                                           "############################"};
    Floor floor(both);
    const ale_cell_t right = ale_grid_cell(floor.grid.get(), floor.at('A')) + 14 * scale - 4;
    ASSERT_TRUE(floor.explore('A', right));
    EXPECT_GT(ale_grid_middle(floor.grid.get(), floor.route.goal).x_um, floor.at('A').x_um);
    ASSERT_TRUE(floor.explore('A'));
    EXPECT_LT(ale_grid_middle(floor.grid.get(), floor.route.goal).x_um, floor.at('A').x_um)
        << "which is nearer";
}

TEST(Planner, FindsItsWayOutOfATightPlace)
{
    const std::vector<std::string> tight = {
        "####################", "#..................#", "#..................#", "#..............B...#",
        "#..................#", "#A.................#", "####################"};
    const ale_planner_config_t wide = {40, 35, 10, 55, 35};
    Floor floor(tight, wide);
    EXPECT_LT(floor.planner->clearance.to_occupied_cm[ale_grid_cell(floor.grid.get(), floor.at('A'))], 40);
    EXPECT_TRUE(floor.go('A', 'B'));
}

TEST(Planner, TheCarrotIsAsFarAheadAsTheStraightLineIsClear)
{
    Floor floor(two_rooms);
    ASSERT_TRUE(floor.go('A', 'B'));
    const ale_point_t robot = floor.at('A');
    const ale_point_t lookahead =
        ale_planner_lookahead(floor.planner.get(), floor.grid.get(), &floor.route, robot, 700000);
    const double reach = std::hypot(lookahead.x_um - robot.x_um, lookahead.y_um - robot.y_um);
    EXPECT_GT(reach, 500000);
    EXPECT_LT(reach, 1000000);

    const ale_cell_t at_door = floor.route.cell[floor.route.count / 2];
    const ale_point_t there = ale_grid_middle(floor.grid.get(), at_door);
    ASSERT_TRUE(ale_planner_go(floor.planner.get(), floor.grid.get(), there, floor.at('B'), &floor.route));
    const ale_point_t next =
        ale_planner_lookahead(floor.planner.get(), floor.grid.get(), &floor.route, there, 3000000);
    for (int k = 0; k <= 50; k++) {
        const ale_point_t p = {there.x_um + (next.x_um - there.x_um) / 50 * k,
                               there.y_um + (next.y_um - there.y_um) / 50 * k};
        EXPECT_GE(floor.planner->clearance.to_occupied_cm[ale_grid_cell(floor.grid.get(), p)],
                  small_robot.body_cm - 3);
    }
}

TEST(Planner, OutsideTheGridThereIsNoWay)
{
    Floor floor(two_rooms);
    const ale_point_t far = {30000000, 0};
    EXPECT_FALSE(
        ale_planner_explore(floor.planner.get(), floor.grid.get(), far, ALE_GRID_NONE, &floor.route));
    EXPECT_FALSE(ale_planner_go(floor.planner.get(), floor.grid.get(), floor.at('A'), far, &floor.route));
}

TEST(Planner, WhatWasRefusedStaysWhereItIsWhenTheSquareMovesAndGoesWhereTheMapGoes)
{
    const std::vector<std::string> open = {"............................"};
    Floor floor(open);
    const ale_point_t place = {400000, 300000};
    ASSERT_TRUE(ale_planner_refuse(floor.planner.get(), ale_grid_cell(floor.grid.get(), place), 5));
    const ale_point_t corner = floor.grid->corner;
    ale_grid_init(floor.grid.get(), {corner.x_um + 30000000, corner.y_um + 20000000});
    ale_planner_move(floor.planner.get(), floor.grid.get(), corner);
    EXPECT_EQ(floor.planner->refused[0], ale_grid_cell(floor.grid.get(), place));
    auto correction = std::make_unique<ale_correction_t>();
    correction->count = 2;
    correction->shift[0] = {0, {0, 0, 0}};
    correction->shift[1] = {5, {250000, -150000, 0}};
    ale_planner_correct(floor.planner.get(), floor.grid.get(), correction.get());
    EXPECT_EQ(floor.planner->refused[0],
              ale_grid_cell(floor.grid.get(), {place.x_um + 250000, place.y_um - 150000}));
}

TEST(Planner, VenturesThroughWhatHasNotBeenSeenAndRatherNot)
{
    const std::vector<std::string> unseen = {
        "####################", "#........   .......#", "#..A.....   ...B...#", "#........   .......#",
        "#..................#", "#..................#", "#..................#", "####################"};
    Floor floor(unseen);
    EXPECT_TRUE(floor.go('A', 'B'));
    const uint32_t around = floor.route.cost;
    ASSERT_TRUE(ale_planner_venture(floor.planner.get(), floor.grid.get(), floor.at('A'), floor.at('B'),
                                    &floor.route));
    EXPECT_LE(floor.route.cost, around) << "never more than the way that is known";
    const std::vector<std::string> cut = {"####################", "#........   .......#",
                                          "#..A.....   ...B...#", "#........   .......#",
                                          "####################"};
    Floor apart(cut);
    EXPECT_FALSE(apart.go('A', 'B'));
    EXPECT_EQ(apart.route.count, 0U);
    ASSERT_TRUE(ale_planner_venture(apart.planner.get(), apart.grid.get(), apart.at('A'), apart.at('B'),
                                    &apart.route));
    const double straight_cm =
        std::hypot(apart.at('A').x_um - apart.at('B').x_um, apart.at('A').y_um - apart.at('B').y_um) * 1e-4;
    EXPECT_GT(apart.route.cost, straight_cm + 100) << "0.9 m of it at three times the price";
}

TEST(Planner, TheOutlineLeadsFromTheRobotToTheGoalInEqualStepsAroundTheWall)
{
    Floor floor(two_rooms);
    ASSERT_TRUE(floor.go('A', 'B'));
    ale_point_t outline[ALE_OUTLINE_POINTS];
    const uint32_t count = ale_planner_outline(floor.planner.get(), floor.grid.get(), &floor.route, outline);
    ASSERT_EQ(count, static_cast<uint32_t>(ALE_OUTLINE_POINTS)) << "the path has more cells than that";
    EXPECT_EQ(ale_grid_cell(floor.grid.get(), outline[0]), floor.route.cell[0]);
    EXPECT_EQ(ale_grid_cell(floor.grid.get(), outline[count - 1]), floor.route.goal);
    for (uint32_t k = 1; k < count; k++) {
        const double step =
            std::hypot(outline[k].x_um - outline[k - 1].x_um, outline[k].y_um - outline[k - 1].y_um) * 1e-4;
        EXPECT_LT(step, 15) << "one or two cells";
        EXPECT_TRUE(ale_grid_is_free(floor.grid.get(), ale_grid_cell(floor.grid.get(), outline[k])));
    }
}

TEST(Planner, TheOutlineOfAPathToWhereTheRobotStandsIsThatPlaceTwiceAndOfNoneIsEmpty)
{
    Floor floor(two_rooms);
    ale_point_t outline[ALE_OUTLINE_POINTS];
    EXPECT_EQ(ale_planner_outline(floor.planner.get(), floor.grid.get(), &floor.route, outline), 0U);
    ASSERT_TRUE(floor.go('A', 'A'));
    ASSERT_EQ(ale_planner_outline(floor.planner.get(), floor.grid.get(), &floor.route, outline), 2U);
    EXPECT_EQ(outline[0].x_um, outline[1].x_um);
}

TEST(Planner, ThereIsRoomInARoomButNotInAWallOrBesideOne)
{
    Floor floor(two_rooms);
    const ale_point_t inside = floor.at('A');
    EXPECT_TRUE(ale_planner_has_room(floor.planner.get(), floor.grid.get(), inside));
    const ale_point_t wall = {inside.x_um - 3 * scale * ALE_GRID_CELL_UM, inside.y_um};
    EXPECT_FALSE(ale_planner_has_room(floor.planner.get(), floor.grid.get(), wall));
    const ale_point_t beside = {inside.x_um - 2 * scale * ALE_GRID_CELL_UM - 2 * ALE_GRID_CELL_UM,
                                inside.y_um};
    EXPECT_FALSE(ale_planner_has_room(floor.planner.get(), floor.grid.get(), beside));
    EXPECT_FALSE(ale_planner_has_room(floor.planner.get(), floor.grid.get(), {90000000, 0}))
        << "beyond the grid";
}
