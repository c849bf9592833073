#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <png.h>

#include "common/export/map_image.h"
#include "files.hpp"

extern "C" {
#include "base/trig.h"
}

namespace
{

using namespace ale;
using files::content;

constexpr int32_t metre = 1000000;

struct Picture {
    png_uint_32 width = 0;
    png_uint_32 height = 0;
    std::vector<uint8_t> rgb;

    int darkness(size_t x, size_t y) const
    {
        const size_t at = 3 * (y * width + x);
        return 3 * 255 - rgb[at] - rgb[at + 1] - rgb[at + 2];
    }
};

Picture read_png(const std::filesystem::path &path)
{
    Picture picture;
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    EXPECT_TRUE(png_image_begin_read_from_file(&image, path.c_str()));
    image.format = PNG_FORMAT_RGB;
    picture.rgb.resize(PNG_IMAGE_SIZE(image));
    EXPECT_TRUE(png_image_finish_read(&image, nullptr, picture.rgb.data(), 0, nullptr));
    picture.width = image.width;
    picture.height = image.height;
    return picture;
}

/* A room of 4 m by 2 m, its lower left corner at (-1, -1), and a short way through it. */
class MapImage : public testing::Test
{
  protected:
    void SetUp() override
    {
        const ale_point_t corner[4] = {
            {-metre, -metre}, {3 * metre, -metre}, {3 * metre, metre}, {-metre, metre}};
        for (int i = 0; i < 4; i++) {
            map_->line[i].start = corner[i];
            map_->line[i].end = corner[(i + 1) % 4];
            map_->corner[i].p = corner[i];
        }
        map_->line_count = 4;
        map_->corner_count = 4;
        scene_.map = map_.get();
        scene_.trajectory = {{0, {0, 0, 0}}, {100000, {metre, 0, 0}}, {200000, {2 * metre, 500000, 0}}};
    }
    std::filesystem::path write(const std::string &name)
    {
        write_map_image(folder_ / name, scene_);
        return folder_ / name;
    }

