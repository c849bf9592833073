// lib/graph/walls/map_rebuild: the map of a drive in a synthetic room, against the room.
#include <gtest/gtest.h>

#include "graph/walls/map_rebuild.h"
#include "lib/graph/map_against_room.hpp"
#include "lib/graph/room_drive.hpp"

namespace
{

using map_against_room::distance_m;
using map_against_room::length_m;

struct Drive : RoomDrive {
    ale::ObservationRecord record;

    template <typename WallsAt> Drive(int scans, WallsAt walls_at) : RoomDrive(scans, walls_at)
    {
        for (const auto &observation : observations) {
            record.add(*observation);
        }
    }

    std::unique_ptr<ale_map_t> rebuilt(const ale::PoseOfScan &pose_of) const
    {
        auto map = std::make_unique<ale_map_t>();
        ale::rebuild_map(record, pose_of, map.get());
        return map;
    }
    std::unique_ptr<ale_map_t> rebuilt() const
    {
        return rebuilt([this](const ale::RecordedScan &scan) { return truth[scan.scan]; });
    }
};

const Drive &plain_drive()
{
    static const Drive drive(80, [](int) { return room::l_shape(); });
    return drive;
}

TEST(MapRebuild, EveryWallOfTheRoomStandsOnce)
{
    const auto map = plain_drive().rebuilt();
    const std::vector<room::Wall> walls = room::l_shape();
    for (int k = 0; k < map->line_count; k++) {
        EXPECT_LT(distance_m(walls, map->line[k].start), 0.03);
        EXPECT_LT(distance_m(walls, map->line[k].end), 0.03);
        EXPECT_GE(map->line[k].seen, 3U);
    }
    for (const room::Wall &wall : walls) {
        double covered_m = 0;
        for (int k = 0; k < map->line_count; k++) {
            const ale_map_line_t &line = map->line[k];
            const bool is_it = distance_m(wall, line.start) < 0.05 && distance_m(wall, line.end) < 0.05;
            covered_m += is_it ? length_m(line) : 0;
        }
        EXPECT_LT(covered_m, std::hypot(wall.x2 - wall.x1, wall.y2 - wall.y1) + 0.06);
    }
    EXPECT_GT(length_m(*map), 20.5); // of 25.6 m; the rest is behind the cupboard and in the corner beyond it
}

TEST(MapRebuild, CornersAreWhereWallsMeetAndWallsReachThem)
{
    const auto map = plain_drive().rebuilt();
    EXPECT_GE(map->corner_count, 6);
    for (int k = 0; k < map->corner_count; k++) {
        int ends = 0;
        for (int i = 0; i < map->line_count; i++) {
            const auto is_there = [&](ale_point_t p) {
                return p.x_um == map->corner[k].p.x_um && p.y_um == map->corner[k].p.y_um;
            };
            ends += is_there(map->line[i].start) + is_there(map->line[i].end);
        }
        EXPECT_EQ(ends, 2);
        EXPECT_LT(distance_m(room::l_shape(), map->corner[k].p), 0.02);
    }
}

TEST(MapRebuild, TheMapFollowsThePoses)
{
    const Drive &drive = plain_drive();
    const ale_pose_t moved = convert::pose(reference::Pose(12, -7, 2));
    const auto here = drive.rebuilt();
    const auto there = drive.rebuilt(
        [&](const ale::RecordedScan &scan) { return ale_pose_compose(moved, drive.truth[scan.scan]); });
    ASSERT_EQ(there->line_count, here->line_count);
    for (int k = 0; k < here->line_count; k++) {
        const ale_point_t p = ale_pose_apply(moved, here->line[k].start);
        EXPECT_NEAR(there->line[k].start.x_um, p.x_um, 200);
        EXPECT_NEAR(there->line[k].start.y_um, p.y_um, 200);
    }
}

// Half of the drive is displaced by 0.2 m, as when a loop was not found.
TEST(MapRebuild, DisplacedVisitsDoNotDoubleTheWalls)
{
    const Drive &drive = plain_drive();
    const ale_pose_t aside = convert::pose(reference::Pose(0.14, 0.14, 0));
    const auto map = drive.rebuilt([&](const ale::RecordedScan &scan) {
        const ale_pose_t truth = drive.truth[scan.scan];
        return scan.scan < 40 ? truth : ale_pose_compose(aside, truth);
    });
    EXPECT_LT(length_m(*map), length_m(*drive.rebuilt()) * 1.1);
}

TEST(MapRebuild, AWallThatBeamsPassThroughLaterIsRemoved)
{
    const room::Wall screen = {0.2, 0.9, 0.2, 1.7};
    const Drive drive(50, [&](int k) {
        std::vector<room::Wall> walls = room::l_shape();
        if (k < 8) {
            walls.push_back(screen);
        }
        return walls;
    });
    const ale_point_t middle = {200000, 1300000};
    const auto map = drive.rebuilt();
    for (int k = 0; k < map->line_count; k++) {
        const ale_map_line_t &line = map->line[k];
        EXPECT_GT(distance_m({line.start.x_um * 1e-6, line.start.y_um * 1e-6, line.end.x_um * 1e-6,
                              line.end.y_um * 1e-6},
                             middle),
                  0.1);
    }
}

const room::Wall screen = {0.2, 0.9, 0.2, 1.7};

Drive drive_with_screen(int scans, bool stands)
{
    return Drive(scans, [stands](int) {
        std::vector<room::Wall> walls = room::l_shape();
        if (stands) {
            walls.push_back(screen);
        }
        return walls;
    });
}

// Of two drives in their order, the second by another robot whose numbers begin anew.
double screen_m(Drive first, Drive second)
{
    const auto scans = static_cast<uint32_t>(first.truth.size());
    std::vector<ale_pose_t> truth = first.truth;
    truth.insert(truth.end(), second.truth.begin(), second.truth.end());
    first.record.append(std::move(second.record), scans);
    const auto map = first.rebuilt([&](const ale::RecordedScan &scan) { return truth[scan.scan]; });
    double sum_m = 0;
    for (int k = 0; k < map->line_count; k++) {
        const ale_map_line_t &line = map->line[k];
        const bool is_it = distance_m(screen, line.start) < 0.05 && distance_m(screen, line.end) < 0.05;
        sum_m += is_it ? length_m(line) : 0;
    }
    return sum_m;
}

// However many scans of the one before have shown the contrary.
TEST(MapRebuild, OfTwoDrivesTheLaterSaysWhatStands)
{
    EXPECT_LT(screen_m(drive_with_screen(90, true), drive_with_screen(90, false)), 0.01);
    EXPECT_GT(screen_m(drive_with_screen(90, false), drive_with_screen(40, true)), 0.5);
}

// The same drive again with its own map as prior map, its poses displaced by the error of a map.
class DriveWithPriorMap : public testing::Test
{
  protected:
    static std::unique_ptr<ale_map_t> rebuilt_on(const ale_map_t &map, const Drive &again)
    {
        ale::ObservationRecord record;
        record.set_prior_map(again.observations.front()->epoch, map);
        for (const auto &observation : again.observations) {
            record.add(*observation);
        }
        const ale_pose_t aside = convert::pose(reference::Pose(0.02, -0.02, 0));
        auto out = std::make_unique<ale_map_t>();
        ale::rebuild_map(
            record,
            [&](const ale::RecordedScan &scan) { return ale_pose_compose(aside, again.truth[scan.scan]); },
            out.get());
        return out;
    }
    std::unique_ptr<ale_map_t> rebuilt_on(const ale_map_t &map) const
    {
        return rebuilt_on(map, drive);
    }
    // As after many drives.
    void make_well_observed()
    {
        for (int k = 0; k < first->line_count; k++) {
            first->line[k].seen *= 20;
        }
    }
    static void add(ale_map_t *map, ale_point_t start, ale_point_t end)
    {
        ale_map_line_t &line = map->line[map->line_count++];
        line = {};
        line.start = start;
        line.end = end;
        line.seen = 40;
        line.var_rho_um2 = 1000000;
        line.var_alpha_nrad2 = 1000000000000;
    }
    // Length of the lines within 10 cm of a wall.
    static double length_on(const ale_map_t &map, const room::Wall &wall)
    {
        double sum = 0;
        for (int k = 0; k < map.line_count; k++) {
            const bool is_it =
                distance_m(wall, map.line[k].start) < 0.1 && distance_m(wall, map.line[k].end) < 0.1;
            sum += is_it ? length_m(map.line[k]) : 0;
        }
        return sum;
    }

