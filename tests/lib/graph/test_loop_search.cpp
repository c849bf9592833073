// lib/graph/loop_search: a drifting walk around a block, against the truth.
#include <gtest/gtest.h>

#include "graph/loop_search.h"
#include "ring_corridor.hpp"

namespace
{

constexpr double bend_rad_m = 0.003;

struct Walk {
    std::vector<ale::Pose> truth;
    std::vector<ale::Node> nodes;
    ale::PoseGraph graph; // its motions alone

    explicit Walk(double laps)
        : truth(ring_corridor::truth(laps)), nodes(ring_corridor::drifting(truth, bend_rad_m, 5))
    {
        for (size_t k = 0; k < nodes.size(); k++) {
            const int here = static_cast<int>(k);
            graph.add_pose(nodes[k].smooth);
            if (k > 0) {
                graph.add_edge({here - 1, here, ale::between(nodes[k - 1].smooth, nodes[k].smooth),
                                ale::known_to(0.01, 0.004), false});
            }
        }
    }

    double error_m(const ale::PoseGraph &estimate) const
    {
        return ring_corridor::largest_error_m(truth, estimate.poses());
    }
};

ale::PoseGraph searched(const Walk &walk, const ale::PoseGraph &graph)
{
    ale::LoopSearch search(&walk.nodes, graph);
    while (search.step()) {
    }
    return search.graph();
}

TEST(LoopSearch, FindsWhatWasMissedWhileDriving)
{
    const Walk walk(1.1);
    EXPECT_GT(walk.error_m(walk.graph), 2.0);
    EXPECT_LT(walk.error_m(searched(walk, walk.graph)), 0.4);
}

TEST(LoopSearch, LetsGoOfWhatWasBelievedWrongly)
{
    Walk walk(1.1);
    const int last = static_cast<int>(walk.nodes.size()) - 1;
    ale::Pose elsewhere = ale::between(walk.truth[4], walk.truth.back());
    elsewhere.x += 1.5;
    walk.graph.add_edge({4, last, elsewhere, ale::known_to(0.01, 0.003), true});
    walk.graph.optimise(10);
    EXPECT_LT(walk.error_m(searched(walk, walk.graph)), 0.4);
}

TEST(LoopSearch, WithoutAPlaceSeenAgainNothingMoves)
{
    const Walk walk(0.6);
    EXPECT_NEAR(walk.error_m(searched(walk, walk.graph)), walk.error_m(walk.graph), 1e-6);
}

} // namespace
