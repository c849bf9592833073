/* Lists and copies of what lies in the console's folders. */
#include "operator/console/recordings/archive.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <stdexcept>

#include <fcntl.h>

#include "ale/map_t.hpp"
#include "ale/scan_t.hpp"
#include "files.hpp"
#include "operator/console/recordings/event_file.h"

extern "C" {
#include "store/map_file.h"
}

using console::Archive;
using console::Board;
using console::Content;
using console::Contents;
using console::Descriptor;
using console::EventWriter;
using console::Shelf;
using console::Thumbnail;
using console::thumbnail_of;
using console::wanted_of;

namespace
{

constexpr int32_t metre = 1000000;

std::shared_ptr<ale_map_t> map_of(std::initializer_list<ale_map_line_t> lines)
{
    auto map = std::make_shared<ale_map_t>();
    for (const ale_map_line_t &line : lines) {
        map->line[map->line_count++] = line;
    }
    return map;
}

ale_map_line_t wall(int32_t x1, int32_t y1, int32_t x2, int32_t y2)
{
    ale_map_line_t line{};
    line.start = {x1 * metre, y1 * metre};
    line.end = {x2 * metre, y2 * metre};
    line.var_alpha_nrad2 = line.var_rho_um2 = 1000000;
    line.seen = 20;
    return line;
}

class ArchiveOfTwo : public testing::Test
{
  protected:
    ArchiveOfTwo()
    {
        for (const std::string &folder : {recordings_, flights_, maps_}) {
            std::filesystem::create_directory(folder);
        }
    }

    template <class Message>
    void put(EventWriter &writer, int64_t at_us, const char *channel, const Message &message)
    {
        std::vector<uint8_t> bytes(static_cast<size_t>(message.getEncodedSize()));
        message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
        writer.put(at_us, channel, bytes.data(), bytes.size());
    }

    /* A minute long; its last map has one part of two. */
    void record(const std::string &name)
    {
        EventWriter writer(Descriptor(open((recordings_ + "/" + name).c_str(), O_WRONLY | O_CREAT, 0600)));
        ale::map_t map{};
        map.version = map.parts = 1;
        map.num_lines = 2;
        map.lines.resize(2);
        map.lines[0].x2 = 4;
        map.lines[1].y2 = 1;
        put(writer, 5000000, "ALE_MAP", map);
        put(writer, 6000000, "ALE_SCAN", ale::scan_t{});
        map.version = map.parts = 2;
        put(writer, 65000000, "ALE_MAP", map);
        ASSERT_EQ(writer.flush(), 0);
    }

    std::string text_of(const std::string &path)
    {
        const auto content = archive_.fetch(*wanted_of(path));
        return content ? content->text : "";
    }

    const files::TemporaryFolder root_;
    const std::string recordings_ = (root_ / "recordings").string();
    const std::string maps_ = (root_ / "maps").string();
    Board board_;
    const std::string flights_ = (root_ / "flights").string();
    const Archive::Shelves shelves_{
        {recordings_, ".lcm"}, {recordings_, ".scip"}, {flights_, ".scip"}, {maps_, ".map"}};
    Archive archive_{board_, shelves_};
};

} // namespace

TEST_F(ArchiveOfTwo, TellsLengthScansAndTheLastWholeMapOfARecording)
{
    record("a.lcm");
    files::write(recordings_ + "/empty.lcm", "");
    const Contents contents = archive_.recordings("");
    ASSERT_EQ(contents.pieces.size(), 2U);
    const auto &piece = contents.pieces[contents.pieces[0].name == "a" ? 0 : 1];
    EXPECT_EQ(piece.at_ms, 5000);
    EXPECT_EQ(piece.length_ms, 60000);
    EXPECT_TRUE(piece.has_scans);
    EXPECT_EQ(piece.walls, 2);
    EXPECT_EQ(piece.thumbnail, (Thumbnail{0, 0, 1000, 0, 0, 0, 0, 250}));
    const auto &empty = contents.pieces[contents.pieces[0].name == "a" ? 1 : 0];
    EXPECT_EQ(empty.walls, -1);
    EXPECT_EQ(empty.length_ms, 0);
    EXPECT_EQ(archive_.recordings("a.lcm").pieces.size(), 1U) << "the one that is being made";
}

TEST_F(ArchiveOfTwo, WhatHasChangedIsLookedUpAnew)
{
    files::write(recordings_ + "/a.lcm", "");
    EXPECT_EQ(archive_.recordings("").pieces[0].walls, -1);
    record("a.lcm");
    EXPECT_EQ(archive_.recordings("").pieces[0].walls, 2);
}

