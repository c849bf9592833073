// lib/graph/loops/pairwise_refinement: a graph with loops good to centimetres, against the truth.
#include <gtest/gtest.h>

#include "graph/loops/pairwise_refinement.h"
#include "lib/graph/bent_corridor.hpp"
#include "lib/graph/ring_corridor.hpp"

namespace
{

constexpr double laps = 1.15;

// A drive along the corridor, and its errors in a graph.
struct Walk {
    std::vector<ale::Pose> truth;
    std::vector<ale::Node> nodes;
    size_t lap;

    explicit Walk(double bend_rad_m, double length_laps = laps)
        : truth(ring_corridor::truth(length_laps)), nodes(ring_corridor::drifting(truth, bend_rad_m, 3)),
          lap(static_cast<size_t>(static_cast<double>(truth.size()) / length_laps))
    {
    }

    // Odometry as tracked, and a loop at every tenth node of the second lap that is `off_m` wrong.
    ale::PoseGraph graph(double off_m) const
    {
        ale::PoseGraph graph;
        for (size_t k = 0; k < nodes.size(); k++) {
            const int here = static_cast<int>(k);
            graph.add_pose(nodes[k].smooth);
            if (k > 0) {
                graph.add_edge({here - 1, here, ale::between(nodes[k - 1].smooth, nodes[k].smooth),
                                ale::information_from_deviations(0.005, 0.002), false});
            }
            if (k > lap && k % 10 == 0) {
                ale::Pose measured = ale::between(truth[k - lap], truth[k]);
                measured.y += off_m;
                graph.add_edge({here - static_cast<int>(lap), here, measured,
                                ale::information_from_deviations(0.01, 0.003), true});
            }
        }
        graph.optimise(10);
        return graph;
    }

    double error_m(const ale::PoseGraph &graph) const
    {
        return ring_corridor::largest_error_m(truth, graph.poses());
    }

    // Mean displacement of the places of the second lap from those of the first.
    double gap_m(const ale::PoseGraph &graph) const
    {
        double sum = 0;
        for (size_t k = lap; k < nodes.size(); k++) {
            const ale::Pose seen = ale::between(graph.poses()[k - lap], graph.poses()[k]);
            const ale::Pose is = ale::between(truth[k - lap], truth[k]);
            sum += ale::length(seen.x - is.x, seen.y - is.y);
        }
        return sum / static_cast<double>(nodes.size() - lap);
    }
};

int refine(ale::PairwiseRefinement *refinement)
{
    int steps = 0;
    while (refinement->step()) {
        steps++;
    }
    return steps;
}

TEST(PairwiseRefinement, RevisitedPlacesAreAligned)
{
    const Walk walk(0.0004);
    ale::PairwiseRefinement refinement(&walk.nodes, walk.graph(0.06));
    EXPECT_GT(walk.gap_m(refinement.graph()), 0.03);
    refine(&refinement);
    EXPECT_LT(walk.gap_m(refinement.graph()), 0.01);
}

TEST(PairwiseRefinement, TrueLoopsStay)
{
    Walk walk(0);
    for (size_t k = 0; k < walk.nodes.size(); k++) {
        walk.nodes[k].smooth = walk.truth[k];
    }
    ale::PairwiseRefinement refinement(&walk.nodes, walk.graph(0));
    refine(&refinement);
    EXPECT_LT(walk.error_m(refinement.graph()), 0.03);
}

// Largest heading error along a bent corridor, or with heading drift.
double heading_error(double bend_rad, double drift_rad_m)
{
    const std::vector<ale::Node> nodes = bent_corridor::nodes(bend_rad, drift_rad_m, 6);
    ale::PoseGraph graph;
    for (size_t k = 0; k < nodes.size(); k++) {
        const int here = graph.add_pose(nodes[k].smooth);
        if (k > 0) {
            graph.add_edge({here - 1, here, ale::between(nodes[k - 1].smooth, nodes[k].smooth),
                            ale::information_from_deviations(0.008, 0.0025), false});
        }
    }
    ale::PairwiseRefinement refinement(&nodes, graph);
    refine(&refinement);
    const std::vector<ale::Pose> truth = bent_corridor::truth(bend_rad);
    double largest = 0;
    for (size_t k = 0; k < truth.size(); k++) {
        const double off = ale::wrapped(refinement.graph().poses()[k].theta - truth[k].theta);
        largest = std::max(largest, std::abs(off));
    }
    return largest;
}

TEST(PairwiseRefinement, TheBuildingDirectionCorrectsHeadingDrift)
{
    EXPECT_LT(heading_error(0, 0.006), 0.02);
}

// The drift is too small for the constraint while driving.
TEST(PairwiseRefinement, TheBuildingDirectionCorrectsSlightDrift)
{
    EXPECT_LT(heading_error(0, 0.0015), 0.0058);
}

TEST(PairwiseRefinement, ABentCorridorIsNotStraightened)
{
    EXPECT_LT(heading_error(0.05, 0), 0.01);
    EXPECT_LT(heading_error(-0.14, 0), 0.01);
}

TEST(PairwiseRefinement, ALoopThatNoMatchConfirmsIsRejected)
{
    const Walk walk(0, 0.5);
    ale::PoseGraph graph = walk.graph(0);
    const double before = walk.error_m(graph);
    const int last = static_cast<int>(walk.nodes.size()) - 1;
    ale::Pose false_place = ale::between(graph.poses().front(), graph.poses().back());
    false_place.x += 0.5;
    graph.add_edge({0, last, false_place, ale::information_from_deviations(0.05, 0.02), true});
    graph.optimise(10);
    EXPECT_GT(walk.error_m(graph), before + 0.2);
    ale::PairwiseRefinement refinement(&walk.nodes, std::move(graph));
    refine(&refinement);
    EXPECT_LT(walk.error_m(refinement.graph()), before + 0.1);
}

TEST(PairwiseRefinement, TheWorkIsSpreadOverManySteps)
{
    const Walk walk(0.0004);
    ale::PairwiseRefinement refinement(&walk.nodes, walk.graph(0));
    EXPECT_GT(refine(&refinement), static_cast<int>(walk.nodes.size()) / 8);
    EXPECT_FALSE(refinement.step());
}

} // namespace
