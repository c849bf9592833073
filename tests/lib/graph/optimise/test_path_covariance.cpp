// lib/graph/optimise/path_covariance: against random samples, and with several paths.
#include <random>

#include <Eigen/SVD>
#include <gtest/gtest.h>

#include "graph/optimise/path_covariance.h"

namespace
{

constexpr double sigma_m = 0.02;
constexpr double sigma_rad = 0.03;

ale::Pose disturbed(const ale::Pose &step, std::mt19937 *random)
{
    std::normal_distribution<double> normal(0, 1);
    const ale::Pose error{sigma_m * normal(*random), sigma_m * normal(*random), sigma_rad * normal(*random)};
    return ale::compose(step, error);
}

// An arc of equal steps, and the graph that measured it.
struct Arc {
    ale::Pose step{0.8, 0.1, 0.05};
    int steps;
    ale::PoseGraph graph;

    explicit Arc(int count) : steps(count)
    {
        graph.add_pose({3, -2, 1});
        for (int k = 0; k < count; k++) {
            graph.add_pose(ale::compose(graph.poses().back(), step));
            graph.add_edge({k, k + 1, step, ale::information_from_deviations(sigma_m, sigma_rad), false});
        }
    }
};

TEST(PathCovariance, AlongAChainItIsThatOfRandomSamples)
{
    const Arc arc(12);
    std::mt19937 random(4);
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    const int samples = 4000;
    for (int k = 0; k < samples; k++) {
        ale::Pose end;
        for (int i = 0; i < arc.steps; i++) {
            end = ale::compose(end, disturbed(arc.step, &random));
        }
        const ale::Pose is = ale::between(arc.graph.poses().front(), arc.graph.poses().back());
        const Eigen::Vector3d e(end.x - is.x, end.y - is.y, ale::wrapped(end.theta - is.theta));
        sum += e * e.transpose() / samples;
    }
    const double largest = Eigen::JacobiSVD<Eigen::Matrix2d>(sum.topLeftCorner<2, 2>()).singularValues()(0);
    const ale::Deviation deviation = ale::PathCovariance(arc.graph).from(0).back();
    EXPECT_NEAR(deviation.position_m, std::sqrt(largest), 0.05 * deviation.position_m);
    EXPECT_NEAR(deviation.heading_rad, std::sqrt(sum(2, 2)), 0.05 * deviation.heading_rad);
    EXPECT_NEAR(deviation.heading_rad, ale::PathCovariance(arc.graph).from(arc.steps).front().heading_rad,
                1e-9)
        << "the covariance of the inverse is the same";
}

TEST(PathCovariance, ALoopIsAShortCutUnlessTheKernelSwitchesItOff)
{
    Arc arc(12);
    const double chain_m = ale::PathCovariance(arc.graph).from(0).back().position_m;
    const ale::Pose true_end = ale::between(arc.graph.poses().front(), arc.graph.poses().back());
    ale::PoseGraph with_false = arc.graph;
    with_false.add_edge({0,
                         12,
                         {true_end.x + 1, true_end.y, true_end.theta},
                         ale::information_from_deviations(0.01, 0.01),
                         true});
    EXPECT_DOUBLE_EQ(ale::PathCovariance(with_false).from(0).back().position_m, chain_m);
    arc.graph.add_edge({0, 12, true_end, ale::information_from_deviations(0.01, 0.01), true});
    EXPECT_NEAR(ale::PathCovariance(arc.graph).from(0).back().position_m, 0.01, 1e-9);
}

TEST(PathCovariance, WithoutAPathTheDeviationIsTheLargest)
{
    Arc arc(2);
    arc.graph.add_pose({0, 0, 0});
    EXPECT_NEAR(ale::PathCovariance(arc.graph).from(0).back().position_m, 1000, 1e-6);
}

} // namespace
