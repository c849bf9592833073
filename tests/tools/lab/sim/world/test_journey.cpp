// The drive: limits are kept, nothing is hit, wheels err as they say, and the seed decides all of it.
#include <gtest/gtest.h>

#include <algorithm>

#include "lab/sim/world/world_source.h"

namespace
{

constexpr int64_t ms = 1000;

class BundledWorld : public ::testing::TestWithParam<const char *>
{
};

double clearance(const sim::World &world, const sim::Pose &robot)
{
    double nearest = 1e9;
    for (const sim::Wall &wall : world.walls) {
        nearest = std::min(nearest, sim::distance_to_wall({robot.x, robot.y}, wall));
    }
    return nearest;
}

TEST_P(BundledWorld, the_way_keeps_clear_of_walls_and_within_the_limits_and_ends)
{
    const sim::World world = sim::load_world(std::string("tools/lab/worlds/") + GetParam() + ".world");
    sim::Journey::Options options;
    sim::Journey journey(world, options, sim::route_pilot(world, options.limits));
    sim::Pose before = journey.truth(0);
    const int64_t longest = 600000 * ms;
    for (int64_t t = 10 * ms; !journey.end_us() && t < longest; t += 10 * ms) {
        const sim::Pose now = journey.truth(t);
        const double step = sim::distance({now.x, now.y}, {before.x, before.y});
        ASSERT_LE(step, options.limits.speed * 0.01 + 1e-9) << t;
        ASSERT_LE(std::fabs(now.theta - before.theta), options.limits.turn_rate * 0.01 + 1e-9) << t;
        ASSERT_GE(clearance(world, now), 0.3) << "at " << now.x << ", " << now.y;
        before = now;
    }
    ASSERT_TRUE(journey.end_us());
    const sim::Point goal = world.via.back();
    EXPECT_LT(sim::distance({before.x, before.y}, goal), 0.1);
}

TEST_P(BundledWorld, no_place_of_the_way_is_featureless)
{
    const sim::World world = sim::load_world(std::string("tools/lab/worlds/") + GetParam() + ".world");
    sim::WorldSource::Options options;
    options.once = true;
    options.noise = "none";
    sim::WorldSource source(world, options);
    while (source.due_us()) {
        const sim::Event event = source.next();
        const auto *turn = std::get_if<sim::Turn>(&event);
        if (turn) {
            const auto seen = std::count_if(turn->value_mm.begin(), turn->value_mm.end(),
                                            [](int32_t value) { return value >= 20 && value <= 5600; });
            ASSERT_GE(seen, 450) << "scan " << turn->number;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(All, BundledWorld, ::testing::Values("home", "apartment", "office", "arena"));

sim::World corridor()
{
    sim::World world;
    world.walls = {{{-5, -2}, {30, -2}}, {{-5, 2}, {30, 2}}};
    world.via = {{20, 0}};
    return world;
}

TEST(Journey, the_same_seed_gives_the_same_journey_and_another_another)
{
    const sim::World world = corridor();
    sim::Journey::Options options;
    sim::Journey a(world, options, sim::route_pilot(world, options.limits));
    sim::Journey b(world, options, sim::route_pilot(world, options.limits));
    options.seed = 2;
    sim::Journey c(world, options, sim::route_pilot(world, options.limits));
    EXPECT_EQ(a.wheels(20000 * ms).y, b.wheels(20000 * ms).y);
    EXPECT_NE(a.wheels(20000 * ms).y, c.wheels(20000 * ms).y);
    EXPECT_EQ(a.truth(20000 * ms).x, c.truth(20000 * ms).x);
}

TEST(Journey, wheel_errors_have_the_size_they_are_given)
{
    const sim::World world = corridor();
    sim::Journey::Options options;
    double scale = 0;
    double heading = 0;
    const int runs = 60;
    for (int seed = 1; seed <= runs; seed++) {
        options.seed = static_cast<uint64_t>(seed);
        sim::Journey journey(world, options, sim::route_pilot(world, options.limits));
        const int64_t t = 4000 * ms;
        const double driven = journey.truth(t).x;
        const sim::Pose wheels = journey.wheels(t);
        scale += std::pow(std::hypot(wheels.x, wheels.y) / driven - 1, 2) / runs;
        heading += wheels.theta * wheels.theta / driven / runs;
    }
    EXPECT_NEAR(std::sqrt(scale), options.odometry.scale, 0.01);
    EXPECT_NEAR(std::sqrt(heading), options.odometry.turn_per_metre, 0.01);
}

TEST(Journey, a_driven_robot_is_stopped_by_walls_and_counts_the_collision_once)
{
    sim::World world;
    world.walls = {{{2, -5}, {2, 5}}};
    sim::Journey::Options options;
    options.collision_radius = 0.2;
    sim::Journey journey(world, options, [](const sim::Robot &, int64_t) {
        return std::optional(sim::Twist{0.5, 0});
    });
    EXPECT_NEAR(journey.truth(20000 * ms).x, 1.8, 0.002);
    EXPECT_EQ(journey.collisions(), 1u);
    EXPECT_GT(journey.wheels(20000 * ms).x, 1.9) << "the wheels go on turning against the wall";
}

TEST(Journey, speed_is_taken_up_as_the_mass_allows)
{
    const sim::World world = corridor();
    sim::Journey::Options options;
    sim::Journey journey(world, options, [](const sim::Robot &, int64_t) {
        return std::optional(sim::Twist{9, 0});
    });
    EXPECT_NEAR(journey.truth(1000 * ms).x, 0.25, 0.002) << "half of a t^2 with 0.5 m/s^2";
    EXPECT_NEAR(journey.truth(3000 * ms).x - journey.truth(2000 * ms).x, 0.5, 1e-9);
}

TEST(Journey, slip_makes_the_wheels_run_ahead)
{
    const sim::World world = corridor();
    sim::Journey::Options options;
    options.odometry = {0, 0, 0};
    options.slip = 0.1;
    sim::Journey journey(world, options, sim::route_pilot(world, options.limits));
    const double driven = journey.truth(20000 * ms).x;
    EXPECT_GT(journey.wheels(20000 * ms).x, driven * 1.03);
}

} // namespace