    const files::TemporaryFolder folder_;
    std::unique_ptr<ale_map_t> map_ = std::make_unique<ale_map_t>();
    MapScene scene_;
};

TEST_F(MapImage, ThePngHasTheMapsShapeWithWallsWhereTheyAre)
{
    const Picture picture = read_png(write("map.png"));
    EXPECT_EQ(picture.width, 1600U) << "1500 pixels for four metres, and margins";
    EXPECT_EQ(picture.height, 750U + 160U);
    EXPECT_EQ(picture.darkness(3, 3), 0) << "white background";
    EXPECT_GT(picture.darkness(50, 300), 600) << "left wall";
    EXPECT_GT(picture.darkness(1549, 300), 600) << "right wall";
    EXPECT_GT(picture.darkness(300, 50), 600) << "upper wall";
    EXPECT_GT(picture.darkness(300, 800), 600) << "lower wall";
    EXPECT_LT(picture.darkness(200, 200), 100) << "inside";
    const size_t path = 3 * (425 * picture.width + 600);
    EXPECT_GT(picture.rgb[path], picture.rgb[path + 2]) << "the way is reddish";
}

TEST_F(MapImage, WallsAreSmoothToAQuarterOfAPixel)
{
    map_->line_count = 1;
    map_->corner_count = 0;
    map_->line[0] = {};
    map_->line[0].start = {-metre, -metre};
    map_->line[0].end = {3 * metre, metre};
    scene_.trajectory.clear();
    const Picture picture = read_png(write("slant.png"));
    for (size_t x = 100; x < 1500; x += 7) {
        double weight = 0;
        double centre = 0;
        for (size_t y = 20; y < 840; y++) {
            const int dark = picture.darkness(x, y) > 200 ? picture.darkness(x, y) : 0;
            weight += dark;
            centre += dark * (static_cast<double>(y) + 0.5);
        }
        const double expected = 50 + 750 - (static_cast<double>(x) + 0.5 - 50) / 2;
        ASSERT_NEAR(centre / weight, expected, 0.25) << "column " << x;
    }
}

TEST_F(MapImage, AnEmptyMapIsAnEmptyPicture)
{
    map_->line_count = 0;
    map_->corner_count = 0;
    scene_.trajectory.clear();
    for (const char *name : {"empty.png", "empty.svg", "empty.dxf", "empty.pgm"}) {
        EXPECT_GT(std::filesystem::file_size(write(name)), 50U) << name;
    }
}

TEST_F(MapImage, AMapOfASinglePointIsDrawnWhereverItLies)
{
    map_->line_count = 0;
    map_->corner_count = 0;
    for (const int32_t at : {0, INT32_MAX, INT32_MIN}) {
        scene_.trajectory = {{0, {at, at, 0}}};
        for (const char *name : {"point.png", "point.svg", "point.dxf", "point.pgm"}) {
            EXPECT_GT(std::filesystem::file_size(write(name)), 50U) << name << " at " << at;
        }
    }
}

TEST_F(MapImage, TheSameSceneGivesTheSameBytes)
{
    for (const char *extension : {".png", ".svg", ".dxf", ".pgm"}) {
        EXPECT_EQ(content(write(std::string("a") + extension)), content(write(std::string("b") + extension)));
    }
}

TEST_F(MapImage, TheSvgIsInMetresWithYUpwards)
{
    const std::string svg = content(write("map.svg"));
    EXPECT_NE(svg.find("width=\"1600\" height=\"977\" viewBox=\"-1.16 -1.16 4.32 2.64\""), std::string::npos)
        << svg.substr(0, 200);
    EXPECT_NE(svg.find("<path d=\"M-1 1L3 1\"/>"), std::string::npos) << "lower wall: y of the page is -y";
    EXPECT_NE(svg.find("M0 0L1 0L2 -0.5"), std::string::npos) << "trajectory";
    EXPECT_NE(svg.find(">0.5 m</text>"), std::string::npos) << "scale bar";
    EXPECT_EQ(svg.substr(svg.size() - 7), "</svg>\n");
}

TEST_F(MapImage, TheDxfIsPairsOfLinesWithOneLineAWall)
{
    std::istringstream dxf(content(write("map.dxf")));
    std::string code;
    std::string value;
    std::vector<std::string> names;
    int walls = 0;
    int points = 0;
    int ways = 0;
    int places = 0;
    int sections = 0;
    std::string last_entity;
    std::vector<std::string> first_wall;
    while (std::getline(dxf, code)) {
        ASSERT_TRUE(std::getline(dxf, value)) << "a group code without value";
        ASSERT_EQ(code.find_first_not_of("0123456789"), std::string::npos) << code;
        if (code == "0") {
            last_entity = value;
            sections += (value == "SECTION") - (value == "ENDSEC");
        }
        walls += code == "8" && value == "WALLS" && last_entity == "LINE";
        points += code == "8" && value == "CORNERS" && last_entity == "POINT";
        ways += code == "0" && value == "POLYLINE";
        places += code == "8" && value == "TRAJECTORY" && last_entity == "VERTEX";
        if (last_entity == "LINE" && walls == 1 && code.size() == 2) {
            first_wall.push_back(value);
        }
    }
    EXPECT_EQ(walls, 4);
    EXPECT_EQ(points, 4);
    EXPECT_EQ(ways, 1) << "the way is one polyline";
    EXPECT_EQ(places, 3);
    EXPECT_EQ(sections, 0) << "every section ends";
    EXPECT_EQ(value, "EOF");
    EXPECT_EQ(first_wall, (std::vector<std::string>{"-1", "-1", "0", "3", "-1", "0"}));
}

/* The left wall is in another map. */
TEST_F(MapImage, WallsOfAMapThatIsNotJoinedHaveAnotherColour)
{
    const std::string joined_svg = content(write("joined.svg"));
    EXPECT_EQ(joined_svg.find(">not joined<"), std::string::npos);
    EXPECT_EQ(content(write("joined.dxf")).find("\n62\n6\n"), std::string::npos);
    const Picture joined = read_png(write("joined.png"));
    map_->line[3].map_id = 2;
    const Picture picture = read_png(write("apart.png"));
    const auto blueness = [](const Picture &p, size_t x, size_t y) {
        const size_t at = 3 * (y * p.width + x);
        return p.rgb[at + 2] - p.rgb[at + 1];
    };
    EXPECT_LT(blueness(joined, 50, 300), 40);
    EXPECT_GT(blueness(picture, 50, 300), 80) << "the left wall";
    EXPECT_LT(blueness(picture, 1549, 300), 40) << "the right wall is as before";
    const std::string svg = content(write("apart.svg"));
    const std::string apart =
        svg.substr(svg.find("<g id=\"apart\""), svg.find("<g id=\"walls\"") - svg.find("<g id=\"apart\""));
    EXPECT_NE(apart.find("M-1 -1L-1 1"), std::string::npos) << apart;
    EXPECT_EQ(apart.find("M-1 1L3 1"), std::string::npos) << apart;
    EXPECT_NE(svg.find(">not joined</text>"), std::string::npos);
    EXPECT_NE(content(write("apart.dxf")).find("LINE\n8\nWALLS\n62\n6\n10\n"), std::string::npos);
}

/* The right wall is new, half of the upper one moved, and a wall across the room is gone. */
TEST_F(MapImage, WhatHasChangedIsColouredAndItsMetresAreSaid)
{
    EXPECT_EQ(content(write("same.svg")).find("added"), std::string::npos);
    scene_.trajectory.clear();
    scene_.changes = {{WallChange::added, map_->line[1].start, map_->line[1].end},
                      {WallChange::moved, {metre, metre}, {-metre, metre}},
                      {WallChange::gone, {metre / 2, -metre}, {metre / 2, metre / 2}}};
    const std::string svg = content(write("changed.svg"));
    EXPECT_NE(svg.find("<g id=\"added\""), std::string::npos);
    EXPECT_NE(svg.find("M0.5 1L0.5 -0.5"), std::string::npos);
    for (const char *words : {">new 2 m<", ">moved 2 m<", ">gone 1.5 m<"}) {
        EXPECT_NE(svg.find(words), std::string::npos) << words;
    }
    const Picture picture = read_png(write("changed.png"));
    const auto colour = [&](size_t x, size_t y) {
        const uint8_t *at = &picture.rgb[3 * (y * picture.width + x)];
        return std::array<int, 3>{at[0], at[1], at[2]};
    };
    EXPECT_EQ(colour(1550, 425), (std::array<int, 3>{38, 150, 84})) << "new: green";
    EXPECT_EQ(colour(425, 50), (std::array<int, 3>{240, 146, 20})) << "moved: amber";
    EXPECT_EQ(colour(612, 600), (std::array<int, 3>{214, 48, 49})) << "gone: red";
    const auto red_in_footer = [&] {
        size_t count = 0;
        for (size_t x = 0; x < picture.width; x++) {
            for (size_t y = picture.height - 80; y < picture.height; y++) {
                count += colour(x, y) == std::array<int, 3>{214, 48, 49} ? 1 : 0;
            }
        }
        return count;
    };
    EXPECT_GT(red_in_footer(), 50U) << "the legend";
}

struct Grid {
    int columns = 0;
    int rows = 0;
    std::string value;
    double origin_x = 0;
    double origin_y = 0;
    double resolution = 0;

