// Whole explorations in a closed loop with the simulator, scored by geometry alone. One run again:
// build/bin/ale-explore --world tools/lab/worlds/NAME.world --seed N --map map.png
#include <cstdlib>
#include <tuple>

#include <gtest/gtest.h>

#include "lab/explore/closed_loop.h"
#include "lab/explore/options.h"
#include "lab/explore/score.h"

namespace
{

class Exploration : public ::testing::TestWithParam<std::tuple<const char *, int>>
{
};

TEST_P(Exploration, maps_all_that_can_be_reached_hits_nothing_and_comes_back)
{
    const auto [name, seed] = GetParam();
    const sim::World world = sim::load_world(std::string("tools/lab/worlds/") + name + ".world");
    const ale_config_t config = ale_config_default();
    sim::WorldSource::Options source;
    source.journey.seed = static_cast<uint64_t>(seed);
    source.journey.slip = sim::driven_slip;
    source.journey.collision_radius = config.robot.width_um * 5e-7;
    explore::ClosedLoop loop(world, source, config);
    loop.run(900);
    ASSERT_TRUE(loop.finished()) << "after " << loop.seconds() << " s";
    EXPECT_EQ(loop.collisions(), 0u);
    const explore::Score score =
        explore::score(world, 2 * source.journey.collision_radius,
                       [&](sim::Point p) { return explore::said_of(loop.explorer().grid, p); });
    EXPECT_GE(score.mapped, 0.98);
    EXPECT_LE(score.wrong, 0.01);
    const sim::Pose last = loop.truth().back();
    const double off = sim::distance({last.x, last.y}, {world.start.x, world.start.y});
    EXPECT_LE(off, explore::farthest_off);
}

// One drive a world, three of them with ALE_LONG_TESTS=1 (make test-all).
int drives()
{
    return std::getenv("ALE_LONG_TESTS") ? 3 : 1;
}

INSTANTIATE_TEST_SUITE_P(Worlds, Exploration,
                         ::testing::Combine(::testing::Values("apartment", "office", "arena"),
                                            ::testing::Range(1, 1 + drives())));

} // namespace
