// From messages back to the core's integers.
#include "common/feed/core_types.h"

#include <limits>

#include <gtest/gtest.h>

TEST(CoreTypes, AMapKeepsItsWallsToTheMicrometre)
{
    ale::map_t map{};
    map.lines.resize(1);
    map.lines[0].x1 = 1.25F;
    map.lines[0].y2 = -0.5F;
    map.lines[0].seen = 7;
    const auto core = feed::core_map(map);
    ASSERT_EQ(core->line_count, 1);
    EXPECT_EQ(core->line[0].start.x_um, 1250000);
    EXPECT_EQ(core->line[0].end.y_um, -500000);
    EXPECT_EQ(core->line[0].seen, 7U);
}

TEST(CoreTypes, AWallInAnotherMapSaysSo)
{
    ale::map_t map{};
    map.version = 3;
    map.lines.resize(2);
    map.lines[1].id = 8;
    ale::map_pieces_t message{};
    message.version = 3;
    message.parts = 1;
    message.num_lines = 1;
    message.line_id = {8};
    message.map_id = {2};
    feed::MapPieces pieces;
    pieces.add(message);
    const auto core = feed::core_map(map, pieces);
    EXPECT_EQ(core->line[0].map_id, 0U);
    EXPECT_EQ(core->line[1].map_id, 2U);
}

TEST(CoreTypes, AMapBeyondTheCapacityIsCutThere)
{
    ale::map_t map{};
    map.lines.resize(ALE_MAP_MAX_LINES + 10);
    map.corners.resize(ALE_MAP_MAX_CORNERS + 10);
    const auto core = feed::core_map(map);
    EXPECT_EQ(core->line_count, ALE_MAP_MAX_LINES);
    EXPECT_EQ(core->corner_count, ALE_MAP_MAX_CORNERS);
}

TEST(CoreTypes, AScanKeepsGeometryRangesAndFlags)
{
    ale::scan_t scan{};
    scan.first_bearing = -1.5707964F;
    scan.step = -0.0061359F;
    scan.stamp_beam = -44;
    scan.beam_time_us = 97.656F;
    scan.range_unit_mm = 2;
    scan.range_mm = {1000, 0, 0, 0};
    scan.codes = {0, 0x81, 7, 0x83};
    scan.num_ranges = scan.num_codes = 4;
    const auto core = feed::core_scan(scan);
    EXPECT_EQ(core->beams, 4);
    EXPECT_EQ(core->range_um[0], 2000000);
    EXPECT_EQ(core->flag[0], ALE_BEAM_VALID);
    EXPECT_EQ(core->flag[1], ALE_BEAM_NO_RETURN);
    EXPECT_EQ(core->flag[2], ALE_BEAM_UNKNOWN);
    EXPECT_EQ(core->flag[3], ALE_BEAM_BLIND);
    EXPECT_EQ(core->stamp_beam, -44);
    EXPECT_EQ(core->beam_time_ns, 97656);
    EXPECT_NEAR(static_cast<int32_t>(core->first_bearing_bam), -1073741824, 200);
    EXPECT_NEAR(core->step_bam, -4194304, 200);
}

TEST(CoreTypes, ARangeBeyondAllReachIsHeldAtTheLimit)
{
    ale::scan_t scan{};
    scan.range_unit_mm = std::numeric_limits<int16_t>::max();
    scan.range_mm = {std::numeric_limits<int16_t>::max(), -5};
    scan.codes = {0, 0};
    scan.num_ranges = scan.num_codes = 2;
    const auto core = feed::core_scan(scan);
    EXPECT_EQ(core->range_um[0], ALE_MAX_RANGE_UM);
    EXPECT_EQ(core->range_um[1], 0);
}
