// lib/map/map_corner.c: corners of scans, associated with those of the map and averaged.
#include <memory>

#include <gtest/gtest.h>

extern "C" {
#include "map/map_corner.h"
}

namespace
{
struct MapCorner : testing::Test {
    std::unique_ptr<ale_map_corners_t> corners = std::make_unique<ale_map_corners_t>();
    void SetUp() override
    {
        ale_map_corners_clear(corners.get());
    }
};

TEST_F(MapCorner, IsObservedAgainAndAveraged)
{
    ale_features_t f = {};
    f.corner_count = 1;
    f.corner[0].p = {1000000, 500000};
    f.corner[0].cov_um2[0] = f.corner[0].cov_um2[2] = 4000000;
    EXPECT_EQ(ale_map_corners_update(corners.get(), &f, {0, 0, 0}, 0, true), 0);
    f.corner[0].p.x_um += 10000;
    EXPECT_EQ(ale_map_corners_update(corners.get(), &f, {0, 0, 0}, 0, true), 1);
    EXPECT_EQ(corners->count, 1);
    EXPECT_NEAR(corners->corner[0].p.x_um, 1005000, 1);
    f.corner[0].kind = ALE_CORNER_CONCAVE;
    EXPECT_EQ(ale_map_corners_update(corners.get(), &f, {0, 0, 0}, 0, false), 0);
    EXPECT_EQ(corners->count, 1);
}

TEST_F(MapCorner, AFullMapReplacesThoseThatWereSeenOnceAndRefusesThen)
{
    ale_features_t f = {};
    f.corner_count = 1;
    for (int32_t i = 0; i < ALE_MAP_MAX_CORNERS; i++) {
        f.corner[0].p = {i * 1000000, 0};
        ale_map_corners_update(corners.get(), &f, {0, 0, 0}, 0, true);
        if (i != 500) {
            ale_map_corners_update(corners.get(), &f, {0, 0, 0}, 1, true);
        }
    }
    EXPECT_EQ(corners->count, ALE_MAP_MAX_CORNERS);
    f.corner[0].p = {0, 9000000};
    ale_map_corners_update(corners.get(), &f, {0, 0, 0}, 2, true);
    EXPECT_EQ(corners->corner[500].p.y_um, 9000000);
    EXPECT_EQ(corners->refused, 0U);
    ale_map_corners_update(corners.get(), &f, {0, 0, 0}, 3, true);
    f.corner[0].p = {0, 12000000};
    ale_map_corners_update(corners.get(), &f, {0, 0, 0}, 4, true);
    EXPECT_EQ(corners->refused, 1U);
}
} // namespace
