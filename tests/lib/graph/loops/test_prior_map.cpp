// lib/graph/loops/prior_map: scans matched with a prior map, and its memory.
#include <malloc.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include <gtest/gtest.h>

#include "graph/loops/prior_map.h"

namespace
{

void add(ale_map_t *map, ale_point_t start, ale_point_t end)
{
    ale_map_line_t &line = map->line[map->line_count++];
    line.start = start;
    line.end = end;
    line.seen = 9;
}

// A corner of two walls that face the robot at its origin, 2 m and 3 m away; each 400 m long.
std::unique_ptr<ale_map_t> long_corner()
{
    auto map = std::make_unique<ale_map_t>();
    add(map.get(), {3000000, 2000000}, {-400000000, 2000000});
    add(map.get(), {3000000, -400000000}, {3000000, 2000000});
    return map;
}

// Its surfaces seen from a pose, up to out_to_m from the corner.
std::vector<ale::SurfacePoint> seen_from(const ale::Pose &pose, double out_to_m)
{
    const ale::Pose there = ale::inverse(pose);
    const auto place = [&](const Eigen::Vector2d &p, const Eigen::Vector2d &normal) {
        const ale::Pose at = ale::compose(there, {p.x(), p.y(), 0});
        const double c = std::cos(there.theta);
        const double s = std::sin(there.theta);
        return ale::SurfacePoint{{at.x, at.y},
                                 {c * normal.x() - s * normal.y(), s * normal.x() + c * normal.y()}};
    };
    std::vector<ale::SurfacePoint> points;
    for (double t = 0.05; t < out_to_m; t += 0.05) {
        points.push_back(place({3 - t, 2}, {0, -1}));
        points.push_back(place({3, 2 - t}, {-1, 0}));
    }
    return points;
}

TEST(PriorMap, FindsThePoseHoweverLongItsWalls)
{
    const ale::PriorMap prior(*long_corner());
    for (const double out_to_m : {4.0, 30.0}) {
        for (const double theta : {0.0, 1.0, -2.5}) {
            const ale::Pose truth{0.3, -0.2, theta};
            const ale::Pose guess{0.38, -0.12, theta + 0.02};
            const auto match = prior.find(seen_from(truth, out_to_m), guess);
            ASSERT_TRUE(match);
            EXPECT_NEAR(match->pose.x, truth.x, 0.01);
            EXPECT_NEAR(match->pose.y, truth.y, 0.01);
            EXPECT_NEAR(match->pose.theta, truth.theta, 0.005);
        }
    }
}

TEST(PriorMap, FindsNothingWithoutWallsNear)
{
    const ale::PriorMap prior(*long_corner());
    EXPECT_FALSE(prior.find(seen_from({0, 0, 0}, 4), {50, 50, 0}));
}

size_t held()
{
    const struct mallinfo2 info = mallinfo2();
    return info.uordblks + info.hblkhd;
}

// ALE_MAPPER_HEAP_BYTES counts on it.
TEST(PriorMap, AFullMapTakesLessThanAMegabyteHoweverLongItsWalls)
{
    const auto map = std::make_unique<ale_map_t>();
    for (int k = 0; k < ALE_MAP_MAX_LINES; k++) {
        add(map.get(), {50000000, 100000 * k}, {-50000000, 100000 * k});
    }
    const size_t before = held();
    const ale::PriorMap prior(*map);
    EXPECT_LT(held() - before, 1000000U);
}

TEST(PriorMap, ItsViewsTakeLessThanAMegabyteMore)
{
    const auto map = std::make_unique<ale_map_t>();
    for (int k = 0; k < 100; k++) {
        add(map.get(), {500000000, 10000000 * k}, {-500000000, 10000000 * k});
    }
    ale::PriorMap prior(*map);
    const size_t before = held();
    EXPECT_GT(prior.views().poses().size(), 500U);
    EXPECT_LT(held() - before, 1000000U);
}

TEST(PriorMap, ATileThatComesIsSeen)
{
    ale::PriorMap prior(*std::make_unique<ale_map_t>());
    EXPECT_TRUE(prior.views().poses().empty());
    const auto change = std::make_unique<ale_tile_change_t>();
    const auto map = long_corner();
    change->line_count = map->line_count;
    std::copy_n(map->line, map->line_count, change->line);
    for (int k = 0; k < change->line_count; k++) {
        change->line[k].id = static_cast<uint32_t>(k + 1);
    }
    prior.change(*change);
    EXPECT_FALSE(prior.views().poses().empty());
}

} // namespace
