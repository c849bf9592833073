extern "C" {
#include "map/atlas.h"
}

#include <gtest/gtest.h>

namespace
{

class Atlas : public testing::Test
{
  protected:
    Atlas()
    {
        ale_atlas_init(&atlas);
    }

    ale_atlas_t atlas;
};

TEST_F(Atlas, BeginsWithTheFirstMap)
{
    EXPECT_EQ(ale_atlas_maps(&atlas), 1u);
    EXPECT_EQ(ale_atlas_map_id(&atlas), 0u);
    EXPECT_EQ(atlas.join.number, 0u);
}

TEST_F(Atlas, NumbersMapsAndNeverUsesANumberTwice)
{
    ale_atlas_begin(&atlas);
    EXPECT_EQ(ale_atlas_map_id(&atlas), 1u);
    ale_atlas_join(&atlas, ALE_FIRST_MAP, {1, 2, 3});
    EXPECT_EQ(ale_atlas_map_id(&atlas), 0u);
    EXPECT_EQ(ale_atlas_maps(&atlas), 1u);
    EXPECT_EQ(atlas.join.number, 1u);
    EXPECT_EQ(atlas.join.map_id, 1u);
    EXPECT_EQ(atlas.join.into_map_id, 0u);
    EXPECT_EQ(atlas.join.shift.y_um, 2);
    ale_atlas_begin(&atlas);
    EXPECT_EQ(ale_atlas_map_id(&atlas), 2u);
}

TEST_F(Atlas, GivesUpTheOldestButTheFirst)
{
    for (uint32_t k = 1; k < ALE_ATLAS_MAPS; k++) {
        EXPECT_EQ(ale_atlas_begin(&atlas), k);
    }
    EXPECT_EQ(ale_atlas_maps(&atlas), uint32_t{ALE_ATLAS_MAPS});
    EXPECT_EQ(ale_atlas_begin(&atlas), 1);
    EXPECT_EQ(ale_atlas_begin(&atlas), 2);
    EXPECT_EQ(ale_atlas_maps(&atlas), uint32_t{ALE_ATLAS_MAPS});
    EXPECT_TRUE(atlas.used[ALE_FIRST_MAP]);
}

TEST_F(Atlas, AMapThatIsAbsorbedIsNoMoreAndTheRobotGoesAlong)
{
    const uint8_t other = ale_atlas_begin(&atlas);
    const uint8_t here = ale_atlas_begin(&atlas);
    ale_atlas_absorb(&atlas, other, ALE_FIRST_MAP);
    EXPECT_EQ(atlas.current, here);
    EXPECT_EQ(ale_atlas_find(&atlas, 1), ALE_NO_MAP);
    ale_atlas_absorb(&atlas, here, ALE_FIRST_MAP);
    EXPECT_EQ(atlas.current, ALE_FIRST_MAP);
    EXPECT_EQ(ale_atlas_maps(&atlas), 1u);
    EXPECT_EQ(atlas.join.number, 0u);
}

} // namespace
