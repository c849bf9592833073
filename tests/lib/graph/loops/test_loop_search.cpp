// lib/graph/loops/loop_search: a drifting drive around a block, against the truth.
#include <cmath>

#include <gtest/gtest.h>

#include "graph/loops/loop_search.h"
#include "lib/graph/ring_corridor.hpp"

namespace
{

constexpr double bend_rad_m = 0.003;

// Of the motion between two nodes, one sigma.
struct Odometry {
    double position_m = 0.01;
    double heading_rad = 0.004;
};

struct Walk {
    std::vector<ale::Pose> truth;
    std::vector<ale::Node> nodes;
    ale::PoseGraph graph; // odometry alone

    explicit Walk(double laps, double bend = bend_rad_m, const Odometry &odometry = {})
        : truth(ring_corridor::truth(laps)), nodes(ring_corridor::drifting(truth, bend, 5))
    {
        for (size_t k = 0; k < nodes.size(); k++) {
            const int here = static_cast<int>(k);
            graph.add_pose(nodes[k].smooth);
            if (k > 0) {
                graph.add_edge({here - 1, here, ale::between(nodes[k - 1].smooth, nodes[k].smooth),
                                ale::information_from_deviations(odometry.position_m, odometry.heading_rad),
                                false});
            }
        }
    }

    double error_m(const ale::PoseGraph &estimate) const
    {
        return ring_corridor::largest_error_m(truth, estimate.poses());
    }
};

template <class Drive> ale::PoseGraph searched(const Drive &drive, const ale::PoseGraph &graph)
{
    ale::LoopSearch search(&drive.nodes, graph);
    while (search.step()) {
    }
    return search.graph();
}

TEST(LoopSearch, FindsLoopsMissedWhileDriving)
{
    const Walk walk(1.1);
    EXPECT_GT(walk.error_m(walk.graph), 2.0);
    EXPECT_LT(walk.error_m(searched(walk, walk.graph)), 0.4);
}

// The graph itself says that it may be so far off.
TEST(LoopSearch, FindsALoopThatTheWayMissesByManyMetres)
{
    const Walk walk(1.3, 3 * bend_rad_m, {0.02, 0.02});
    EXPECT_GT(walk.error_m(walk.graph), 5);
    EXPECT_LT(walk.error_m(searched(walk, walk.graph)), 0.5);
}

// A place seen at the start and again at the end: the first visit saw a niche alone, the second a long wall
// behind it, too. The path between leads 8 m away, with a heading error.
struct Return {
    static constexpr int visit = 4;
    static constexpr int between = 9;
    static constexpr double turned_rad = 0.09;
    std::vector<ale::Pose> truth;
    std::vector<ale::Node> nodes;
    ale::PoseGraph graph;

    explicit Return(double wall_m)
    {
        for (int k = 0; k < 2 * visit + between; k++) {
            const bool first = k < visit;
            const bool second = k >= visit + between;
            const double along = 0.2 * (second ? k - visit - between : k);
            truth.push_back(first || second ? ale::Pose{along, 0.1, 0} : ale::Pose{0.3 * k, -8, 0});
            add_node(first, second, wall_m);
        }
    }

    // Of the last pose.
    ale::Pose error(const ale::PoseGraph &estimate) const
    {
        return ale::between(truth.back(), estimate.poses().back());
    }

  private:
    void add_node(bool first, bool second, double wall_m)
    {
        const int k = static_cast<int>(nodes.size());
        ale::Node node = {};
        node.scan = static_cast<uint32_t>(k);
        node.path_m = 0.5 * k;
        if (first || second) {
            see({{3, 1.4}, {3, 0.6}, {3.4, 0.6}, {3.4, 0}, {3, 0}, {3, -1}}, &node);
        }
        if (second) {
            see({{-3, -wall_m / 2}, {-3, wall_m / 2}}, &node);
        }
        ale::Pose motion = k > 0 ? ale::between(truth[nodes.size() - 1], truth.back()) : truth[0];
        motion.theta += k == visit + between / 2 ? turned_rad : 0;
        graph.add_pose(k > 0 ? ale::compose(graph.poses().back(), motion) : motion);
        if (k > 0) {
            graph.add_edge({k - 1, k, motion, ale::information_from_deviations(0.02, 0.01), false});
        }
        node.smooth = graph.poses().back();
        nodes.push_back(node);
    }

