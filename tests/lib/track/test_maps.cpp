// lib/track/maps: a robot that does not know where it is begins a new map, goes on in it, and joins it.
#include <algorithm>
#include <cstring>

#include <gtest/gtest.h>

#include "room_pipeline.h"

extern "C" {
#include "track/keyframe.h"
#include "track/maps.h"
#include "track/pipeline_state.h"
#include "track/scan_observation.h"
}

namespace
{

using Walls = std::vector<room::Wall>;

/* A hall that has nothing in common with the room. */
Walls hall()
{
    return {{-3, -3.5, 4, -3}, {4, -3, 3.2, 4},    {3.2, 4, -2.5, 3.2}, {-2.5, 3.2, -3, -3.5},
            {1, 4, 1, 2.6},    {1, 2.6, 1.8, 2.6}, {1.8, 2.6, 1.8, 4},  {-3, 0, -2, 0.3}};
}

/* Carried by this the robot drives its way in the room turned by half a turn, where there is as much space.
 */
const reference::Pose other_side(3, -0.8, reference::pi);

/* A robot with wheels that others may carry: what its scans show, and what it says. */
struct Robot {
    room::Pipeline p;
    std::unique_ptr<ale_keyframe_t> keyframe = std::make_unique<ale_keyframe_t>();
    bool taken = false; /* a keyframe, of the last scan */
    ale_estimate_t last = {};
    std::mt19937 rng{7};
    room::Sensor sensor;
    reference::Pose carried{0, 0, 0}; /* by this the robot is elsewhere than its way has led */
    double t = 1;

    Robot() : p(room::make(ale_pipeline_default_config()))
    {
        sensor.noise = 0.003;
    }
    reference::Pose at(double time) const
    {
        return reference::compose(carried, room::path(time));
    }
    /* Where it is in the frame of the first map. */
    reference::Pose truth() const
    {
        return room::since_start(room::path(1), at(t - 0.1));
    }
    double off_m() const
    {
        return room::since_start(truth(), convert::pose(last.map)).head<2>().norm();
    }
    void count_wheels()
    {
        const ale_odometry_t wheels = {std::llround(t * 1e6), convert::pose(room::path(t))};
        ale_pipeline_odometry(p.get(), &wheels);
    }
    /* Its scanner is away, its wheels are not. */
    void drive_unseen(double seconds)
    {
        for (const double until = t + seconds; t < until; t += 0.1) {
            count_wheels();
        }
    }
    void scan(const Walls &walls)
    {
        count_wheels();
        const ale_scan_t scan = room::scan_at(
            walls, sensor, [&](double time) { return at(time); }, t, rng);
        ale_pipeline_scan(p.get(), &scan, &last);
        taken = ale_pipeline_keyframe(p.get(), keyframe.get());
        t += 0.1;
    }
    void drive(const Walls &walls, int scans)
    {
        for (int k = 0; k < scans; k++) {
            scan(walls);
        }
    }
    /* Until the map is another one; false: it never is. */
    bool drive_to_other_map(const Walls &walls, int most)
    {
        const uint32_t id = last.map_id;
        for (int k = 0; k < most && last.map_id == id; k++) {
            scan(walls);
        }
        return last.map_id != id;
    }
    int walls_of(uint8_t number) const
    {
        return static_cast<int>(std::count_if(p->map.wall, p->map.wall + p->map.count,
                                              [&](const ale_wall_t &wall) { return wall.map == number; }));
    }
    std::vector<ale_wall_t> first_map() const
    {
        std::vector<ale_wall_t> walls;
        std::copy_if(p->map.wall, p->map.wall + p->map.count, std::back_inserter(walls),
                     [](const ale_wall_t &wall) { return wall.map == ALE_FIRST_MAP; });
        return walls;
    }
};

bool are_alike(const std::vector<ale_wall_t> &a, const std::vector<ale_wall_t> &b)
{
    return a.size() == b.size() &&
           std::equal(a.begin(), a.end(), b.begin(), [](const ale_wall_t &v, const ale_wall_t &w) {
               return v.id == w.id && v.anchor.x_um == w.anchor.x_um && v.anchor.y_um == w.anchor.y_um &&
                      v.start_um == w.start_um && v.end_um == w.end_um && v.seen == w.seen;
           });
}

/* Somebody's word is of one place: of the map that begins there, not of those that begin after it. */
TEST(Maps, WhatIsSaidOfAPlaceHoldsForOneMap)
{
    Robot robot;
    robot.scan(room::l_shape());
    ale_pipeline_relocate(robot.p.get(), robot.last.map);
    ale_maps_begin(robot.p.get());
    EXPECT_EQ(robot.p->claim, ALE_CLAIM_SAID);
    ale_maps_begin(robot.p.get());
    EXPECT_EQ(robot.p->claim, ALE_CLAIM_NEAR);
    ale_maps_lose(robot.p.get(), ALE_CLAIM_NONE);
    ale_maps_begin(robot.p.get());
    EXPECT_EQ(robot.p->claim, ALE_CLAIM_NONE);
    EXPECT_EQ(robot.p->claims, 0);
}

} // namespace

