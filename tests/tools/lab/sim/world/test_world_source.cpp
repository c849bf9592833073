// What the simulated scanner sees: geometry, the bend that motion gives a scan, noise, determinism.
#include <gtest/gtest.h>

#include <cmath>

#include "lab/sim/world/world_source.h"

namespace
{

sim::World box()
{
    sim::World world;
    world.walls = {{{-1, -2}, {3, -2}}, {{3, -2}, {3, 1}}, {{3, 1}, {-1, 1}}, {{-1, 1}, {-1, -2}}};
    return world;
}

sim::Turn turn_number(sim::WorldSource &source, uint32_t number)
{
    for (;;) {
        const sim::Event event = source.next();
        const auto *turn = std::get_if<sim::Turn>(&event);
        if (turn && turn->number == number) {
            return *turn;
        }
    }
}

sim::Pilot turning(double rate)
{
    return [rate](const sim::Robot &, int64_t) { return std::optional(sim::Twist{0, rate}); };
}

sim::WorldSource::Options options_of(const char *noise)
{
    sim::WorldSource::Options options;
    options.noise = noise;
    return options;
}

TEST(WorldSource, ranges_are_in_the_steps_of_their_bearings)
{
    sim::WorldSource source(box(), options_of("none"));
    const sim::Turn turn = turn_number(source, 0);
    ASSERT_EQ(turn.value_mm.size(), 769u);
    EXPECT_EQ(turn.value_mm[384], 3000) << "ahead";
    EXPECT_EQ(turn.value_mm[640], 1000) << "left";
    EXPECT_EQ(turn.value_mm[128], 2000) << "right";
    EXPECT_EQ(turn.value_mm[43], 19) << "outside the field of view";
    EXPECT_EQ(turn.value_mm[726], 19);
}

TEST(WorldSource, the_mounting_moves_and_turns_the_scanner)
{
    sim::World world = box();
    world.sensor = {0.5, 0.25, sim::pi / 2};
    sim::WorldSource source(world, options_of("none"));
    const sim::Turn turn = turn_number(source, 0);
    EXPECT_EQ(turn.value_mm[384], 750);
    EXPECT_EQ(turn.value_mm[128], 2500);
}

TEST(WorldSource, a_turning_robot_bends_its_scans_by_the_time_of_each_beam)
{
    const double rate = 0.9;
    sim::WorldSource source(box(), options_of("none"), turning(rate));
    const sim::Turn turn = turn_number(source, 20); // 2 s: turning steadily
    const sim::Pose at_stamp = *source.truth(turn.start_us);
    double worst_bent = 0;
    double worst_straight = 0;
    for (int32_t step = 44; step <= 725; step++) {
        const double bearing = (step - 384) * 2 * sim::pi / 1024;
        const double moved = rate * 0.1 * step / 1024;
        const sim::Surroundings near(box().walls, {0, 0}, 5.6);
        const double straight = near.cast({0, 0, at_stamp.theta + bearing}).range;
        const double bent = near.cast({0, 0, at_stamp.theta + bearing + moved}).range;
        const double measured = turn.value_mm[static_cast<size_t>(step)] / 1000.0;
        worst_bent = std::max(worst_bent, std::fabs(measured - bent));
        worst_straight = std::max(worst_straight, std::fabs(measured - straight));
    }
    EXPECT_LT(worst_bent, 0.0015);
    EXPECT_GT(worst_straight, 0.05);
}

TEST(WorldSource, the_seed_decides_every_value)
{
    sim::WorldSource::Options options = options_of("real");
    sim::WorldSource a(box(), options);
    sim::WorldSource b(box(), options);
    options.journey.seed = 2;
    sim::WorldSource c(box(), options);
    const auto values = turn_number(a, 3).value_mm;
    EXPECT_EQ(values, turn_number(b, 3).value_mm);
    EXPECT_NE(values, turn_number(c, 3).value_mm);
}

TEST(WorldSource, noise_has_the_size_it_is_given)
{
    sim::WorldSource source(box(), options_of("white"));
    double squares = 0;
    int count = 0;
    int failed = 0;
    for (uint32_t k = 0; k < 400; k++) {
        const sim::Turn turn = turn_number(source, k);
        const int32_t value = turn.value_mm[384];
        failed += value < 20 ? 1 : 0;
        if (value >= 20) {
            squares += (value - 3000.0) * (value - 3000.0);
            count++;
        }
    }
    EXPECT_NEAR(std::sqrt(squares / count), 21, 3) << "0.7 % of 3 m";
    EXPECT_NEAR(failed, 8, 8) << "2 % of 400";
}

TEST(WorldSource, neighbours_share_a_part_of_the_real_error)
{
    sim::WorldSource source(box(), options_of("real"));
    double together = 0;
    double alone = 0;
    for (uint32_t k = 0; k < 400; k++) {
        const sim::Turn turn = turn_number(source, k);
        const double a = turn.value_mm[380];
        const double b = turn.value_mm[381];
        const double far = turn.value_mm[340];
        if (a >= 20 && b >= 20 && far >= 20) {
            together += (a - b) * (a - b);
            alone += (a - far) * (a - far);
        }
    }
    EXPECT_LT(together * 1.5, alone) << "neighbours differ by less than beams far apart on one wall";
}

TEST(WorldSource, with_once_it_ends_a_second_after_the_way)
{
    sim::World world = box();
    world.via = {{0.5, 0}};
    sim::WorldSource::Options options = options_of("none");
    options.once = true;
    sim::WorldSource source(world, options);
    int64_t last_us = 0;
    while (source.due_us()) {
        last_us = *source.due_us();
        source.next();
    }
    EXPECT_GT(last_us, 2600000) << "1.7 s of driving, 1 s of rest";
    EXPECT_LT(last_us, 3000000);
}

TEST(WorldSource, odometry_comes_twenty_times_a_second_and_a_lag_makes_it_younger)
{
    sim::WorldSource::Options options = options_of("none");
    options.journey.odometry = {0, 0, 0};
    options.odometry_lag_us = 150000;
    sim::WorldSource source(box(), options, turning(0.5));
    int reports = 0;
    while (*source.due_us() <= 1000000) {
        const sim::Event event = source.next();
        if (const auto *report = std::get_if<sim::OdometryReport>(&event)) {
            EXPECT_NEAR(report->pose.theta, source.truth(report->stamp_us + 150000)->theta, 1e-9);
            reports++;
        }
    }
    EXPECT_EQ(reports, 21);
}

} // namespace