    const Drive &drive = plain_drive();
    std::unique_ptr<ale_map_t> first = drive.rebuilt();
};

TEST_F(DriveWithPriorMap, EveryWallStaysSingleAndInPlace)
{
    auto again = rebuilt_on(*first);
    for (int k = 0; k < 2; k++) {
        again = rebuilt_on(*again);
    }
    EXPECT_EQ(again->line_count, first->line_count);
    EXPECT_EQ(again->corner_count, first->corner_count);
    EXPECT_NEAR(length_m(*again), length_m(*first), 0.02 * length_m(*first));
    for (int k = 0; k < again->line_count; k++) {
        EXPECT_LT(distance_m(room::l_shape(), again->line[k].start), 0.05);
        EXPECT_LT(distance_m(room::l_shape(), again->line[k].end), 0.05);
    }
}

TEST_F(DriveWithPriorMap, UnseenWallsStayAndWallsSeenThroughGo)
{
    add(first.get(), {100000000, 0}, {103000000, 0});
    add(first.get(), {200000, 1700000}, {200000, 900000});
    const auto again = rebuilt_on(*first);
    EXPECT_NEAR(length_on(*again, {100, 0, 103, 0}), 3, 0.06);
    EXPECT_EQ(length_on(*again, {0.2, 0.9, 0.2, 1.7}), 0);
}

TEST_F(DriveWithPriorMap, ANewSurfaceHidesTheWallBehindIt)
{
    make_well_observed();
    const double front_m = -1.8; // the wall is at -2
    const Drive again(80, [&](int) {
        std::vector<room::Wall> walls = room::l_shape();
        walls.push_back({0, -2, 0, front_m});
        walls.push_back({0, front_m, 2, front_m});
        walls.push_back({2, front_m, 2, -2});
        return walls;
    });
    const auto map = rebuilt_on(*first, again);
    EXPECT_GT(length_on(*map, {0, front_m, 2, front_m}), 1.7);
    EXPECT_LT(length_on(*map, {0.1, -2, 1.9, -2}), 0.2);
    EXPECT_GT(length_on(*map, {-1, -2, 0, -2}), 0.8);
    EXPECT_GT(length_on(*map, {2, -2, 3.6, -2}), 1.3);
}

TEST_F(DriveWithPriorMap, AMovedWallStandsAtItsNewPlace)
{
    make_well_observed();
    const double now_m = 2.8; // it was at 3
    const Drive again(80, [&](int) {
        std::vector<room::Wall> walls = room::l_shape();
        walls.push_back({-1, now_m, 2.5, now_m});
        return walls;
    });
    const auto map = rebuilt_on(*first, again);
    double most_m = 0;
    for (int k = 0; k < map->line_count; k++) {
        const bool is_there = distance_m({-1, 3, 2.5, 3}, map->line[k].start) < 0.25 &&
                              distance_m({-1, 3, 2.5, 3}, map->line[k].end) < 0.25;
        if (is_there) {
            EXPECT_NEAR(map->line[k].start.y_um * 1e-6, now_m - 0.02, 0.03);
            most_m = std::max(most_m, length_m(map->line[k]));
        }
    }
    EXPECT_GT(most_m, 2.5);
}

TEST(MapRebuild, WithoutScansThereIsNoMap)
{
    ale_map_t map;
    ale::rebuild_map(
        ale::ObservationRecord(), [](const ale::RecordedScan &) { return ale_pose_t{}; }, &map);
    EXPECT_EQ(map.line_count + map.corner_count, 0);
}

} // namespace
