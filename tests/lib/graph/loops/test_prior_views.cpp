// lib/graph/loops/prior_views: what a robot would see of a saved map.
#include <cmath>

#include <gtest/gtest.h>

#include "graph/loops/prior_views.h"
#include "graph/optimise/se2.h"
#include "lib/motion/convert.h"

extern "C" {
#include "map/map_exchange.h"
}

namespace
{

using Walls = std::vector<ale_wall_t>;

// Seen from the left of its way.
void add(Walls *walls, double x1, double y1, double x2, double y2)
{
    ale_map_line_t line{};
    line.start = {convert::um(x1), convert::um(y1)};
    line.end = {convert::um(x2), convert::um(y2)};
    ale_wall_t wall{};
    ASSERT_TRUE(ale_map_line_wall(&line, &wall));
    walls->push_back(wall);
}

// 6 m by 4 m about the origin, seen from within.
Walls room()
{
    Walls walls;
    add(&walls, -3, -2, 3, -2);
    add(&walls, 3, -2, 3, 2);
    add(&walls, 3, 2, -3, 2);
    add(&walls, -3, 2, -3, -2);
    return walls;
}

TEST(PriorViews, AreOfTheRoomFromWithin)
{
    const ale::PriorViews views(room());
    EXPECT_GE(views.poses().size(), 15U) << "a metre apart";
    for (size_t k = 0; k < views.poses().size(); k++) {
        const ale::Pose &from = views.poses()[k];
        const ale::Node view = views.at(k);
        EXPECT_LE(std::abs(from.x), 3);
        EXPECT_LE(std::abs(from.y), 2);
        EXPECT_EQ(view.map_id, static_cast<uint32_t>(ALE_FIRST_MAP));
        EXPECT_GE(view.points.size(), 350U) << "but for beams beside a corner";
        for (const ale::SurfacePoint &seen : view.points) {
            const Eigen::Vector2d p(from.x + seen.p.x(), from.y + seen.p.y());
            EXPECT_NEAR(std::max(std::abs(p.x()) / 3, std::abs(p.y()) / 2), 1, 1e-5) << "on a wall";
            EXPECT_LT(seen.normal.dot(seen.p), 0) << "towards the robot";
        }
    }
}

TEST(PriorViews, ShowNothingThatAWallHides)
{
    Walls walls = room();
    add(&walls, 0, -2, 0, 2); // seen from the left: from x < 0
    const ale::PriorViews views(walls);
    for (size_t k = 0; k < views.poses().size(); k++) {
        const ale::Node view = views.at(k);
        if (view.tracked.x < 0) {
            for (const ale::SurfacePoint &seen : view.points) {
                EXPECT_LE(view.tracked.x + seen.p.x(), 1e-5);
            }
        }
    }
}

TEST(PriorViews, AWallAloneIsSeenFromItsSideOnly)
{
    Walls walls;
    add(&walls, -5, 0, 5, 0);
    const ale::PriorViews views(walls);
    EXPECT_FALSE(views.poses().empty());
    for (const ale::Pose &from : views.poses()) {
        EXPECT_GT(from.y, 0);
    }
    EXPECT_TRUE(ale::PriorViews({}).poses().empty());
}

} // namespace
