// drivers/store/tile_file: a map of any size by tiles; all of it, and nothing of what is damaged.
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <string>

#include "drivers/store/tile_maps.hpp"
#include "files.hpp"

namespace
{

class TileFile : public testing::Test
{
  protected:
    ~TileFile() override
    {
        ale_tile_file_close(&file_);
    }
    std::string open_error()
    {
        ale_tile_file_close(&file_);
        error_[0] = '\0';
        return ale_tile_file_open(&file_, path_.c_str(), error_) < 0 ? error_ : "";
    }
    std::string save_error(const tile_maps::Map &map, int32_t side_um = ALE_TILE_SIDE_UM)
    {
        const ale_whole_map_t whole = map.whole();
        return ale_tile_file_save(path_.c_str(), &whole, side_um, error_) < 0 ? error_ : "";
    }
    bool read(const ale_tile_entry_t &tile)
    {
        return ale_tile_file_read(&file_, &tile, tile_.get(), error_) == 0;
    }

    const files::TemporaryFolder folder_;
    const std::filesystem::path path_ = folder_ / "building.tiles";
    char error_[ALE_MAP_FILE_ERROR] = "";
    ale_tile_file_t file_{};
    std::unique_ptr<ale_map_t> tile_ = std::make_unique<ale_map_t>();
};

bool same(const ale_map_line_t &a, const ale_map_line_t &b)
{
    return a.start.x_um == b.start.x_um && a.start.y_um == b.start.y_um && a.end.x_um == b.end.x_um &&
           a.end.y_um == b.end.y_um && a.var_alpha_nrad2 == b.var_alpha_nrad2 &&
           a.cov_alpha_rho == b.cov_alpha_rho && a.var_rho_um2 == b.var_rho_um2 && a.seen == b.seen;
}

TEST_F(TileFile, ItsTilesAreTheMapEveryWallInAllThatItTouchesEveryCornerInOne)
{
    for (const int32_t side_um : {3000000, 10000000, 250000000}) {
        const auto map = tile_maps::some(side_um > 100000000 ? 1000 : 20000, 300000000, 3);
        tile_maps::save(path_, map, side_um);
        ASSERT_EQ(open_error(), "");
        EXPECT_EQ(file_.side_um, side_um);
        EXPECT_EQ(file_.walls, map.lines.size());
        EXPECT_EQ(file_.corners, map.corners.size());
        std::map<uint32_t, int> walls; // by number: in so many tiles
        size_t corners = 0;
        for (uint32_t k = 0; k < file_.count; k++) {
            const ale_tile_entry_t &tile = file_.tile[k];
            ASSERT_EQ(ale_tile_file_find(&file_, tile.x, tile.y), &tile);
            ASSERT_TRUE(read(tile)) << error_;
            const ale_box_t box = ale_tile_range_box({tile.x, tile.y, tile.x, tile.y}, side_um);
            for (int i = 0; i < tile_->line_count; i++) {
                const ale_map_line_t &line = tile_->line[i];
                ASSERT_TRUE(line.id > 0 && line.id <= map.lines.size());
                ASSERT_TRUE(same(line, map.lines[line.id - 1]));
                ASSERT_TRUE(ale_box_touches(&box, line.start, line.end));
                walls[line.id]++;
            }
            for (int i = 0; i < tile_->corner_count; i++) {
                ASSERT_TRUE(ale_box_has(&box, tile_->corner[i].p));
            }
            corners += tile_->corner_count;
        }
        ASSERT_EQ(walls.size(), map.lines.size());
        EXPECT_EQ(corners, map.corners.size());
        for (uint32_t id = 1; id <= map.lines.size(); id++) { // none is missing where it touches
            const ale_map_line_t &line = map.lines[id - 1];
            const ale_tile_range_t a = ale_tile_range_around(line.start, 0, side_um);
            const ale_tile_range_t b = ale_tile_range_around(line.end, 0, side_um);
            int touched = 0;
            for (int32_t y = std::min(a.first_y, b.first_y); y <= std::max(a.last_y, b.last_y); y++) {
                for (int32_t x = std::min(a.first_x, b.first_x); x <= std::max(a.last_x, b.last_x); x++) {
                    const ale_box_t box = ale_tile_range_box({x, y, x, y}, side_um);
                    touched += ale_box_touches(&box, line.start, line.end);
                }
            }
            ASSERT_EQ(walls[id], touched) << id;
        }
    }
}

TEST_F(TileFile, AnEmptyMapHasNoTiles)
{
    tile_maps::save(path_, {});
    ASSERT_EQ(open_error(), "");
    EXPECT_EQ(file_.count, 0U);
    EXPECT_EQ(ale_tile_file_find(&file_, 0, 0), nullptr);
}

TEST_F(TileFile, TheSameMapGivesTheSameBytes)
{
    const auto map = tile_maps::some(300, 40000000, 4);
    tile_maps::save(path_, map);
    const std::string once = files::content(path_);
    tile_maps::save(path_, map);
    EXPECT_EQ(files::content(path_), once);
}

TEST_F(TileFile, ADamagedTileCostsItselfAndNothingElse)
{
    tile_maps::save(path_, tile_maps::some(400, 40000000, 5));
    const std::string good = files::content(path_);
    ASSERT_EQ(open_error(), "");
    const ale_tile_entry_t spoilt = file_.tile[file_.count / 2];
    const auto at = static_cast<size_t>(file_.index_bytes + spoilt.first_byte);
    for (const size_t byte : {size_t{3}, size_t{spoilt.bytes / 2}, size_t{spoilt.bytes} - 3}) {
        std::string bytes = good;
        bytes[at + byte] = static_cast<char>(bytes[at + byte] ^ 0x15);
        files::write(path_, bytes);
        ASSERT_EQ(open_error(), "");
        for (uint32_t k = 0; k < file_.count; k++) {
            const bool is_it = file_.tile[k].x == spoilt.x && file_.tile[k].y == spoilt.y;
            tile_->line_count = 77;
            ASSERT_EQ(read(file_.tile[k]), !is_it);
            if (is_it) {
                EXPECT_EQ(tile_->line_count, 77) << "nothing of it is taken";
                EXPECT_EQ(std::string(error_).find("tile " + std::to_string(spoilt.x) + " " +
                                                   std::to_string(spoilt.y) + ": "),
                          0U);
            }
        }
    }
}

TEST_F(TileFile, AnIndexWithAnyByteChangedIsRefused)
{
    tile_maps::save(path_, tile_maps::some(30, 20000000, 6));
    const std::string good = files::content(path_);
    ASSERT_EQ(open_error(), "");
    const auto index_bytes = static_cast<size_t>(file_.index_bytes);
    for (size_t k = 0; k < index_bytes; k++) {
        std::string bytes = good;
        bytes[k] = static_cast<char>(bytes[k] ^ 1);
        files::write(path_, bytes);
        ASSERT_NE(open_error(), "") << k;
        ASSERT_EQ(file_.in, nullptr);
    }
}

TEST_F(TileFile, ACutFileIsRefusedOrLacksItsLastTiles)
{
    tile_maps::save(path_, tile_maps::some(60, 20000000, 7));
    const std::string good = files::content(path_);
    ASSERT_EQ(open_error(), "");
    const auto index_bytes = static_cast<size_t>(file_.index_bytes);
    for (size_t count = 0; count < good.size(); count += 37) {
        files::write(path_, good.substr(0, count));
        ASSERT_EQ(open_error() == "", count >= index_bytes) << count;
        for (uint32_t k = 0; k < file_.count; k++) {
            const ale_tile_entry_t &tile = file_.tile[k];
            ASSERT_EQ(read(tile), index_bytes + tile.first_byte + tile.bytes <= count);
        }
    }
}

TEST_F(TileFile, WhatIsReadIsTheFileThatWasOpenedThoughAnotherHasTakenItsPlace)
{
    const auto before = tile_maps::some(200, 30000000, 8);
    tile_maps::save(path_, before);
    ASSERT_EQ(open_error(), "");
    tile_maps::save(path_, tile_maps::some(200, 30000000, 9));
    for (uint32_t k = 0; k < file_.count; k++) {
        ASSERT_TRUE(read(file_.tile[k])) << error_;
        for (int i = 0; i < tile_->line_count; i++) {
            ASSERT_TRUE(same(tile_->line[i], before.lines[tile_->line[i].id - 1]));
        }
    }
}

TEST_F(TileFile, WhatCannotBeSavedIsSaidAndLeavesTheFileAsItWas)
{
    tile_maps::save(path_, tile_maps::some(10, 1000000, 1));
    const std::string before = files::content(path_);
    tile_maps::Map map;
    map.lines.push_back(tile_maps::wall(0, 0, ALE_MAP_FARTHEST_UM + 1, 0));
    EXPECT_EQ(save_error(map), path_.string() + ": a wall is farther from the origin than 1073 m");
    map = tile_maps::some(2 * ALE_MAP_MAX_LINES, 4000000, 2);
    EXPECT_EQ(save_error(map),
              path_.string() + ": more walls or corners in a tile than in a map: choose smaller tiles");
    EXPECT_NE(save_error(map, 1234567), "");
    EXPECT_EQ(files::content(path_), before);
    EXPECT_FALSE(std::filesystem::exists(path_.string() + ".new"));
}

TEST_F(TileFile, OtherFilesAreNone)
{
    EXPECT_FALSE(ale_tile_file_is(path_.c_str()));
    EXPECT_EQ(open_error(), path_.string() + ": No such file or directory");
    files::write(path_, "ALE-SLAM map 1\nend 0 00000000\n");
    EXPECT_FALSE(ale_tile_file_is(path_.c_str()));
    EXPECT_EQ(open_error(), path_.string() + ": not a map of tiles of version 1");
    tile_maps::save(path_, {});
    EXPECT_TRUE(ale_tile_file_is(path_.c_str()));
    const auto link = folder_ / "link";
    std::filesystem::create_symlink(path_, link);
    EXPECT_FALSE(ale_tile_file_is(link.c_str()));
    EXPECT_LT(ale_tile_file_open(&file_, link.c_str(), error_), 0);
    EXPECT_FALSE(ale_tile_file_is(folder_.path().c_str()));
    EXPECT_LT(ale_tile_file_open(&file_, folder_.path().c_str(), error_), 0);
}

} // namespace
