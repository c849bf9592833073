#include <memory>

#include <gtest/gtest.h>

#include "common/export/map_tidy.h"

namespace
{

ale_map_line_t line(int32_t x1_mm, int32_t y1_mm, int32_t x2_mm, int32_t y2_mm, uint32_t id, uint32_t seen)
{
    ale_map_line_t l{};
    l.id = id;
    l.start = {x1_mm * 1000, y1_mm * 1000};
    l.end = {x2_mm * 1000, y2_mm * 1000};
    l.seen = seen;
    return l;
}

std::unique_ptr<ale_map_t> tidied(std::initializer_list<ale_map_line_t> lines)
{
    auto map = std::make_unique<ale_map_t>();
    for (const ale_map_line_t &l : lines) {
        map->line[map->line_count++] = l;
    }
    ale_map_tidy(map.get());
    return map;
}

TEST(MapTidy, two_lines_side_by_side_that_face_the_same_way_are_one_wall)
{
    const auto map = tidied({line(0, 0, 2000, 0, 1, 100), line(1000, 40, 3000, 40, 2, 100)});
    ASSERT_EQ(map->line_count, 1);
    EXPECT_EQ(map->line[0].seen, 200u);
    EXPECT_NEAR(map->line[0].start.x_um, 0, 2000);
    EXPECT_NEAR(map->line[0].end.x_um, 3000000, 2000);
    EXPECT_NEAR(map->line[0].start.y_um, 20000, 2000);
    EXPECT_NEAR(map->line[0].end.y_um, 20000, 2000);
}

TEST(MapTidy, the_line_with_more_evidence_has_its_way)
{
    const auto map = tidied({line(0, 0, 2000, 0, 1, 999), line(0, 50, 2000, 50, 2, 0)});
    ASSERT_EQ(map->line_count, 1);
    EXPECT_EQ(map->line[0].id, 1u);
    EXPECT_LT(map->line[0].start.y_um, 100);
    const auto swapped = tidied({line(0, 50, 2000, 50, 2, 0), line(0, 0, 2000, 0, 1, 999)});
    ASSERT_EQ(swapped->line_count, 1);
    EXPECT_EQ(swapped->line[0].id, 1u);
}

TEST(MapTidy, the_two_sides_of_a_panel_stay_two)
{
    EXPECT_EQ(tidied({line(0, 0, 2000, 0, 1, 9), line(2000, 20, 0, 20, 2, 9)})->line_count, 2);
}

TEST(MapTidy, maps_that_are_not_joined_say_nothing_of_each_others_walls)
{
    ale_map_line_t other = line(1000, 40, 3000, 40, 2, 100);
    other.map_id = 1;
    EXPECT_EQ(tidied({line(0, 0, 2000, 0, 1, 100), other})->line_count, 2);
}

TEST(MapTidy, steps_and_walls_in_a_row_stay_apart)
{
    EXPECT_EQ(tidied({line(0, 0, 2000, 0, 1, 9), line(2000, 40, 4000, 40, 2, 9)})->line_count, 2);
    EXPECT_EQ(tidied({line(0, 0, 2000, 0, 1, 9), line(2500, 0, 4000, 0, 2, 9)})->line_count, 2);
}

TEST(MapTidy, walls_that_lie_or_point_apart_stay_apart)
{
    EXPECT_EQ(tidied({line(0, 0, 2000, 0, 1, 9), line(0, 130, 2000, 130, 2, 9)})->line_count, 2);
    EXPECT_EQ(tidied({line(0, 0, 300, 0, 1, 9), line(0, 0, 250, 110, 2, 9)})->line_count, 2);
}

TEST(MapTidy, a_bundle_of_lines_becomes_one_and_the_order_of_the_others_stays)
{
    const auto map =
        tidied({line(0, 5000, 1000, 5000, 7, 9), line(0, 0, 3000, 0, 1, 9), line(100, 30, 2900, 20, 2, 9),
                line(0, -20, 2500, -30, 3, 9), line(0, 9000, 1000, 9000, 8, 9)});
    ASSERT_EQ(map->line_count, 3);
    EXPECT_EQ(map->line[0].id, 7u);
    EXPECT_EQ(map->line[2].id, 8u);
}

TEST(MapTidy, an_empty_map_and_a_line_without_length_are_left_alone)
{
    EXPECT_EQ(tidied({})->line_count, 0);
    EXPECT_EQ(tidied({line(0, 0, 0, 0, 1, 9)})->line_count, 1);
}

TEST(MapTidy, a_full_map_is_tidied_too)
{
    auto map = std::make_unique<ale_map_t>();
    for (int k = 0; k < ALE_MAP_MAX_LINES; k++) {
        map->line[map->line_count++] =
            line(0, 1000 * (k / 2), 2000, 1000 * (k / 2), static_cast<uint32_t>(k), 9);
    }
    ale_map_tidy(map.get());
    EXPECT_EQ(map->line_count, ALE_MAP_MAX_LINES / 2);
}

} // namespace
