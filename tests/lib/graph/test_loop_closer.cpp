// lib/graph/loop_closer: a walk around a block, with drift, against the truth.
#include <gtest/gtest.h>

#include "graph/loop_closer.h"
#include "ring_corridor.hpp"

namespace
{

double largest_error(const std::vector<ale::Pose> &truth, const std::vector<ale::Pose> &poses)
{
    double largest = 0;
    for (size_t k = 0; k < truth.size(); k++) {
        largest = std::max(largest, std::hypot(truth[k].x - poses[k].x, truth[k].y - poses[k].y));
    }
    return largest;
}

// With the motion that was tracked; the test's tracker never takes a correction in.
void add(ale::LoopCloser *closer, const ale::Node &node)
{
    closer->add(node, closer->nodes().empty() ? node.smooth
                                              : ale::between(closer->nodes().back().smooth, node.smooth));
}

struct Walk {
    double tracked;
    double corrected;
    ale::LoopStatistics statistics;
};

Walk walk(double laps, double bend_rad_m, unsigned seed)
{
    const std::vector<ale::Pose> truth = ring_corridor::truth(laps);
    ale::LoopCloser closer;
    std::vector<ale::Pose> tracked;
    for (const ale::Node &node : ring_corridor::drifting(truth, bend_rad_m, seed)) {
        tracked.push_back(node.smooth);
        add(&closer, node);
    }
    return {largest_error(truth, tracked), largest_error(truth, closer.poses()), closer.statistics()};
}

TEST(LoopCloser, ADriftingWalkAroundABlockCloses)
{
    for (unsigned seed = 1; seed <= 2; seed++) {
        const Walk w = walk(1.3, 0.0008, seed);
        EXPECT_GT(w.tracked, 0.5);
        EXPECT_LT(w.corrected, 0.25) << "seed " << seed;
        EXPECT_GT(w.statistics.loops, 0U);
    }
}

TEST(LoopCloser, WithoutAPlaceSeenAgainNothingMoves)
{
    const Walk w = walk(0.9, 0.0008, 1);
    EXPECT_EQ(w.statistics.loops, 0U);
    EXPECT_NEAR(w.tracked, w.corrected, 1e-6);
}

TEST(LoopCloser, WhereTheTrackerIsRightNothingMoves)
{
    const Walk w = walk(1.3, 0, 2);
    EXPECT_LT(w.tracked, 0.3);
    EXPECT_LE(w.corrected, w.tracked + 0.02);
}

// Four sides of a square hall that look alike: the place that was left is not the place that is reached.
TEST(LoopCloser, APlaceThatOnlyLooksLikeAnotherIsNotALoop)
{
    std::vector<ale::Node> nodes = ring_corridor::drifting(ring_corridor::truth(0.5), 0, 5);
    ale::LoopCloser closer;
    for (const ale::Node &node : nodes) {
        add(&closer, node);
    }
    // the same corridor over again, two metres beside the first and never on the way there
    const double path_m = nodes.back().path_m + 10;
    for (size_t k = 0; k < 6; k++) {
        ale::Node twin = nodes[k];
        twin.scan = nodes.back().scan + 1 + static_cast<uint32_t>(k);
        twin.smooth = {nodes[k].smooth.x, nodes[k].smooth.y + 4.9, nodes[k].smooth.theta};
        twin.path_m = path_m + 0.5 * static_cast<double>(k);
        twin.broken = k == 0;
        add(&closer, twin);
    }
    EXPECT_EQ(closer.statistics().loops, 0U);
}

} // namespace
