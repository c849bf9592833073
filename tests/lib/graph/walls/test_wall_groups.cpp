// lib/graph/walls/wall_groups: lines of scans with pose errors, against their walls.
#include <random>

#include <gtest/gtest.h>

#include "lib/graph/placed_lines.hpp"

using placed_lines::line;

namespace
{

double offset_mm(const ale_wall_t &wall, double normal_deg)
{
    const uint32_t normal_bam = placed_lines::bam_of_degrees(normal_deg);
    return static_cast<double>(
               ale_along(ale_wall_point(&wall, (int64_t{wall.start_um} + wall.end_um) / 2), normal_bam)) *
           1e-3;
}

TEST(WallGroups, LinesOfOneWallAreOneGroupDespitePoseErrors)
{
    std::mt19937 random(5);
    std::normal_distribution<double> normal;
    for (const double direction_deg : {0.0, 37.0, 90.0, 181.0, 359.9}) {
        std::vector<ale::PlacedLine> lines;
        for (uint32_t k = 0; k < 200; k++) {
            const double from_m = 0.03 * k;
            lines.push_back(
                line(k, direction_deg, from_m, from_m + 1.5, 10 * normal(random), 6 * normal(random)));
        }
        const std::vector<ale::WallGroup> groups = ale::group_lines(lines);
        ASSERT_EQ(groups.size(), 1U) << direction_deg;
        EXPECT_EQ(groups[0].lines.size(), lines.size());
        EXPECT_NEAR(offset_mm(groups[0].wall, direction_deg), 0, 4);
        EXPECT_NEAR((groups[0].wall.end_um - groups[0].wall.start_um) * 1e-6, 199 * 0.03 + 1.5, 0.01);
    }
}

TEST(WallGroups, BothSidesOfAPanelAreTwoWalls)
{
    std::vector<ale::PlacedLine> lines;
    for (uint32_t k = 0; k < 20; k++) {
        lines.push_back(line(k, 90, 0, 2, 10));
        lines.push_back(line(k, 270, -2, 0, 10));
    }
    EXPECT_EQ(ale::group_lines(lines).size(), 2U);
}

// The second visit is displaced by more than a pose error.
TEST(WallGroups, AWallThatIsSingleInEveryScanIsOneGroup)
{
    std::vector<ale::PlacedLine> lines;
    for (uint32_t k = 0; k < 40; k++) {
        lines.push_back(line(k, 20, 0, 2, k < 20 ? 0 : 200));
    }
    const std::vector<ale::WallGroup> groups = ale::group_lines(lines);
    ASSERT_EQ(groups.size(), 1U);
    EXPECT_NEAR(offset_mm(groups[0].wall, 20), 100, 10);
}

// What one drive has seen here and another there was moved between them; a drive that has seen both ties
// them.
TEST(WallGroups, AWallThatTwoDrivesSeeApartIsTwo)
{
    std::vector<ale::PlacedLine> lines;
    for (uint32_t k = 0; k < 40; k++) {
        lines.push_back(line(k, 20, 0, 2, k < 20 ? 0 : 200));
        lines.back().drive = k < 20 ? 0 : 1;
    }
    EXPECT_EQ(ale::group_lines(lines).size(), 2U);
    std::swap(lines[19].line, lines[20].line);
    EXPECT_EQ(ale::group_lines(lines).size(), 1U);
}

TEST(WallGroups, AStepSeenByScansStaysAStep)
{
    std::vector<ale::PlacedLine> lines;
    for (uint32_t k = 0; k < 20; k++) {
        lines.push_back(line(k, 20, 0, 1.05, 0));
        lines.push_back(line(k, 20, 1.0, 2, 150));
    }
    const std::vector<ale::WallGroup> groups = ale::group_lines(lines);
    ASSERT_EQ(groups.size(), 2U);
    EXPECT_NEAR(offset_mm(groups[0].wall, 20) + offset_mm(groups[1].wall, 20), 150, 2);
}

TEST(WallGroups, WallsOnBothSidesOfADoorAreTwo)
{
    std::vector<ale::PlacedLine> lines;
    for (uint32_t k = 0; k < 20; k++) {
        lines.push_back(line(k, 120, -2, -0.5, 0));
        lines.push_back(line(k, 120, 0.5, 2, 0));
    }
    EXPECT_EQ(ale::group_lines(lines).size(), 2U);
}

TEST(WallGroups, ShortLinesStartNoGroup)
{
    std::vector<ale::PlacedLine> lines;
    for (uint32_t k = 0; k < 20; k++) {
        lines.push_back(line(k, 0, 0, 0.2, 0));
    }
    EXPECT_TRUE(ale::group_lines(lines).empty());
}

} // namespace
