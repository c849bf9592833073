// People who walk: their legs, what the scanner sees of them, and that a robot among them keeps its place.
#include <cstdlib>

#include <gtest/gtest.h>

#include "common/offline/loops.h"
#include "lab/explore/scan_of_turn.h"
#include "lab/sim/units.h"
#include "lab/sim/world/world_source.h"

extern "C" {
#include "config/config.h"
}

namespace
{

const sim::Walker to_and_fro = {1.0, 2.0, {{0, 0}, {6.5, 0}}};

TEST(Walkers, legs_take_turns_in_standing_and_stay_a_step_together)
{
    double longest_m = 0;
    int standing = 0;
    int looks = 0;
    for (double t = 0; t < 17; t += 0.01) {
        const auto now = sim::legs_of(to_and_fro, t);
        const auto next = sim::legs_of(to_and_fro, t + 0.001);
        longest_m = std::max(longest_m, std::abs(now[0].centre.x - now[1].centre.x));
        const bool rests = now[0].centre.x == next[0].centre.x && now[1].centre.x == next[1].centre.x;
        for (size_t leg = 0; leg < 2 && !rests; leg++) {
            const double speed = std::abs(next[leg].centre.x - now[leg].centre.x) / 0.001;
            EXPECT_LT(speed, 3.1);
            standing += speed == 0;
            looks++;
        }
        EXPECT_NEAR(std::abs(now[0].centre.y - now[1].centre.y), 0.2, 1e-9);
    }
    EXPECT_LE(longest_m, 0.66);
    EXPECT_NEAR(standing, looks / 2, looks / 4);
}

TEST(Walkers, they_come_back_the_same_way)
{
    const auto there = sim::legs_of(to_and_fro, 8);
    EXPECT_NEAR((there[0].centre.x + there[1].centre.x) / 2, 6.5, 0.35);
    const auto again = sim::legs_of(to_and_fro, 17);
    const auto first = sim::legs_of(to_and_fro, 0);
    EXPECT_NEAR(again[0].centre.x, first[0].centre.x, 1e-9);
}

TEST(Walkers, a_beam_ends_on_the_leg_that_stands_in_its_way)
{
    const sim::Hit wall = {3, 7, 1};
    const sim::Circle leg = {{2, 0.03}, 0.06};
    const sim::Hit hit = sim::nearer(wall, {0, 0, 0}, leg, 9);
    EXPECT_NEAR(hit.range, 2 - std::sqrt(0.06 * 0.06 - 0.03 * 0.03), 1e-12);
    EXPECT_EQ(hit.surface, 9);
    EXPECT_NEAR(hit.cos_incidence, std::sqrt(0.75), 1e-12);
    EXPECT_EQ(sim::nearer(wall, {0, 0, 0.1}, leg, 9).surface, 7) << "beside it";
    EXPECT_EQ(sim::nearer(wall, {0, 0, sim::pi}, leg, 9).surface, 7) << "behind";
    EXPECT_EQ(sim::nearer({1.5, 7, 1}, {0, 0, 0}, leg, 9).surface, 7) << "hidden";
}

/* The hall of the home: six people cross it, some quickly, some stop beside the robot. */
sim::World busy_hall()
{
    sim::World world = sim::load_world("tools/lab/worlds/home.world");
    world.start = {4.5, 4.7, 0.4};
    world.via.clear();
    world.walkers = {
        {1.2, 4, {{1.0, 4.4}, {7.9, 4.3}}},
        {0.8, 11, {{7.5, 5.1}, {3.0, 5.2}, {1.2, 4.9}}},
        {1.4, 1, {{2.5, 3.0}, {2.5, 4.2}, {6.9, 4.0}}},
        {0.5, 30, {{5.3, 4.2}, {5.6, 5.2}}},
        {1.0, 60, {{3.7, 5.3}, {3.6, 4.1}}},
        {1.1, 7, {{6.75, 6.0}, {6.75, 4.7}, {5.4, 4.6}}},
    };
    return world;
}

double distance_to_walls(const sim::World &world, sim::Point p)
{
    double least = 1e9;
    for (const sim::Wall &wall : world.walls) {
        least = std::min(least, sim::distance_to_wall(p, wall));
    }
    return least;
}

struct Rest {
    double drift_m = 0;
    double turn_rad = 0;
    int lost = 0;
    std::unique_ptr<ale_map_t> map = std::make_unique<ale_map_t>();
};

Rest at_rest(const sim::World &world, int scans)
{
    const ale_config_t config = ale_config_default();
    sim::WorldSource source(world, {});
    const std::unique_ptr<void, void (*)(void *)> memory(std::calloc(1, ale_pipeline_size()), std::free);
    auto *pipeline = static_cast<ale_pipeline_t *>(memory.get());
    EXPECT_EQ(ale_pipeline_init(pipeline, &config.pipeline), 0);
    ale::Loops loops;
    Rest rest;
    for (int scan = 0; scan < scans;) {
        const sim::Event event = source.next();
        if (const auto *report = std::get_if<sim::OdometryReport>(&event)) {
            const ale_odometry_t sample = {report->stamp_us, sim::core_pose(report->pose)};
            ale_pipeline_odometry(pipeline, &sample);
            continue;
        }
        scan++;
        ale_estimate_t estimate;
        const ale_scan_t taken = explore::scan_of_turn(std::get<sim::Turn>(event), source.scanner());
        loops.before_scan(pipeline);
        ale_pipeline_scan(pipeline, &taken, &estimate);
        loops.after_scan(pipeline, estimate);
        rest.drift_m = std::max(rest.drift_m, std::hypot(estimate.map.x_um * 1e-6, estimate.map.y_um * 1e-6));
        rest.turn_rad = std::max(rest.turn_rad, std::abs(sim::wrapped(sim::radians(estimate.map.theta_bam))));
        rest.lost += estimate.state == ALE_STATE_LOST;
    }
    ale_pipeline_copy_map(pipeline, rest.map.get());
    return rest;
}

/* A minute; an hour with ALE_LONG_TESTS=1. */
TEST(Walkers, a_robot_at_rest_among_them_stays_and_maps_none_of_them)
{
    const sim::World world = busy_hall();
    const Rest rest = at_rest(world, std::getenv("ALE_LONG_TESTS") ? 36000 : 600);
    std::printf("drift %.1f mm, %.2f mrad; %u lines\n", 1000 * rest.drift_m, 1000 * rest.turn_rad,
                rest.map->line_count);
    EXPECT_LT(rest.drift_m, 0.010);
    EXPECT_LT(rest.turn_rad, 0.005);
    EXPECT_EQ(rest.lost, 0);
    EXPECT_GE(rest.map->line_count, 6);
    for (uint16_t k = 0; k < rest.map->line_count; k++) {
        const ale_map_line_t &line = rest.map->line[k];
        for (const ale_point_t &end : {line.start, line.end}) {
            const sim::Pose placed =
                sim::compose(world.start, {sim::metres(end.x_um), sim::metres(end.y_um), 0});
            EXPECT_LT(distance_to_walls(world, {placed.x, placed.y}), 0.12)
                << "line " << k << " at " << placed.x << " " << placed.y;
        }
    }
}

} // namespace