    // The corners of a chain of walls, which are seen from their right.
    void see(const std::vector<Eigen::Vector2d> &corners, ale::Node *node) const
    {
        const ale::Pose to_robot = ale::inverse(truth.back());
        for (size_t k = 0; k + 1 < corners.size(); k++) {
            const Eigen::Vector2d d = corners[k + 1] - corners[k];
            const Eigen::Vector2d normal = Eigen::Vector2d(d.y(), -d.x()).normalized();
            for (double u = 0.02; u < d.norm(); u += 0.1) {
                node->points.push_back({ale::apply(to_robot, corners[k] + d.normalized() * u),
                                        ale::rotation(to_robot.theta) * normal});
            }
        }
    }
};

TEST(LoopSearch, FindsAPlaceOfWhichMuchWasOutOfViewBefore)
{
    const Return walk(9);
    const ale::Pose before = walk.error(walk.graph);
    EXPECT_GT(ale::length(before.x, before.y), 0.5);
    const ale::Pose after = walk.error(searched(walk, walk.graph));
    EXPECT_LT(ale::length(after.x, after.y), 0.05);
    EXPECT_LT(std::abs(after.theta), 0.01);
}

TEST(LoopSearch, TooLittleInViewIsNoLoop)
{
    const Return walk(36);
    EXPECT_NEAR(walk.error(searched(walk, walk.graph)).theta, walk.error(walk.graph).theta, 1e-6);
}

TEST(LoopSearch, RejectsAFalseLoopAcceptedWhileDriving)
{
    Walk walk(1.1);
    const int last = static_cast<int>(walk.nodes.size()) - 1;
    ale::Pose elsewhere = ale::between(walk.truth[4], walk.truth.back());
    elsewhere.x += 1.5;
    walk.graph.add_edge({4, last, elsewhere, ale::information_from_deviations(0.01, 0.003), true});
    walk.graph.optimise(10);
    EXPECT_LT(walk.error_m(searched(walk, walk.graph)), 0.4);
}

// There and back along a line, past which nothing is seen. All loops are given: of the way back most say the
// truth, and those of its middle agree on a place 0.3 m beside it.
struct ThereAndBack {
    static constexpr int count = 40;
    std::vector<ale::Pose> truth;
    std::vector<ale::Node> nodes;
    ale::PoseGraph graph;

    ThereAndBack(int first_false, int last_false)
    {
        for (int k = 0; k < count; k++) {
            const int along = std::min(k, count - 1 - k);
            add_node({0.5 * along, 0, k < count / 2 ? 0 : ale::pi});
        }
        for (int k = count / 2 + 1; k < count; k++) {
            const int there = count - 1 - k;
            ale::Pose measured = ale::between(truth, there, k);
            measured.y += k >= first_false && k <= last_false ? 0.3 : 0;
            graph.add_edge({there, k, measured, ale::information_from_deviations(0.01, 0.003), true});
        }
    }

  private:
    void add_node(const ale::Pose &pose)
    {
        const int k = static_cast<int>(truth.size());
        truth.push_back(pose);
        graph.add_pose(pose);
        if (k > 0) {
            graph.add_edge({k - 1, k, ale::between(truth, k - 1, k),
                            ale::information_from_deviations(0.01, 0.005), false});
        }
        ale::Node node = {};
        node.scan = static_cast<uint32_t>(k);
        node.path_m = 0.5 * k;
        node.smooth = pose;
        nodes.push_back(node);
    }
};

TEST(LoopSearch, FalseLoopsThatAgreeDoNotOutweighTheWay)
{
    const ThereAndBack walk(26, 33);
    EXPECT_LT(ring_corridor::largest_error_m(walk.truth, searched(walk, walk.graph).poses()), 0.02);
}

TEST(LoopSearch, WithoutARevisitNothingMoves)
{
    const Walk walk(0.6);
    EXPECT_NEAR(walk.error_m(searched(walk, walk.graph)), walk.error_m(walk.graph), 1e-6);
}

} // namespace
