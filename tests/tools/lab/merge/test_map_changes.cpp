#include <memory>

#include <gtest/gtest.h>

#include "lab/merge/map_changes.h"

namespace
{

using ale::WallChange;

constexpr int32_t centimetre = 10000;

/* Walls in centimetres, seen from their left. */
class MapChanges : public testing::Test
{
  protected:
    using Map = std::unique_ptr<ale_map_t>;

    static Map map_of(const std::vector<std::array<int32_t, 4>> &walls)
    {
        auto map = std::make_unique<ale_map_t>();
        for (const auto &[x0, y0, x1, y1] : walls) {
            ale_map_line_t &line = map->line[map->line_count++];
            line.start = {x0 * centimetre, y0 * centimetre};
            line.end = {x1 * centimetre, y1 * centimetre};
        }
        return map;
    }
    void compare(const Map &before, const Map &now)
    {
        const auto changes = merge::changes_between(*before, *now);
        new_cm = ale::changed_um(changes, WallChange::added) / centimetre;
        moved_cm = ale::changed_um(changes, WallChange::moved) / centimetre;
        gone_cm = ale::changed_um(changes, WallChange::gone) / centimetre;
    }
    int64_t new_cm = -1;
    int64_t moved_cm = -1;
    int64_t gone_cm = -1;
};

TEST_F(MapChanges, WhatStandsNearlyWhereItStoodHasNotChanged)
{
    compare(map_of({{0, 0, 400, 0}, {400, 0, 400, 300}}), map_of({{3, 5, 410, 3}, {394, 4, 396, 310}}));
    EXPECT_EQ(new_cm, 0);
    EXPECT_EQ(moved_cm, 0);
    EXPECT_EQ(gone_cm, 0);
}

TEST_F(MapChanges, OneWallInTwoPiecesIsTheSameWall)
{
    compare(map_of({{0, 0, 400, 0}}), map_of({{0, 0, 200, 0}, {205, 1, 400, 0}}));
    EXPECT_EQ(new_cm + moved_cm + gone_cm, 0);
}

TEST_F(MapChanges, AWallThatIsLongerByAMetreHasThatMetreNew)
{
    compare(map_of({{0, 0, 400, 0}}), map_of({{0, 0, 500, 0}}));
    EXPECT_NEAR(static_cast<double>(new_cm), 90, 6) << "ends count as seen to a tenth of a metre";
    EXPECT_EQ(moved_cm + gone_cm, 0);
}

TEST_F(MapChanges, ABoxThatStandsElsewhereWasMoved)
{
    compare(map_of({{0, 0, 80, 0}, {80, 0, 80, 50}, {80, 50, 0, 50}}),
            map_of({{100, 20, 180, 20}, {180, 20, 180, 70}, {180, 70, 100, 70}}));
    EXPECT_EQ(moved_cm, 80 + 50 + 80);
    EXPECT_EQ(new_cm, 0);
    EXPECT_EQ(gone_cm, 0);
}

/* A cupboard before a wall goes along it: what it hid is nearer to where it stood than where it stands now.
 */
TEST_F(MapChanges, AWallThatWasHiddenIsNewAndNotWhatHidIt)
{
    compare(map_of({{0, 0, 100, 0}, {190, 0, 500, 0}, {100, 60, 190, 60}}),
            map_of({{0, 0, 500, 0}, {230, 60, 320, 60}}));
    EXPECT_EQ(moved_cm, 90);
    EXPECT_NEAR(static_cast<double>(new_cm), 70, 6);
    EXPECT_EQ(gone_cm, 0);
}

TEST_F(MapChanges, WhatIsFarAwayOrOfAnotherLengthIsNewAndTheOtherGone)
{
    compare(map_of({{0, 0, 80, 0}, {0, 300, 200, 300}}), map_of({{300, 0, 380, 0}, {0, 320, 80, 320}}));
    EXPECT_EQ(moved_cm, 0);
    EXPECT_EQ(new_cm, 160);
    EXPECT_EQ(gone_cm, 280);
}

TEST_F(MapChanges, TheOtherSideOfAPanelIsAnotherWall)
{
    compare(map_of({{0, 0, 400, 0}}), map_of({{0, 0, 400, 0}, {400, 2, 0, 2}}));
    EXPECT_EQ(new_cm, 400);
    EXPECT_EQ(moved_cm + gone_cm, 0);
}

TEST_F(MapChanges, LengthsOfAMapAreThoseOfItsWalls)
{
    EXPECT_EQ(merge::walls_um(*map_of({{0, 0, 400, 0}, {0, 10, 0, 310}})), 700 * centimetre);
    EXPECT_EQ(merge::walls_um(*map_of({})), 0);
}

} // namespace