TEST_F(ArchiveOfTwo, ListsAHundredAndCountsTheRest)
{
    for (int k = 0; k < 105; k++) {
        files::write(recordings_ + "/" + std::to_string(k) + ".lcm", "");
    }
    const Contents contents = archive_.recordings("");
    EXPECT_EQ(contents.pieces.size(), Archive::most_listed);
    EXPECT_EQ(contents.more, 5U);
}

TEST_F(ArchiveOfTwo, SavedMapsAreListedAndThoseThatAreNoneToo)
{
    char error[ALE_MAP_FILE_ERROR];
    ASSERT_EQ(ale_map_file_save((maps_ + "/flat.map").c_str(), map_of({wall(0, 0, 2, 0)}).get(), error), 0);
    files::write(maps_ + "/broken.map", "no map");
    const Contents contents = archive_.maps();
    ASSERT_EQ(contents.pieces.size(), 2U);
    EXPECT_EQ(std::max(contents.pieces[0].walls, contents.pieces[1].walls), 1);
    EXPECT_EQ(std::min(contents.pieces[0].walls, contents.pieces[1].walls), -1);
    EXPECT_NE(text_of("/maps/flat.geojson").find("LineString"), std::string::npos);
    EXPECT_FALSE(archive_.fetch(*wanted_of("/maps/none.png")));
    EXPECT_THROW(archive_.fetch(*wanted_of("/maps/broken.png")), std::runtime_error);
}

TEST_F(ArchiveOfTwo, EachMapInEachFormatAndARecordingAsItIs)
{
    record("a.lcm");
    board_.keep_map(map_of({wall(0, 0, 3, 0)}));
    board_.extend_trail({1, 1, true});
    for (const char *path : {"/recordings/a", "/live/map"}) {
        const std::string stem = path;
        EXPECT_EQ(text_of(stem + ".png").substr(1, 3), "PNG");
        EXPECT_NE(text_of(stem + ".svg").find("<svg"), std::string::npos);
        EXPECT_NE(text_of(stem + ".dxf").find("WALLS"), std::string::npos);
        EXPECT_NE(text_of(stem + ".geojson").find("FeatureCollection"), std::string::npos);
        const std::string zip = text_of(stem + ".zip");
        EXPECT_EQ(zip.substr(0, 2), "PK");
        EXPECT_NE(zip.find("image: " + stem.substr(stem.rfind('/') + 1) + ".pgm"), std::string::npos);
    }
    const auto log = archive_.fetch(*wanted_of("/recordings/a.lcm"));
    ASSERT_TRUE(log);
    EXPECT_GE(log->file.number(), 0);
    EXPECT_EQ(log->bytes, std::filesystem::file_size(recordings_ + "/a.lcm"));
}

TEST_F(ArchiveOfTwo, WhatIsNotThereIsNotThere)
{
    EXPECT_FALSE(archive_.fetch(*wanted_of("/live/map.png"))) << "none heard yet";
    for (const char *path :
         {"/recordings/none.lcm", "/recordings/none.png", "/recordings/../maps/flat.lcm"}) {
        EXPECT_FALSE(archive_.fetch(*wanted_of(path))) << path;
    }
}

TEST(Archive, FoldersThatAreNotGivenAreEmpty)
{
    const Board board;
    const Shelf none("", ".lcm");
    const Archive::Shelves nothing{none, none, none, none};
    Archive archive(board, nothing);
    EXPECT_TRUE(archive.recordings("").folder.empty());
    EXPECT_TRUE(archive.flights().pieces.empty());
    EXPECT_TRUE(archive.maps().pieces.empty());
}

TEST(Archive, AFolderThatCannotBeReadIsTold)
{
    const files::TemporaryFolder root;
    const std::string file = (root / "file").string();
    files::write(file, "");
    const Board board;
    const Shelf shelf(file, ".lcm");
    const Archive::Shelves shelves{shelf, shelf, shelf, shelf};
    Archive archive(board, shelves);
    EXPECT_EQ(archive.recordings("").trouble, file + ": Not a directory");
}

TEST(Archive, AThumbnailHasTheLongestWallsAndKeepsItsSides)
{
    EXPECT_TRUE(thumbnail_of(*map_of({})).empty());
    EXPECT_EQ(thumbnail_of(*map_of({wall(1, 1, 1, 2), wall(-1, 1, 3, 1)})),
              (Thumbnail{0, 0, 1000, 0, 500, 0, 500, 250}));
    auto many = std::make_unique<ale_map_t>();
    for (int k = 0; k < 500; k++) {
        many->line[many->line_count++] = wall(0, k, 1 + k % 7, k);
    }
    EXPECT_EQ(thumbnail_of(*many).size(), 4U * 120U);
}
