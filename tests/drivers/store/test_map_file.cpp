#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <memory>
#include <random>
#include <string>
#include <utility>

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "files.hpp"

extern "C" {
#include "store/map_file.h"
#include "store/map_text.h"
}

namespace
{

class MapFile : public testing::Test
{
  protected:
    std::string load_error(const std::string &bytes)
    {
        std::ofstream(path_, std::ios::binary) << bytes;
        error_[0] = '\0';
        return ale_map_file_load(path_.c_str(), loaded_.get(), error_) < 0 ? error_ : "";
    }
    std::string saved(const ale_map_t &map)
    {
        EXPECT_EQ(ale_map_file_save(path_.c_str(), &map, error_), 0) << error_;
        return files::content(path_);
    }

    const files::TemporaryFolder folder_;
    const std::filesystem::path path_ = folder_ / "map.ale";
    char error_[ALE_MAP_FILE_ERROR] = "";
    std::unique_ptr<ale_map_t> loaded_ = std::make_unique<ale_map_t>();
};

std::unique_ptr<ale_map_t> some_map(uint16_t lines, uint16_t corners)
{
    std::mt19937 random(4);
    const auto word = [&random] { return static_cast<uint32_t>(random()); };
    const auto any = [&random] { return static_cast<int32_t>(random()) / 2; };
    const auto variance = [&random] { return static_cast<int64_t>(1000000 + random() % 1000000000); };
    const auto covariance = [&random] { return static_cast<int64_t>(random() % 2000000) - 1000000; };
    auto map = std::make_unique<ale_map_t>();
    map->line_count = lines;
    map->corner_count = corners;
    for (int i = 0; i < lines; i++) {
        map->line[i] = {word(), {any(), any()}, {any(), any()}, variance(), covariance(), variance(), word()};
    }
    for (int i = 0; i < corners; i++) {
        map->corner[i] = {{any(), any()}, {variance(), covariance(), variance()},
                          word(),         word(),
                          word(),         static_cast<uint8_t>(i % 2)};
    }
    return map;
}

TEST_F(MapFile, AMapComesBackAsItWas)
{
    for (const int full : {0, 1}) {
        const auto map = some_map(full ? ALE_MAP_MAX_LINES : 7, full ? ALE_MAP_MAX_CORNERS : 3);
        ASSERT_EQ(load_error(saved(*map)), "");
        ASSERT_EQ(loaded_->line_count, map->line_count);
        ASSERT_EQ(loaded_->corner_count, map->corner_count);
        for (int i = 0; i < map->line_count; i++) {
            const ale_map_line_t &a = map->line[i];
            const ale_map_line_t &b = loaded_->line[i];
            ASSERT_TRUE(a.id == b.id && a.start.x_um == b.start.x_um && a.start.y_um == b.start.y_um &&
                        a.end.x_um == b.end.x_um && a.end.y_um == b.end.y_um && a.seen == b.seen &&
                        a.var_alpha_nrad2 == b.var_alpha_nrad2 && a.cov_alpha_rho == b.cov_alpha_rho &&
                        a.var_rho_um2 == b.var_rho_um2)
                << i;
        }
        for (int i = 0; i < map->corner_count; i++) {
            const ale_map_corner_t &a = map->corner[i];
            const ale_map_corner_t &b = loaded_->corner[i];
            ASSERT_TRUE(a.p.x_um == b.p.x_um && a.p.y_um == b.p.y_um && a.cov_um2[0] == b.cov_um2[0] &&
                        a.cov_um2[1] == b.cov_um2[1] && a.cov_um2[2] == b.cov_um2[2] &&
                        a.angle_bam == b.angle_bam && a.bisector_bam == b.bisector_bam && a.seen == b.seen &&
                        a.kind == b.kind)
                << i;
        }
    }
}

TEST_F(MapFile, AMapMaySayWhereTheRobotWas)
{
    const auto map = some_map(2, 1);
    const ale_pose_t pose = {-1200345, ALE_MAP_FARTHEST_UM, 4294967295U};
    ale_pose_t read = {1, 2, 3};
    bool known = true;
    saved(*map);
    ASSERT_EQ(ale_map_file_load_with_pose(path_.c_str(), loaded_.get(), &read, &known, error_), 0);
    EXPECT_FALSE(known);
    EXPECT_EQ(read.x_um, 1);
    ASSERT_EQ(ale_map_file_save_with_pose(path_.c_str(), map.get(), &pose, error_), 0);
    ASSERT_EQ(ale_map_file_load_with_pose(path_.c_str(), loaded_.get(), &read, &known, error_), 0);
    EXPECT_TRUE(known);
    EXPECT_EQ(read.x_um, pose.x_um);
    EXPECT_EQ(read.y_um, pose.y_um);
    EXPECT_EQ(read.theta_bam, pose.theta_bam);
    EXPECT_EQ(ale_map_file_load(path_.c_str(), loaded_.get(), error_), 0) << "for those who do not ask, too";
    EXPECT_EQ(load_error("ALE-SLAM map 1\npose 1 2\n"), path_.string() + ": line 2: damaged or too large");
}

TEST_F(MapFile, AnEmptyMapIsAMap)
{
    EXPECT_EQ(load_error(saved(*some_map(0, 0))), "");
    EXPECT_EQ(loaded_->line_count, 0);
}

TEST_F(MapFile, AnyFlippedByteIsNoticedAndTheOldMapStays)
{
    const std::string good = saved(*some_map(3, 2));
    loaded_->line_count = 77;
    for (size_t at = 0; at + 1 < good.size(); at++) {
        std::string bad = good;
        bad[at] ^= 0x01;
        ASSERT_NE(load_error(bad), "") << "byte " << at;
        ASSERT_EQ(loaded_->line_count, 77);
    }
}

TEST_F(MapFile, AnyCutIsNoticed)
{
    const std::string good = saved(*some_map(3, 2));
    for (size_t length = 0; length + 1 < good.size(); length++) {
        ASSERT_NE(load_error(good.substr(0, length)), "") << length;
    }
}

TEST_F(MapFile, ErrorsNameFileLineAndReason)
{
    EXPECT_EQ(load_error("ALE-SLAM map 2\n"), path_.string() + ": line 1: not a map of version 1");
    EXPECT_EQ(load_error("ALE-SLAM map 1\nwall 1 2 3\n"), path_.string() + ": line 2: damaged or too large");
    EXPECT_EQ(ale_map_file_load((folder_ / "absent").c_str(), loaded_.get(), error_), -1);
    EXPECT_EQ(std::string(error_), (folder_ / "absent").string() + ": No such file or directory");
}

TEST_F(MapFile, AFailedSaveLeavesTheOldFileAndNothingElse)
{
    const std::string before = saved(*some_map(2, 1));
    EXPECT_EQ(ale_map_file_save((folder_ / "no/such/map").c_str(), loaded_.get(), error_), -1);
    std::filesystem::create_directory(folder_ / "folder");
    EXPECT_EQ(ale_map_file_save((folder_ / "folder").c_str(), loaded_.get(), error_), -1);
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_.path()), {}), 2);
    EXPECT_EQ(load_error(before), "");
}

