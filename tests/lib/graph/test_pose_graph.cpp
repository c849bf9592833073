// lib/graph/pose_graph: against what can be said without solving anything.
#include <random>

#include <gtest/gtest.h>

#include "graph/pose_graph.h"

namespace
{

const Eigen::Matrix3d unit_information = Eigen::Matrix3d::Identity() * 1e4;

std::vector<ale::Pose> circle(int count)
{
    std::vector<ale::Pose> poses;
    for (int k = 0; k < count; k++) {
        const double a = 2 * ale::pi * k / count;
        poses.push_back({5 * std::sin(a), 5 - 5 * std::cos(a), ale::wrapped(a)});
    }
    return poses;
}

double largest_error(const std::vector<ale::Pose> &a, const std::vector<ale::Pose> &b)
{
    double largest = 0;
    for (size_t k = 0; k < a.size(); k++) {
        largest = std::max({largest, std::hypot(a[k].x - b[k].x, a[k].y - b[k].y),
                            std::abs(ale::wrapped(a[k].theta - b[k].theta))});
    }
    return largest;
}

TEST(PoseGraph, TrueMeasurementsBringDisturbedPosesBack)
{
    const std::vector<ale::Pose> truth = circle(40);
    std::mt19937 random(3);
    std::normal_distribution<double> normal(0, 0.1);
    ale::PoseGraph graph;
    for (size_t k = 0; k < truth.size(); k++) {
        const double off = k == 0 ? 0 : 1;
        graph.add_pose({truth[k].x + off * normal(random), truth[k].y + off * normal(random),
                        truth[k].theta + off * normal(random)});
    }
    for (int k = 0; k < 40; k++) {
        const int next = (k + 1) % 40;
        const ale::Pose way = ale::between(truth[static_cast<size_t>(k)], truth[static_cast<size_t>(next)]);
        graph.add_edge({k, next, way, unit_information, false});
    }
    const ale::GraphReport report = graph.optimise(20);
    EXPECT_TRUE(report.solved);
    EXPECT_LT(largest_error(truth, graph.poses()), 1e-6);
}

// A chain of equal edges and a loop of the same weight: the gap of the loop is shared by all alike.
TEST(PoseGraph, AGapIsSharedByTheEdgesOfTheLoop)
{
    ale::PoseGraph graph;
    for (int k = 0; k <= 4; k++) {
        graph.add_pose({1.0 * k, 0, 0});
    }
    for (int k = 0; k < 4; k++) {
        graph.add_edge({k, k + 1, {1, 0, 0}, unit_information, false});
    }
    graph.add_edge({0, 4, {3.995, 0, 0}, unit_information, true});
    graph.optimise(20);
    for (size_t k = 1; k <= 4; k++) {
        EXPECT_NEAR(graph.poses()[k].x, static_cast<double>(k) * 0.999, 1e-6);
        EXPECT_NEAR(graph.poses()[k].y, 0, 1e-9);
    }
}

TEST(PoseGraph, ALoopThatContradictsAllOthersLosesItsWeight)
{
    const std::vector<ale::Pose> truth = circle(40);
    ale::PoseGraph graph;
    for (const ale::Pose &pose : truth) {
        graph.add_pose(pose);
    }
    for (int k = 0; k < 40; k++) {
        const int next = (k + 1) % 40;
        const ale::Pose way = ale::between(truth[static_cast<size_t>(k)], truth[static_cast<size_t>(next)]);
        graph.add_edge({k, next, way, unit_information, next == 0});
    }
    graph.add_edge({3, 23, {0.5, 0.2, 1}, unit_information, true});
    graph.optimise(20);
    EXPECT_LT(largest_error(truth, graph.poses()), 0.05);
    EXPECT_GT(graph.residual2(graph.edges().back()), 1000);
}

} // namespace
