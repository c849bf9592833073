// The map at the end of a replay, of a drive in two maps.
#include "common/offline/map_pieces.h"

#include <memory>

#include <gtest/gtest.h>

#include "lib/graph/map_against_room.hpp"
#include "lib/graph/room_drive.hpp"

namespace
{

constexpr int scans = 80;
constexpr uint32_t second = 40; /* from here on the robot is in another map */

struct Drive : RoomDrive {
    ale::ObservationRecord record;

    Drive() : RoomDrive(scans, [](int) { return room::l_shape(); })
    {
        for (const auto &observation : observations) {
            record.add(*observation);
        }
    }
    std::unique_ptr<ale_map_t> pieces(const ale::PoseOfScan &pose_of, const ale::MapOfScan &map_of) const
    {
        auto map = std::make_unique<ale_map_t>();
        ale::rebuild_pieces(record, pose_of, map_of, map.get());
        return map;
    }
};

const Drive &drive()
{
    static const Drive driven;
    return driven;
}

TEST(MapPieces, OneMapIsWhatItWas)
{
    const auto pose_of = [](const ale::RecordedScan &scan) { return drive().truth[scan.scan]; };
    const auto map = drive().pieces(pose_of, [](uint32_t) { return 0; });
    auto whole = std::make_unique<ale_map_t>();
    ale::rebuild_map(drive().record, pose_of, whole.get());
    ASSERT_EQ(map->line_count, whole->line_count);
    ASSERT_EQ(map->corner_count, whole->corner_count);
    for (int k = 0; k < map->line_count; k++) {
        EXPECT_EQ(map->line[k].id, whole->line[k].id);
        EXPECT_EQ(map->line[k].start.x_um, whole->line[k].start.x_um);
        EXPECT_EQ(map->line[k].map_id, 0U);
    }
}

/* 0.14 m aside: taken for one, walls of the two would be drawn as one. */
TEST(MapPieces, WallsOfTwoMapsAreNeverTakenForOne)
{
    const ale_pose_t aside = convert::pose(reference::Pose(0.14, 0.14, 0));
    const auto map = drive().pieces(
        [&](const ale::RecordedScan &scan) {
            const ale_pose_t truth = drive().truth[scan.scan];
            return scan.scan < second ? truth : ale_pose_compose(aside, truth);
        },
        [](uint32_t scan) { return scan < second ? 0U : 3U; });
    std::vector<room::Wall> moved = room::l_shape();
    for (room::Wall &wall : moved) {
        wall = {wall.x1 + 0.14, wall.y1 + 0.14, wall.x2 + 0.14, wall.y2 + 0.14};
    }
    int lines[2] = {};
    for (int k = 0; k < map->line_count; k++) {
        const ale_map_line_t &line = map->line[k];
        ASSERT_TRUE(line.map_id == 0 || line.map_id == 3);
        EXPECT_EQ(line.id, static_cast<uint32_t>(k));
        EXPECT_LT(map_against_room::distance_m(line.map_id == 0 ? room::l_shape() : moved, line.start), 0.04);
        lines[line.map_id == 0 ? 0 : 1]++;
    }
    EXPECT_GE(lines[0], 3);
    EXPECT_GE(lines[1], 3);
}

} // namespace
