// Beams against walls whose answer is known in closed form.
#include <gtest/gtest.h>

#include "lab/bench/random.hpp"
#include "lab/sim/world/ray_cast.h"

namespace
{

constexpr double reach = 5.6;

TEST(RayCast, a_box_is_seen_from_inside_at_every_bearing)
{
    const std::vector<sim::Wall> box = {
        {{-1, -2}, {3, -2}}, {{3, -2}, {3, 1}}, {{3, 1}, {-1, 1}}, {{-1, 1}, {-1, -2}}};
    const sim::Surroundings near(box, {0, 0}, reach);
    for (double bearing = -3.1; bearing < 3.1; bearing += 0.01) {
        const double c = std::cos(bearing);
        const double s = std::sin(bearing);
        const double along_x = (c > 0 ? 3 : -1) / c;
        const double along_y = (s > 0 ? 1 : -2) / s;
        const sim::Hit hit = near.cast({0, 0, bearing});
        EXPECT_NEAR(hit.range, std::min(along_x, along_y), 1e-9) << bearing;
        EXPECT_NEAR(hit.cos_incidence, along_x < along_y ? std::fabs(c) : std::fabs(s), 1e-9) << bearing;
    }
}

TEST(RayCast, the_nearest_of_many_walls_is_hit)
{
    bench::Random random(5);
    for (int round = 0; round < 200; round++) {
        std::vector<sim::Wall> walls;
        double nearest = reach;
        int expected = -1;
        for (int k = 0; k < 20; k++) {
            const double x = random.uniform(0.1, 7);
            const double low = random.uniform(-2, 1);
            const double high = low + random.uniform(0.1, 2);
            walls.push_back({{x, low}, {x, high}});
            if (low <= 0 && high >= 0 && x < nearest) {
                nearest = x;
                expected = k;
            }
        }
        const sim::Hit hit = sim::Surroundings(walls, {0, 0}, reach).cast({0, 0, 0});
        EXPECT_EQ(hit.surface, expected);
        EXPECT_NEAR(hit.range, nearest, 1e-12);
    }
}

TEST(RayCast, behind_parallel_and_out_of_reach_is_nothing)
{
    const std::vector<sim::Wall> walls = {{{-1, -1}, {-1, 1}}, {{1, 0.5}, {3, 0.5}}, {{5.7, -1}, {5.7, 1}}};
    EXPECT_EQ(sim::Surroundings(walls, {0, 0}, reach).cast({0, 0, 0}).surface, -1);
}

} // namespace