TEST(Maps, OneBeginsWhereNothingAgreesAndMappingGoesOn)
{
    Robot robot;
    robot.drive(room::l_shape(), 150);
    ASSERT_EQ(robot.last.state, ALE_STATE_GOOD);
    EXPECT_EQ(robot.last.maps, 1);
    const size_t walls = robot.first_map().size();
    ASSERT_TRUE(robot.drive_to_other_map(hall(), 40));
    const std::vector<ale_wall_t> before = robot.first_map();
    EXPECT_EQ(before.size(), walls) << "what is seen before it begins is not mapped";
    EXPECT_EQ(robot.last.map_id, 1U);
    EXPECT_EQ(robot.last.maps, 2);
    ASSERT_TRUE(robot.taken) << "a keyframe is forced";
    EXPECT_TRUE(robot.keyframe->broken);
    EXPECT_EQ(robot.keyframe->map_id, 1U);
    const int begun = robot.walls_of(1);
    for (int k = 0; k < 150; k++) {
        robot.scan(hall());
        ASSERT_EQ(robot.last.state, ALE_STATE_LOST) << k << ": lost until it is joined";
        ASSERT_EQ(robot.last.map_id, 1U) << k;
        EXPECT_TRUE(!robot.taken || robot.keyframe->map_id == 1) << k;
        EXPECT_TRUE(!robot.taken || !robot.keyframe->broken) << k;
    }
    EXPECT_GT(robot.walls_of(1), begun) << "mapping goes on";
    EXPECT_TRUE(are_alike(robot.first_map(), before)) << "the first map stays as it was";
}

/* In the new map the way goes on as in any: the pose there is right to the pose in which it began. */
TEST(Maps, TheNewOneIsAsGoodAsAnyOther)
{
    Robot robot;
    robot.drive(room::l_shape(), 150);
    ASSERT_TRUE(robot.drive_to_other_map(hall(), 40));
    robot.drive(hall(), 10);
    const reference::Pose frame =
        reference::compose(robot.at(robot.t - 0.1), reference::inverse(convert::pose(robot.last.map)));
    double worst_m = 0;
    for (int k = 0; k < 120; k++) {
        robot.scan(hall());
        const reference::Pose got = reference::compose(frame, convert::pose(robot.last.map));
        worst_m = std::max(worst_m, (got - robot.at(robot.t - 0.1)).head<2>().norm());
    }
    EXPECT_LT(worst_m, 0.03);
}

TEST(Maps, OneJoinsTheFirstWhereThePlaceIsRecognised)
{
    Robot robot;
    robot.drive(room::l_shape(), 180);
    const auto before = robot.first_map();
    ASSERT_TRUE(robot.drive_to_other_map(hall(), 40));
    robot.drive(hall(), 20);
    robot.carried = other_side;
    bool lost = true;
    bool joined = false;
    for (int k = 0; k < 300 && !joined; k++) {
        robot.scan(room::l_shape());
        joined = robot.last.map_id == 0;
        lost = lost && (joined || robot.last.state == ALE_STATE_LOST);
    }
    ASSERT_TRUE(joined);
    EXPECT_TRUE(lost) << "until then";
    EXPECT_NE(robot.last.state, ALE_STATE_LOST);
    EXPECT_LT(robot.off_m(), 0.05);
    ASSERT_TRUE(robot.taken) << "a keyframe is forced";
    EXPECT_EQ(robot.keyframe->map_id, 0U);
    EXPECT_EQ(robot.keyframe->join.into_map_id, 0U);
    EXPECT_EQ(robot.keyframe->join.map_id, robot.p->atlas.join.map_id);
    EXPECT_GE(robot.keyframe->join.number, 1U);
    robot.drive(room::l_shape(), 60);
    EXPECT_EQ(robot.last.state, ALE_STATE_GOOD);
    EXPECT_LT(robot.off_m(), 0.02);
    EXPECT_LE(robot.walls_of(0), static_cast<int>(before.size()) + 12) << "no wall stands twice";
}

