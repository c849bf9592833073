// lib/graph/live_map: the map while driving, rebuilt from the observations of its scans.
#include <gtest/gtest.h>

#include <algorithm>

#include "map_against_room.hpp"
#include "room_drive.hpp"

extern "C" {
#include "graph/live_map.h"
#include "map/map_corner.h"
}

namespace
{

using map_against_room::distance_m;
using map_against_room::length_m;

struct DestroyLiveMap {
    void operator()(ale_live_map_t *live) const
    {
        ale_live_map_destroy(live);
    }
};
using LiveMap = std::unique_ptr<ale_live_map_t, DestroyLiveMap>;
using Map = std::unique_ptr<ale_map_t>;

LiveMap with(const std::vector<std::unique_ptr<ale_scan_observation_t>> &observations)
{
    LiveMap live(ale_live_map_create());
    for (const auto &observation : observations) {
        EXPECT_EQ(ale_live_map_add(live.get(), observation.get()), 0);
    }
    return live;
}

Map rebuilt(ale_live_map_t *live, const ale_mapper_poses_t &keyframes)
{
    auto map = std::make_unique<ale_map_t>();
    EXPECT_TRUE(ale_live_map_build(live, &keyframes, map.get()));
    return map;
}

// Of the wall x = 0.2 in the middle of the room.
double screen_m(const ale_map_t &map)
{
    double sum = 0;
    for (int k = 0; k < map.line_count; k++) {
        const ale_map_line_t &line = map.line[k];
        const bool is_it =
            std::abs(line.start.x_um - 200000) < 50000 && std::abs(line.end.x_um - 200000) < 50000;
        sum += is_it ? length_m(line) : 0;
    }
    return sum;
}

const RoomDrive &plain_drive()
{
    static const RoomDrive drive(80, [](int) { return room::l_shape(); });
    return drive;
}

TEST(LiveMap, TheRoomIsWhereTheKeyframesAre)
{
    const RoomDrive &drive = plain_drive();
    const LiveMap live = with(drive.observations);
    const Map map = rebuilt(live.get(), *drive.keyframes);
    EXPECT_EQ(ale_live_map_epoch(live.get()), drive.keyframes->epoch);
    EXPECT_GT(length_m(*map), 20.0); // of 25.6 m
    EXPECT_LT(length_m(*map), 25.6);
    for (int k = 0; k < map->line_count; k++) {
        const ale_map_line_t &line = map->line[k];
        EXPECT_LT(distance_m(room::l_shape(), line.start), 0.03);
        EXPECT_LT(distance_m(room::l_shape(), line.end), 0.03);
        EXPECT_GE(line.seen, 3U);
        EXPECT_GT(line.var_rho_um2, 0);
        EXPECT_GT(line.var_alpha_nrad2, 0);
    }
    ASSERT_GE(map->corner_count, 4);
    EXPECT_GT(map->corner[0].cov_um2[0], 0);
    EXPECT_GE(map->corner[0].seen, static_cast<uint32_t>(ALE_CORNER_CONFIRMED));
}

TEST(LiveMap, ACorrectionMovesTheMapAndWallsKeepTheirIds)
{
    const RoomDrive &drive = plain_drive();
    const LiveMap live = with(drive.observations);
    const Map before = rebuilt(live.get(), *drive.keyframes);
    auto moved = std::make_unique<ale_mapper_poses_t>(*drive.keyframes);
    const ale_pose_t aside = convert::pose(reference::Pose(0.05, -0.03, 0));
    std::for_each(moved->pose, moved->pose + moved->count, [&](ale_mapper_pose_t &keyframe) {
        keyframe.pose = ale_pose_compose(aside, keyframe.pose);
    });
    const Map after = rebuilt(live.get(), *moved);
    ASSERT_EQ(after->line_count, before->line_count);
    for (int k = 0; k < after->line_count; k++) {
        EXPECT_EQ(after->line[k].id, before->line[k].id);
        EXPECT_NEAR(after->line[k].start.x_um, before->line[k].start.x_um + 50000, 200);
        EXPECT_NEAR(after->line[k].start.y_um, before->line[k].start.y_um - 30000, 200);
    }
}

// Scans of a removed keyframe go with it; those of a keyframe that the mapper does not have yet stay as
// tracked.
TEST(LiveMap, ScansOfRemovedKeyframesAreRemoved)
{
    const RoomDrive &drive = plain_drive();
    const LiveMap live = with(drive.observations);
    auto last = std::make_unique<ale_mapper_poses_t>();
    last->epoch = drive.keyframes->epoch;
    last->pose[last->count++] = drive.keyframes->pose[drive.keyframes->count - 1];
    const Map few = rebuilt(live.get(), *last);
    const Map all = rebuilt(with(drive.observations).get(), *drive.keyframes);
    EXPECT_LT(length_m(*few), length_m(*all));
    EXPECT_EQ(rebuilt(live.get(), *drive.keyframes)->line_count, few->line_count) << "it does not come back";
}

// The second half of the drive is in a map of its own.
TEST(LiveMap, TheMapIsThatWhichTheRobotIsIn)
{
    const RoomDrive &drive = plain_drive();
    const LiveMap live = with(drive.observations);
    const double all_m = length_m(*rebuilt(live.get(), *drive.keyframes));
    auto in_two = std::make_unique<ale_mapper_poses_t>(*drive.keyframes);
    for (uint32_t k = in_two->count / 2; k < in_two->count; k++) {
        in_two->pose[k].map_id = 1;
        in_two->pose[k].pose.x_um += 20000000;
    }
    const Map present = rebuilt(live.get(), *in_two);
    for (int k = 0; k < present->line_count; k++) {
        EXPECT_GT(present->line[k].start.x_um, 10000000) << "of the other map";
    }
    EXPECT_EQ(length_m(*rebuilt(live.get(), *drive.keyframes)), all_m) << "what was left out is kept";
}

TEST(LiveMap, WhereTheRobotStaysTheOldestScansGo)
{
    const RoomDrive drive(
        40,
        [](int k) {
            std::vector<room::Wall> walls = room::l_shape();
            if (k < 10) {
                walls.push_back({0.2, 0.9, 0.2, 1.7});
            }
            return walls;
        },
        [](double) { return reference::Pose(2, 1.2, reference::pi); });
    LiveMap live(ale_live_map_create());
    for (size_t k = 0; k < 10; k++) {
        ale_live_map_add(live.get(), drive.observations[k].get());
    }
    EXPECT_GT(screen_m(*rebuilt(live.get(), *drive.keyframes)), 0.5);
    for (size_t k = 10; k < drive.observations.size(); k++) {
        ale_live_map_add(live.get(), drive.observations[k].get());
    }
    EXPECT_EQ(screen_m(*rebuilt(live.get(), *drive.keyframes)), 0);
}

TEST(LiveMap, TheRecordIsBounded)
{
    const LiveMap live(ale_live_map_create());
    auto observation = std::make_unique<ale_scan_observation_t>(*plain_drive().observations[0]);
    uint32_t most = 0;
    for (uint32_t scan = 0; scan < 3000; scan++) {
        observation->scan = scan;
        observation->keyframe = scan / 2 * 2;
        observation->stamp_us += 6000000; // so long that all beams are kept
        ASSERT_EQ(ale_live_map_add(live.get(), observation.get()), 0);
        most = std::max(most, ale_live_map_bytes(live.get()));
    }
    EXPECT_LE(most, static_cast<uint32_t>(ALE_LIVE_MAP_BYTES));
    EXPECT_GT(most, ALE_LIVE_MAP_BYTES - 32768U) << "it was full";
}

TEST(LiveMap, ANewEpochRemovesTheOldOne)
{
    const RoomDrive &drive = plain_drive();
    const LiveMap live = with(drive.observations);
    auto first = std::make_unique<ale_scan_observation_t>(*drive.observations[0]);
    first->epoch++;
    ale_live_map_add(live.get(), first.get());
    auto map = std::make_unique<ale_map_t>();
    EXPECT_FALSE(ale_live_map_build(live.get(), drive.keyframes.get(), map.get()))
        << "the mapper is still at the old epoch";
    EXPECT_EQ(ale_live_map_epoch(live.get()), drive.keyframes->epoch + 1);
    auto keyframes = std::make_unique<ale_mapper_poses_t>(*drive.keyframes);
    keyframes->epoch++;
    EXPECT_FALSE(ale_live_map_build(live.get(), keyframes.get(), map.get())) << "one scan is no map";
}

TEST(LiveMap, WithoutScansThereIsNoMap)
{
    const LiveMap live(ale_live_map_create());
    auto map = std::make_unique<ale_map_t>();
    auto keyframes = std::make_unique<ale_mapper_poses_t>();
    EXPECT_FALSE(ale_live_map_build(live.get(), keyframes.get(), map.get()));
    EXPECT_EQ(ale_live_map_epoch(live.get()), 0U);
}

} // namespace