TEST_F(MapFile, NumbersThatNoMapHasAreRefusedThoughTheSumIsRight)
{
    const auto refusal = [&](const std::function<void(ale_map_t &)> &spoil) {
        const auto map = some_map(2, 1);
        spoil(*map);
        return load_error(saved(*map));
    };
    const auto at = [&](int line) {
        return path_.string() + ": line " + std::to_string(line) + ": damaged or too large";
    };
    EXPECT_EQ(refusal([](ale_map_t &map) { map.line[0].start.y_um = INT32_MIN; }), at(4));
    EXPECT_EQ(refusal([](ale_map_t &map) { map.line[1].end.x_um = ALE_MAP_FARTHEST_UM + 1; }), at(5));
    EXPECT_EQ(refusal([](ale_map_t &map) { map.line[1].cov_alpha_rho = INT64_MIN; }), at(5));
    EXPECT_EQ(refusal([](ale_map_t &map) { map.line[1].cov_alpha_rho = -728838383837000; }), at(5));
    EXPECT_EQ(refusal([](ale_map_t &map) { map.line[1].var_rho_um2 = INT64_MAX; }), at(5));
    EXPECT_EQ(refusal([](ale_map_t &map) { map.corner[0].cov_um2[1] = INT64_MAX; }), at(6));
}

TEST_F(MapFile, ALinkOrAPipeIsNoMap)
{
    const auto map = some_map(3, 2);
    const std::string before = saved(*map);
    const std::filesystem::path link = folder_ / "link.map";
    const std::filesystem::path pipe = folder_ / "pipe.map";
    std::filesystem::create_symlink(path_, link);
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    for (const auto &[path, words] : {std::pair(link, ": a symbolic link, which is not followed"),
                                      std::pair(pipe, ": no regular file")}) {
        EXPECT_EQ(ale_map_file_load(path.c_str(), loaded_.get(), error_), -1);
        EXPECT_EQ(std::string(error_), path.string() + words);
        EXPECT_EQ(ale_map_file_save(path.c_str(), map.get(), error_), -1);
        EXPECT_EQ(std::string(error_), path.string() + words);
    }
    EXPECT_EQ(files::content(path_), before);
}

TEST_F(MapFile, IsRefusedForItsSizeBeforeItIsRead)
{
    std::ofstream(path_) << "ALE-SLAM map 1\n";
    std::filesystem::resize_file(path_, uintmax_t{1} << 40U); /* a hole: no disk is filled */
    EXPECT_EQ(ale_map_file_load(path_.c_str(), loaded_.get(), error_), -1);
    EXPECT_EQ(std::string(error_), path_.string() + ": too large");
}

TEST_F(MapFile, IsForItsOwnerAndHisGroup)
{
    saved(*some_map(1, 0));
    EXPECT_EQ(std::filesystem::status(path_).permissions() & std::filesystem::perms::others_all,
              std::filesystem::perms::none);
}

} // namespace