/* However long the scanner was away: wheels that told of a way were on the floor, and where the map explains
 * the scan there the robot goes on in it. */
TEST(Maps, AfterADriveThatNobodySawTheRobotIsWhereItsWheelsAndTheMapSay)
{
    for (const double seconds : {6.0, 8.0, 12.0}) {
        Robot robot;
        robot.drive(room::l_shape(), 180);
        ASSERT_EQ(robot.last.state, ALE_STATE_GOOD);
        robot.drive_unseen(seconds);
        for (int k = 0; k < 20; k++) {
            robot.scan(room::l_shape());
            EXPECT_EQ(robot.last.map_id, 0U) << seconds << " s, scan " << k;
            EXPECT_TRUE(robot.last.state != ALE_STATE_GOOD || robot.off_m() < 0.05) << seconds << " s, " << k;
        }
        EXPECT_EQ(robot.last.state, ALE_STATE_GOOD) << seconds;
    }
}

/* Where the map does not hold what is seen after such a drive, only the wheels say where the robot is. */
TEST(Maps, AfterADriveThatNobodySawItIsNotGoodBeforeTheMapConfirmsIt)
{
    Robot robot;
    robot.drive(room::l_shape(), 180);
    robot.drive_unseen(8);
    for (int k = 0; k < 60; k++) {
        robot.scan(hall());
        ASSERT_NE(robot.last.state, ALE_STATE_GOOD) << k;
    }
}

/* A place that looks like one of the first map, but is not where the wheels have led, is none of it. */
TEST(Maps, OneThatWheelsHaveLedToJoinsNowhereElse)
{
    Robot robot;
    robot.drive(room::l_shape(), 180);
    ale_maps_lose(robot.p.get(), ALE_CLAIM_DRIVEN);
    robot.carried = other_side;
    for (int k = 0; k < 300; k++) {
        robot.scan(room::l_shape());
        ASSERT_EQ(robot.last.state, ALE_STATE_LOST) << k;
    }
    EXPECT_EQ(robot.last.map_id, 1U);
}

/* Twenty losses: no more maps than there is room for, each with a number that was never used, no wall, corner
 * or landmark of one that was given up, and the first map is found again. */
TEST(Maps, AreBoundedHoweverOftenTheRobotIsLost)
{
    Robot robot;
    robot.drive(room::l_shape(), 180);
    const auto before = robot.first_map();
    uint32_t most = 0;
    for (int n = 0; n < 20; n++) {
        ale_pipeline_relocate(robot.p.get(), {40000000 + n * 1000000, 0, 0});
        ASSERT_TRUE(robot.drive_to_other_map(hall(), 5)) << n;
        robot.drive(hall(), 6);
        EXPECT_GT(robot.last.map_id, most) << n;
        most = std::max(most, robot.last.map_id);
        ASSERT_LE(robot.last.maps, ALE_ATLAS_MAPS) << n;
        for (int i = 0; i < robot.p->map.count; i++) {
            ASSERT_TRUE(robot.p->atlas.used[robot.p->map.wall[i].map]) << n;
        }
        for (int i = 0; i < robot.p->map.corners.count; i++) {
            ASSERT_TRUE(robot.p->atlas.used[robot.p->map.corners.map[i]]) << n;
        }
        for (const ale_landmark_t &m : robot.p->map.landmarks.landmark) {
            ASSERT_TRUE(m.seen == 0 || robot.p->atlas.used[m.map]) << n;
        }
    }
    EXPECT_GE(most, 20U);
    EXPECT_TRUE(are_alike(robot.first_map(), before));
    robot.carried = {0, 0, 0};
    for (int k = 0; k < 400 && robot.last.state != ALE_STATE_GOOD; k++) {
        robot.scan(room::l_shape());
    }
    EXPECT_EQ(robot.last.state, ALE_STATE_GOOD);
    EXPECT_EQ(robot.last.map_id, 0U);
    EXPECT_LT(robot.off_m(), 0.05);
}

