// drivers/store/tile_loader: as the robot goes on, the walls around it come and those behind it go.
#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <random>
#include <set>
#include <string>

#include "drivers/store/tile_maps.hpp"
#include "files.hpp"

extern "C" {
#include "store/tile_loader.h"
}

namespace
{

struct CloseLoader {
    void operator()(ale_tile_loader_t *loader) const
    {
        ale_tile_loader_close(loader);
    }
};

class TileLoader : public testing::Test
{
  protected:
    void open(const tile_maps::Map &map)
    {
        tile_maps::save(path_, map);
        reopen();
    }
    void reopen()
    {
        char error[ALE_MAP_FILE_ERROR] = "";
        loader_.reset(ale_tile_loader_open(path_.c_str(), error));
        ASSERT_NE(loader_, nullptr) << error;
        given_.clear();
    }
    /* The robot says where it is; what comes and goes is done. Pieces that came. */
    int follow(int32_t x_um, int32_t y_um, int64_t reach_um = 12000000)
    {
        const ale_whereabouts_t whereabouts = {epoch_, scan_, {x_um, y_um, 0}, reach_um};
        ale_tile_loader_follow(loader_.get(), &whereabouts);
        int pieces = 0;
        while (ale_tile_loader_next(loader_.get(), piece_.get())) {
            take();
            pieces++;
        }
        EXPECT_TRUE(pieces == 0 || piece_->last);
        scan_ += ALE_WHEREABOUTS_SCANS;
        return pieces;
    }
    void take()
    {
        EXPECT_EQ(piece_->epoch, epoch_);
        EXPECT_GE(piece_->due, scan_ + ALE_TILE_DELAY_SCANS);
        EXPECT_GT(piece_->due, last_due_) << "one a scan";
        last_due_ = piece_->due;
        EXPECT_TRUE(std::is_sorted(piece_->gone, piece_->gone + piece_->gone_count));
        for (int k = 0; k < piece_->gone_count; k++) {
            EXPECT_EQ(given_.erase(piece_->gone[k]), 1U) << "what goes was there";
        }
        for (int k = 0; k < piece_->line_count; k++) {
            EXPECT_TRUE(given_.insert(piece_->line[k].id).second) << "none comes twice";
        }
        corners_ += piece_->corner_count;
    }
    ale_box_t around(int32_t x_um, int32_t y_um, int64_t reach_um) const
    {
        return {x_um - reach_um, y_um - reach_um, x_um + reach_um, y_um + reach_um};
    }

