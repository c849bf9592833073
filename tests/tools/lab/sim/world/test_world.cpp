// World files: what they may hold, and errors that name file and line.
#include <gtest/gtest.h>

#include <sstream>
#include <stdexcept>

#include "files.hpp"
#include "lab/sim/world/world.h"

namespace
{

sim::World parsed(const std::string &text)
{
    std::istringstream in(text);
    return sim::parse_world(in, "plan");
}

std::string error_of(const std::string &text)
{
    try {
        parsed(text);
    } catch (const std::runtime_error &error) {
        return error.what();
    }
    return "";
}

TEST(World, holds_people_who_walk)
{
    const sim::World world = parsed("0 0 1 0\n# walker 0.8 4.5 1 2 3 4 5 6\n");
    ASSERT_EQ(world.walkers.size(), 1u);
    EXPECT_EQ(world.walkers[0].speed_m_s, 0.8);
    EXPECT_EQ(world.walkers[0].rest_s, 4.5);
    ASSERT_EQ(world.walkers[0].path.size(), 3u);
    EXPECT_EQ(world.walkers[0].path[2].y, 6);
    EXPECT_EQ(error_of("0 0 1 0\n# walker 1 0 1 2\n"),
              "plan:2: expected \"# walker speed rest x1 y1 x2 y2 ..\"");
    EXPECT_EQ(error_of("0 0 1 0\n# walker 1 0 1 2 3 4 5\n"),
              "plan:2: expected \"# walker speed rest x1 y1 x2 y2 ..\"");
    EXPECT_EQ(error_of("# walker 0 0 1 2 3 4\n"),
              "plan:1: a walker's speed is above 0, the rest not below 0");
    EXPECT_EQ(error_of("# walker 1 0 1 2 1 2\n"), "plan:1: two points of the walker's way are the same");
}

TEST(World, holds_walls_start_way_and_mounting)
{
    const sim::World world =
        parsed("# a plan\n0 0 1e0 0\n\n# start 0.5 -0.25 1.5\n# via 1 2\n#via is a comment\n"
               "# via 3 4\n# sensor 0.1 0 -0.5\n1 0 1 -2.5\n");
    ASSERT_EQ(world.walls.size(), 2u);
    EXPECT_EQ(world.walls[1].b.y, -2.5);
    EXPECT_EQ(world.start.y, -0.25);
    ASSERT_EQ(world.via.size(), 2u);
    EXPECT_EQ(world.via[1].x, 3);
    EXPECT_EQ(world.sensor.theta, -0.5);
}

TEST(World, without_directives_the_robot_stands_at_the_origin)
{
    const sim::World world = parsed("0 0 1 0\n");
    EXPECT_EQ(world.start.x, 0);
    EXPECT_EQ(world.start.theta, 0);
    EXPECT_TRUE(world.via.empty());
}

TEST(World, errors_name_file_line_and_what)
{
    EXPECT_EQ(error_of("0 0 1 0\n0 0 1\n"), "plan:2: expected \"x1 y1 x2 y2\"");
    EXPECT_EQ(error_of("0 0 1 0 5\n"), "plan:1: expected \"x1 y1 x2 y2\"");
    EXPECT_EQ(error_of("\n0 zero 1 0\n"), "plan:2: \"zero\" is not a number");
    EXPECT_EQ(error_of("0 0 1 nan\n"), "plan:1: \"nan\" is not a number");
    EXPECT_EQ(error_of("0 0 1 1e300\n"), "plan:1: \"1e300\" is too large (metres are meant)");
    EXPECT_EQ(error_of("1 1 1 1\n"), "plan:1: the wall has no length");
    EXPECT_EQ(error_of("0 0 1 0\n# via 1\n"), "plan:2: expected \"# via x y\"");
    EXPECT_EQ(error_of("0 0 1 0\n# start 1 2\n"), "plan:2: expected \"# start x y theta\"");
    EXPECT_EQ(error_of("# nothing\n"), "plan: no wall in it");
    EXPECT_EQ(error_of(""), "plan: no wall in it");
}

std::string refusal_of(const std::string &path)
{
    try {
        sim::load_world(path);
        return "";
    } catch (const std::runtime_error &error) {
        return error.what();
    }
}

TEST(World, a_file_that_cannot_be_read_is_named)
{
    EXPECT_EQ(refusal_of("no/such/plan"), "no/such/plan: No such file or directory");
    EXPECT_EQ(refusal_of("tools/lab/worlds"), "tools/lab/worlds: is a directory");
}

TEST(World, a_file_without_end_is_refused_before_it_takes_the_memory)
{
    const files::TemporaryFolder folder;
    const std::filesystem::path huge = folder / "huge.world";
    std::ofstream(huge) << "0 0 1 0\n";
    EXPECT_EQ(refusal_of(huge), "");
    std::filesystem::resize_file(huge, (16U << 20) + 1);
    EXPECT_EQ(refusal_of(huge), huge.string() + ": too large");
    EXPECT_EQ(refusal_of("/dev/zero"), "/dev/zero: no regular file");
}

} // namespace
