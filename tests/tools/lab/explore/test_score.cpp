// The scorer on worlds whose areas are known from geometry.
#include <cmath>

#include <gtest/gtest.h>

#include "lab/explore/score.h"

namespace
{

sim::World box(double width, double height)
{
    sim::World world;
    world.walls = {{{0, 0}, {width, 0}},
                   {{width, 0}, {width, height}},
                   {{width, height}, {0, height}},
                   {{0, height}, {0, 0}}};
    world.start = {1, 1, 0.7};
    return world;
}

explore::Score all_of(const sim::World &world, double width)
{
    return explore::score(world, width, [](sim::Point) { return explore::Place::free; });
}

} // namespace

TEST(Score, a_disc_reaches_all_of_a_box_but_the_rounded_corners)
{
    const double radius = 0.2;
    const double truth = 4 * 3 - (4 - sim::pi) * radius * radius;
    const explore::Score score = all_of(box(4, 3), 2 * radius);
    EXPECT_NEAR(score.reachable_m2, truth, 0.03 * truth);
    EXPECT_EQ(score.mapped, 1);
    EXPECT_EQ(score.wrong, 0);
}

TEST(Score, what_lies_behind_a_narrow_door_is_not_reachable)
{
    sim::World world = box(4, 3);
    world.walls.push_back({{2, 0}, {2, 1}});
    world.walls.push_back({{2, 1.45}, {2, 3}});
    EXPECT_NEAR(all_of(world, 0.4).reachable_m2, 12, 0.5);
    EXPECT_NEAR(all_of(world, 0.5).reachable_m2, 6, 0.5);
}

TEST(Score, places_are_asked_for_in_the_frame_of_the_start)
{
    const sim::World world = box(4, 3);
    const double c = std::cos(world.start.theta);
    const double s = std::sin(world.start.theta);
    const explore::Score score = explore::score(world, 0.4, [&](sim::Point p) {
        const double x = world.start.x + c * p.x - s * p.y;
        const double y = world.start.y + s * p.x + c * p.y;
        EXPECT_TRUE(x > 0 && x < 4 && y > 0 && y < 3);
        return x < 1 ? explore::Place::unseen : (x < 2 ? explore::Place::occupied : explore::Place::free);
    });
    EXPECT_NEAR(score.mapped, 0.75, 0.02);
    EXPECT_NEAR(score.wrong, 0.25 * 2.8 / 3, 0.02) << "not within 10 cm of the walls";
}