    const files::TemporaryFolder folder_;
    const std::filesystem::path path_ = folder_ / "building.tiles";
    std::unique_ptr<ale_tile_loader_t, CloseLoader> loader_;
    std::unique_ptr<ale_tile_change_t> piece_ = std::make_unique<ale_tile_change_t>();
    std::set<uint32_t> given_;
    int corners_ = 0;
    uint32_t epoch_ = 1;
    uint32_t scan_ = 0;
    uint32_t last_due_ = 0;
};

TEST_F(TileLoader, WhereverTheRobotGoesAllWithinReachIsThereAndNothingFar)
{
    const auto map = tile_maps::some(10000, 150000000, 21);
    open(map);
    std::mt19937 random(22);
    std::uniform_int_distribution<int32_t> step(-3000000, 4000000);
    int32_t x = -100000000;
    int32_t y = -100000000;
    size_t most = 0;
    int changes = 0;
    for (int k = 0; k < 200; k++) {
        changes += follow(x, y) > 0;
        const ale_box_t reach = around(x, y, 12000000);
        const ale_box_t far = around(x, y, 12000000 + ALE_TILE_SIDE_UM / 2 + ALE_TILE_SIDE_UM);
        for (uint32_t id = 1; id <= map.lines.size(); id++) {
            const ale_map_line_t &line = map.lines[id - 1];
            ASSERT_TRUE(given_.count(id) == 1 || !ale_box_touches(&reach, line.start, line.end)) << k;
            ASSERT_TRUE(given_.count(id) == 0 || ale_box_touches(&far, line.start, line.end)) << k;
        }
        most = std::max(most, given_.size());
        x += step(random);
        y += step(random);
    }
    EXPECT_GT(changes, 25);
    EXPECT_LT(most, 1000U) << "of 10000";
    EXPECT_EQ(ale_tile_loader_trouble(loader_.get())->unread, 0U);
    EXPECT_EQ(ale_tile_loader_trouble(loader_.get())->refused, 0U);
}

TEST_F(TileLoader, ARobotThatStaysAsksTheDiskForNothing)
{
    open(tile_maps::some(3000, 100000000, 23));
    EXPECT_GT(follow(0, 0), 0);
    std::filesystem::resize_file(path_, 0); // of the very file that is open
    for (int k = 0; k < 20; k++) {
        EXPECT_EQ(follow(k % 2 * 3000000, 0), 0);
    }
    EXPECT_EQ(ale_tile_loader_trouble(loader_.get())->unread, 0U);
}

TEST_F(TileLoader, ANewEpochBeginsWithNothing)
{
    open(tile_maps::some(3000, 100000000, 24));
    follow(0, 0);
    const std::set<uint32_t> first = given_;
    ASSERT_FALSE(first.empty());
    epoch_++;
    scan_ = last_due_ = 0;
    given_.clear(); // the map in work is another one
    follow(0, 0);
    EXPECT_EQ(given_, first);
}

TEST_F(TileLoader, OnceAllOfASmallMapIsThereItSaysSo)
{
    open(tile_maps::some(100, 4000000, 25));
    ASSERT_GT(follow(0, 0), 0);
    EXPECT_TRUE(piece_->whole);
    EXPECT_EQ(corners_, 100);
    ASSERT_GT(follow(80000000, 0), 0);
    EXPECT_FALSE(piece_->whole);
    EXPECT_TRUE(given_.empty());
}

TEST_F(TileLoader, ADamagedTileIsToldAndTheRestGoesOn)
{
    const auto map = tile_maps::some(3000, 60000000, 26);
    open(map);
    follow(0, 0);
    const std::set<uint32_t> all = given_;
    const ale_tile_file_t *file = ale_tile_loader_file(loader_.get());
    const ale_tile_entry_t spoilt = *ale_tile_file_find(file, 0, 0);
    std::string bytes = files::content(path_);
    bytes[static_cast<size_t>(file->index_bytes + spoilt.first_byte) + 40] ^= 1;
    files::write(path_, bytes);
    reopen();
    scan_ = last_due_ = 0;
    follow(0, 0);
    EXPECT_EQ(ale_tile_loader_trouble(loader_.get())->unread, 1U);
    EXPECT_EQ(std::string(ale_tile_loader_trouble(loader_.get())->error).find("tile 0 0: "), 0U);
    EXPECT_FALSE(piece_->whole);
    const ale_box_t tile = ale_tile_range_box({0, 0, 0, 0}, ALE_TILE_SIDE_UM);
    for (const uint32_t id : all) {
        const ale_map_line_t &line = map.lines[id - 1];
        const bool ends_elsewhere = !ale_box_has(&tile, line.start) || !ale_box_has(&tile, line.end);
        EXPECT_EQ(given_.count(id) == 1, ends_elsewhere || !ale_box_touches(&tile, line.start, line.end));
    }
}

TEST_F(TileLoader, WhereWallsAreTooManyThoseNearestAreLoadedAndThatIsSaid)
{
    open(tile_maps::some(6000, 30000000, 27)); // 1.7 a square metre
    follow(0, 0, 25000000);
    const ale_tile_trouble_t *trouble = ale_tile_loader_trouble(loader_.get());
    EXPECT_LE(given_.size(), static_cast<size_t>(ALE_TILE_WALLS));
    EXPECT_GT(given_.size(), 300U);
    EXPECT_EQ(trouble->wanted_um, 25000000);
    EXPECT_LT(trouble->reach_um, 20000000);
    EXPECT_EQ(trouble->refused, 0U);
}

TEST_F(TileLoader, ItsPiecesTakeOneAfterAnotherThroughAMapInWork)
{
    const auto map = tile_maps::some(10000, 150000000, 28);
    open(map);
    auto work = std::make_unique<ale_local_map_t>();
    ale_local_map_clear(work.get());
    for (int k = 0; k < 100; k++) {
        const ale_whereabouts_t whereabouts = {
            epoch_, scan_++, {k * 2000000 - 100000000, k * 1000000, 0}, 12000000};
        ale_tile_loader_follow(loader_.get(), &whereabouts);
        while (ale_tile_loader_next(loader_.get(), piece_.get())) {
            ale_tile_change_apply(work.get(), piece_.get());
            for (int i = 0; i < piece_->gone_count; i++) {
                given_.erase(piece_->gone[i]);
            }
            for (int i = 0; i < piece_->line_count; i++) {
                given_.insert(piece_->line[i].id);
            }
        }
        std::set<uint32_t> in_work;
        for (int i = 0; i < work->count; i++) {
            in_work.insert(work->wall[i].prior_id);
        }
        ASSERT_EQ(in_work, given_) << k;
    }
    EXPECT_EQ(work->refused, 0U);
}

} // namespace
