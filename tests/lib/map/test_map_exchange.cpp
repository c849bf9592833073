// Export of the map: what others are told of a wall.
#include <memory>

#include <gtest/gtest.h>

extern "C" {
#include "map/map_exchange.h"
}

namespace
{

TEST(MapExchange, AnExportedWallSaysWhichMapItIsIn)
{
    const auto map = std::make_unique<ale_local_map_t>();
    const auto out = std::make_unique<ale_map_t>();
    ale_local_map_clear(map.get());
    for (uint8_t k = 0; k < 3; k++) {
        ale_wall_t wall{};
        wall.anchor = {0, k * 1000000};
        ale_wall_set_normal(&wall, 0);
        wall.end_um = 1000000;
        wall.seen = ALE_MAP_CONFIRMED;
        map->wall[ale_local_map_add(map.get(), &wall)].map = k;
    }
    ale_atlas_t atlas;
    ale_atlas_init(&atlas);
    ale_atlas_begin(&atlas);
    ale_atlas_join(&atlas, ALE_FIRST_MAP, {});
    ale_atlas_begin(&atlas); // at the place of the one that is no more, by another number
    ale_atlas_begin(&atlas);
    ale_map_export(map.get(), &atlas, out.get());
    ASSERT_EQ(out->line_count, 3);
    const uint32_t ids[] = {0, 2, 3};
    for (int k = 0; k < 3; k++) {
        EXPECT_EQ(out->line[k].map_id, ids[k]);
    }
}

} // namespace