/* Nobody maps a frozen map, neither while lost nor when found. */
TEST(Maps, AFrozenMapStaysByteForByteWhileTheRobotIsLostAndFound)
{
    Robot robot;
    robot.drive(room::l_shape(), 180);
    ale_pipeline_freeze_map(robot.p.get(), true);
    const auto before = std::make_unique<ale_map_t>();
    const auto after = std::make_unique<ale_map_t>();
    ale_pipeline_copy_map(robot.p.get(), before.get());
    const std::vector<ale_wall_t> walls = robot.first_map();
    robot.drive(hall(), 40);
    robot.carried = other_side;
    int wrong = 0;
    for (int k = 0; k < 400; k++) {
        robot.scan(room::l_shape());
        wrong += robot.last.state == ALE_STATE_GOOD && robot.off_m() > 0.1;
    }
    EXPECT_EQ(wrong, 0);
    EXPECT_EQ(robot.last.state, ALE_STATE_GOOD);
    EXPECT_EQ(robot.last.map_id, 0U);
    EXPECT_TRUE(are_alike(robot.first_map(), walls));
    ale_pipeline_copy_map(robot.p.get(), after.get());
    const auto first_end = std::stable_partition(after->line, after->line + after->line_count,
                                                 [](const ale_map_line_t &line) { return line.map_id == 0; });
    ASSERT_EQ(first_end - after->line, before->line_count);
    EXPECT_EQ(std::memcmp(before->line, after->line, before->line_count * sizeof after->line[0]), 0);
    EXPECT_EQ(std::memcmp(before->corner, after->corner, before->corner_count * sizeof after->corner[0]), 0);
}

/* Said to be where it is not, far off: it is never good there, and finds itself. */
TEST(Maps, ARobotThatIsShownAWrongPlaceIsNeverGoodThere)
{
    for (const double way : {0.0, 1.0, 2.0, 3.0, 4.0, 5.0}) {
        Robot robot;
        robot.drive(room::l_shape(), 150);
        ASSERT_EQ(robot.last.state, ALE_STATE_GOOD);
        const ale_pose_t said = convert::pose(reference::Pose(
            convert::pose(robot.last.map) + reference::Pose(3.8 * std::cos(way), 3.8 * std::sin(way), 0.2)));
        ale_pipeline_relocate(robot.p.get(), said);
        int wrong = 0;
        for (int k = 0; k < 250; k++) {
            robot.scan(room::l_shape());
            wrong += robot.last.state == ALE_STATE_GOOD && robot.off_m() > 0.1;
        }
        EXPECT_EQ(wrong, 0) << way;
        EXPECT_EQ(robot.last.state, ALE_STATE_GOOD) << way;
        EXPECT_LT(robot.off_m(), 0.03) << way;
    }
}

/* Lost in a loaded map, three scans of four damaged: whether it is told of them or not, it finds itself. */
TEST(Maps, ALostRobotThatIsToldOfDroppedScansFindsItselfAsSoon)
{
    Robot mapped;
    mapped.drive(room::l_shape(), 180);
    const auto map = std::make_unique<ale_map_t>();
    ale_pipeline_copy_map(mapped.p.get(), map.get());
    for (const double start : {3.0, 8.0}) {
        int found[2] = {-1, -1};
        for (const bool told : {false, true}) {
            Robot robot;
            robot.t = start;
            ale_pipeline_load_map(robot.p.get(), map.get(), 1, {0, 0, 0}, false);
            for (int k = 0; k < 375 && found[told] < 0; k++) {
                if (k % 4 == 0) {
                    robot.scan(room::l_shape());
                    found[told] = robot.last.state == ALE_STATE_LOST ? -1 : k;
                    EXPECT_TRUE(found[told] < 0 || robot.off_m() < 0.05) << start << " " << told;
                    continue;
                }
                robot.count_wheels();
                if (told) {
                    ale_pipeline_dropped(robot.p.get(), std::llround(robot.t * 1e6), &robot.last);
                }
                robot.t += 0.1;
            }
            EXPECT_GE(found[told], 0) << start << " " << told;
        }
        EXPECT_LT(std::abs(found[0] - found[1]), 60) << found[0] << " " << found[1];
    }
}