    int at(double x, double y) const
    {
        const int column = static_cast<int>((x - origin_x) / resolution);
        const int row = rows - 1 - static_cast<int>((y - origin_y) / resolution);
        return static_cast<unsigned char>(value[static_cast<size_t>(row * columns + column)]);
    }
};

Grid read_grid(const std::filesystem::path &path)
{
    Grid grid;
    std::istringstream pgm(content(path));
    std::string magic;
    int most = 0;
    pgm >> magic >> grid.columns >> grid.rows >> most;
    pgm.get();
    grid.value.assign(std::istreambuf_iterator<char>(pgm), {});
    EXPECT_EQ(magic, "P5");
    EXPECT_EQ(most, 255);
    EXPECT_EQ(grid.value.size(), static_cast<size_t>(grid.columns * grid.rows));
    const std::string yaml = content(std::filesystem::path(path).replace_extension(".yaml"));
    EXPECT_NE(yaml.find("image: " + path.filename().string() + "\n"), std::string::npos);
    EXPECT_EQ(std::sscanf(yaml.c_str() + yaml.find("resolution"), "resolution: %lf", &grid.resolution), 1);
    EXPECT_EQ(
        std::sscanf(yaml.c_str() + yaml.find("origin"), "origin: [%lf, %lf", &grid.origin_x, &grid.origin_y),
        2);
    return grid;
}

/* The room as a scanner in it sees it, exactly. */
ale_scan_t scan_of_room(double x, double y)
{
    ale_scan_t scan{};
    scan.beams = 1000;
    scan.range_max_um = 30 * metre;
    scan.step_bam = 4294967;
    for (uint16_t k = 0; k < scan.beams; k++) {
        const double bearing = ale_scan_bearing(&scan, k) * (2 * M_PI / 4294967296.0);
        const double dx = std::cos(bearing);
        const double dy = std::sin(bearing);
        const double to_x = dx > 0 ? (3 - x) / dx : (-1 - x) / dx;
        const double to_y = dy > 0 ? (1 - y) / dy : (-1 - y) / dy;
        const double range = std::min(std::abs(dx) > 1e-9 ? to_x : 1e9, std::abs(dy) > 1e-9 ? to_y : 1e9);
        ale_scan_set_range(&scan, k, static_cast<int32_t>(std::lround(range * 1e6)));
    }
    return scan;
}

TEST_F(MapImage, TheGridTellsWallsFreeAndUnknownAsMapServerReadsThem)
{
    ScanCloud cloud;
    for (int i = 0; i < 4; i++) {
        const int32_t x_um = i * 300000;
        cloud.add(scan_of_room(i * 0.3, 0.1), {0, {x_um, 100000, 0}, 0, 0, 0, true}, {});
    }
    scene_.cloud = &cloud;
    const Grid grid = read_grid(write("map.pgm"));
    EXPECT_DOUBLE_EQ(grid.resolution, 0.05);
    EXPECT_EQ(grid.at(0.01, -0.999), 0) << "lower wall";
    EXPECT_EQ(grid.at(3.001, 0.51), 0) << "right wall";
    EXPECT_EQ(grid.at(1.01, 0.51), 254) << "inside";
    EXPECT_EQ(grid.at(-1.3, 0.01), 205) << "outside";
}

TEST_F(MapImage, TheGridHasTheCellsOfTheCloud)
{
    ScanCloud cloud(20000);
    cloud.add(scan_of_room(0, 0.1), {0, {0, 100000, 0}, 0, 0, 0, true}, {});
    cloud.add(scan_of_room(0.3, 0.1), {0, {300000, 100000, 0}, 0, 0, 0, true}, {});
    scene_.cloud = &cloud;
    const Grid grid = read_grid(write("map.pgm"));
    EXPECT_DOUBLE_EQ(grid.resolution, 0.02);
    EXPECT_EQ(grid.at(3.001, 0.51), 0) << "right wall";
    EXPECT_EQ(grid.at(1.01, 0.51), 254) << "inside";
}

TEST_F(MapImage, ACloudThatKeepsNoPointsShowsTheSameGrid)
{
    ScanCloud whole;
    ScanCloud cells(ScanCloud::usual_cell_um, ScanCloud::Points::left_out);
    EXPECT_TRUE(cells.empty());
    for (ScanCloud *cloud : {&whole, &cells}) {
        for (int i = 0; i < 4; i++) {
            cloud->add(scan_of_room(i * 0.3, 0.1), {0, {i * 300000, 100000, 0}, 0, 0, 0, true}, {});
        }
    }
    EXPECT_TRUE(cells.points().empty());
    EXPECT_FALSE(cells.empty());
    EXPECT_EQ(cells.tiles(), whole.tiles());
    scene_.cloud = &whole;
    const std::string with_points = content(write("whole.pgm"));
    scene_.cloud = &cells;
    EXPECT_EQ(content(write("cells.pgm")), with_points);
    EXPECT_NEAR(cells.extent().right_um, 3 * metre, 1000) << "the right wall";
}

TEST_F(MapImage, WithoutScansOnlyWallsAreKnown)
{
    const Grid grid = read_grid(write("map.pgm"));
    EXPECT_EQ(grid.at(0.01, -0.999), 0);
    EXPECT_EQ(grid.at(1.01, 0.51), 205);
}

TEST_F(MapImage, PointsAreDrawnWhenAskedForAndWidenThePicture)
{
    ScanCloud cloud;
    cloud.add(scan_of_room(0, 0), {0, {10 * metre, 0, 0}, 0, 0, 0, true}, {});
    scene_.cloud = &cloud;
    const Picture without = read_png(write("without.png"));
    scene_.draw_points = true;
    const Picture with = read_png(write("with.png"));
    EXPECT_NE(with.height, without.height);
    EXPECT_NE(content(write("with.svg")).find("id=\"points\""), std::string::npos);
}

TEST_F(MapImage, AGlimpseFarAwayDoesNotWidenThePicture)
{
    ScanCloud cloud;
    ScanCloud with_glimpse;
    const ScanPose pose = {0, {10 * metre, 0, 0}, 0, 0, 0, true};
    ale_scan_t room = scan_of_room(0, 0);
    cloud.add(room, pose, {});
    ASSERT_GT(cloud.points().size(), 200U);
    ale_scan_set_range(&room, 0, 25 * metre);
    with_glimpse.add(room, pose, {});
    scene_.draw_points = true;
    scene_.cloud = &cloud;
    const Picture without = read_png(write("without.png"));
    scene_.cloud = &with_glimpse;
    const Picture with = read_png(write("with.png"));
    EXPECT_EQ(with.height, without.height);
    EXPECT_EQ(with.width, without.width);
}

TEST_F(MapImage, BeamsOfAMovingScannerAreLaidOutAtTheirOwnTime)
{
    ale_scan_t scan{};
    scan.beams = 2;
    scan.beam_time_ns = 50000000; /* the second beam comes 50 ms later */
    scan.range_max_um = 30 * metre;
    ale_scan_set_range(&scan, 0, 2 * metre);
    ale_scan_set_range(&scan, 1, 2 * metre);
    ScanCloud cloud;
    cloud.add(scan, {0, {0, 0, 0}, metre, 0, 2 * metre, true}, {100000, 0, 0}); /* 1 m/s, 2 rad/s */
    ASSERT_EQ(cloud.points().size(), 2U);
    EXPECT_NEAR(cloud.points()[0].x_um, 2100000, 5);
    EXPECT_NEAR(cloud.points()[1].x_um, 50000 + 2100000 * std::cos(0.1), 5);
    EXPECT_NEAR(cloud.points()[1].y_um, 2100000 * std::sin(0.1), 5);
}

TEST_F(MapImage, NamesAndPlacesThatCannotBeAreRefused)
{
    EXPECT_TRUE(is_map_image_name("a/b.svg"));
    EXPECT_FALSE(is_map_image_name("a.jpeg"));
    EXPECT_FALSE(is_map_image_name(".png"));
    EXPECT_THROW(write("map.jpeg"), std::runtime_error);
    for (const char *name : {"no/such/a.png", "no/such/a.svg", "no/such/a.dxf", "no/such/a.pgm"}) {
        EXPECT_THROW(write(name), std::runtime_error) << name;
    }
}

TEST(Scale, BarAndMeshSuitTheSize)
{
    EXPECT_EQ(scale_of({0, 0, 12 * metre, 8 * metre}).mesh_um, metre);
    EXPECT_EQ(scale_of({0, 0, 12 * metre, 8 * metre}).bar_um, 2 * metre);
    EXPECT_EQ(scale_of({0, 0, 250 * metre, 8 * metre}).mesh_um, 20 * metre);
    EXPECT_EQ(length_label(500000), "0.5 m");
    EXPECT_EQ(length_label(20 * metre), "20 m");
}

TEST_F(MapImage, GeoJsonHasAFeatureForEachWallCornerAndTheWayInMetres)
{
    map_->line[1].id = 77;
    map_->line[1].seen = 12;
    map_->line[1].map_id = 3;
    const nlohmann::json json = nlohmann::json::parse(content(write("map.geojson")));
    EXPECT_EQ(json["type"], "FeatureCollection");
    const auto &features = json["features"];
    ASSERT_EQ(features.size(), 9U) << "four walls, four corners, one way";
    EXPECT_EQ(features[1]["geometry"]["type"], "LineString");
    EXPECT_EQ(features[1]["geometry"]["coordinates"], nlohmann::json::parse("[[3,-1],[3,1]]"));
    EXPECT_EQ(features[1]["properties"],
              nlohmann::json::parse(R"({"kind":"wall","id":77,"seen":12,"map_id":3})"));
    EXPECT_EQ(features[4]["geometry"], nlohmann::json::parse(R"({"type":"Point","coordinates":[-1,-1]})"));
    EXPECT_EQ(features[8]["geometry"]["coordinates"], nlohmann::json::parse("[[0,0],[1,0],[2,0.5]]"));
    EXPECT_EQ(features[8]["properties"]["kind"], "way");
}

} // namespace
