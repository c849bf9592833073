// lib/graph/optimise/pose_graph: against closed forms and a dense solution.
#include <algorithm>
#include <random>

#include <Eigen/Cholesky>

#include <gtest/gtest.h>

#include "graph/optimise/pose_graph.h"

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

TEST(PoseGraph, TrueMeasurementsRestoreDisturbedPoses)
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
        const ale::Pose motion =
            ale::between(truth[static_cast<size_t>(k)], truth[static_cast<size_t>(next)]);
        graph.add_edge({k, next, motion, unit_information, false});
    }
    const ale::GraphReport report = graph.optimise(20);
    EXPECT_TRUE(report.solved);
    EXPECT_LT(largest_error(truth, graph.poses()), 1e-6);
}

// One edge whose squared residual is chi2 where the poses are.
ale::PoseGraph apart(double chi2, bool robust)
{
    ale::PoseGraph graph;
    graph.add_pose({0, 0, 0});
    graph.add_pose({1 + 0.01 * std::sqrt(chi2), 0, 0});
    graph.add_edge({0, 1, {1, 0, 0}, unit_information, robust});
    return graph;
}

TEST(PoseGraph, ARobustEdgeCostsTheIntegralOfItsWeight)
{
    EXPECT_NEAR(apart(90, false).cost(), 90, 1e-9);
    EXPECT_NEAR(apart(9, true).cost(), 9, 1e-9);
    double sum = 0;
    const double step = 0.01;
    for (double chi2 = step / 2; chi2 < 90; chi2 += step) {
        const ale::PoseGraph graph = apart(chi2, true);
        sum += graph.weight(graph.edges().front()) * step;
    }
    EXPECT_NEAR(apart(90, true).cost(), sum, 1e-3);
    EXPECT_LT(apart(1e9, true).cost(), 3 * ale::robust_kernel);
}

TEST(PoseGraph, PriorsCostTheirSquaredResiduals)
{
    ale::PoseGraph graph = apart(0, false);
    graph.add_pose_prior({1, {1, 0.01, 0}, unit_information});
    graph.set_building_constraint({0.02, {{0, 0, 1e4, false}}});
    EXPECT_NEAR(graph.cost(), 1 + 4, 1e-9);
}

// Two pieces with a guess between them; the edges of the second say that it is longer than its poses.
ale::PoseGraph two_pieces(ale::Guess guess = ale::Guess::near)
{
    ale::PoseGraph graph;
    for (int k = 0; k < 8; k++) {
        graph.add_pose({k < 4 ? 1.0 * k : 30 + 1.0 * k, 0, 0});
    }
    for (int k = 0; k < 7; k++) {
        const ale::Pose motion = ale::between(graph.poses(), k, k + 1);
        if (k == 3) {
            graph.add_edge({k, k + 1, motion, ale::guess_information(), false, false, guess});
        } else {
            graph.add_edge({k, k + 1, {k < 3 ? 1 : 1.2, 0, 0}, unit_information, false});
        }
    }
    return graph;
}

TEST(PoseGraph, AGuessHoldsAPieceAndBendsNothing)
{
    ale::PoseGraph graph = two_pieces();
    graph.add_edge({0, 3, {3.2, 0, 0}, unit_information, false});
    EXPECT_TRUE(graph.optimise(20).solved);
    EXPECT_NEAR(graph.poses()[3].x, 3.15, 1e-3);
    EXPECT_NEAR(graph.poses()[4].x, 34.15, 1e-3) << "goes along";
    EXPECT_NEAR(graph.poses()[7].x - graph.poses()[4].x, 3.6, 1e-6);
}

TEST(PoseGraph, HeldPosesStay)
{
    ale::PoseGraph graph = two_pieces();
    graph.hold({false, false, false, false, true, true, true, true});
    EXPECT_TRUE(graph.optimise(20).solved);
    EXPECT_NEAR(graph.poses()[7].x, 37, 1e-6);
    graph.hold({});
    EXPECT_TRUE(graph.optimise(20).solved);
    EXPECT_NEAR(graph.poses()[7].x, 37.6, 1e-3);
}

TEST(PoseGraph, APieceMovesAsOne)
{
    ale::PoseGraph graph = two_pieces();
    graph.move_rigidly({false, false, false, false, true, true, true, true}, {-30, 1, 0});
    EXPECT_NEAR(graph.poses()[4].x, 4, 1e-9);
    EXPECT_NEAR(graph.poses()[4].y, 1, 1e-9);
    EXPECT_NEAR(graph.poses()[3].x, 3, 1e-9);
    EXPECT_NEAR(graph.residual2(graph.edges()[3]), 0, 1e-9) << "the guess says what holds now";
}

TEST(PoseGraph, WhatWheelsHaveToldOfTheWayStaysWhenAPieceMoves)
{
    ale::PoseGraph graph = two_pieces(ale::Guess::led);
    const ale::Pose told = graph.edges()[3].measured;
    graph.move_rigidly({false, false, false, false, true, true, true, true}, {-30, 1, 0});
    EXPECT_NEAR(graph.edges()[3].measured.x, told.x, 1e-9);
    EXPECT_NEAR(graph.edges()[3].measured.y, told.y, 1e-9);
}

TEST(PoseGraph, ALoopIsNotMovedIntoAnotherPiece)
{
    ale::PoseGraph graph = two_pieces();
    graph.add_edge({0, 3, {3, 0, 0}, unit_information, true});
    graph.remove_pose(3, 3);
    ASSERT_EQ(graph.poses().size(), 7U);
    ASSERT_EQ(graph.edges().size(), 6U);
    for (const ale::GraphEdge &edge : graph.edges()) {
        EXPECT_FALSE(edge.robust);
        EXPECT_EQ(edge.guess != ale::Guess::none, edge.from == 2) << "what spans the guess is one";
    }
}

// With priors the first pose is not held.
TEST(PoseGraph, PosePriorsMoveAllPosesToTheMap)
{
    ale::PoseGraph graph;
    const ale::Pose shift{0.3, -0.2, 0.05};
    const std::vector<ale::Pose> truth = circle(12);
    for (const ale::Pose &pose : truth) {
        graph.add_pose(ale::compose(shift, pose));
    }
    for (int k = 0; k < 11; k++) {
        const ale::Pose motion =
            ale::between(truth[static_cast<size_t>(k)], truth[static_cast<size_t>(k) + 1]);
        graph.add_edge({k, k + 1, motion, unit_information, false});
    }
    for (const int k : {2, 6, 9}) {
        graph.add_pose_prior({k, truth[static_cast<size_t>(k)], unit_information});
    }
    EXPECT_GT(graph.residual2(graph.pose_priors().front()), 100);
    ASSERT_TRUE(graph.optimise(30, 1e5).solved);
    EXPECT_LT(largest_error(truth, graph.poses()), 1e-6);
    graph.remove_pose(6, 3);
    ASSERT_EQ(graph.pose_priors().size(), 2U);
    EXPECT_EQ(graph.pose_priors()[1].pose, 8);
    EXPECT_LT(graph.residual2(graph.pose_priors()[1]), 1e-9);
}

TEST(PoseGraph, OnePosePriorThatContradictsAllOthersLosesItsWeight)
{
    ale::PoseGraph graph;
    const std::vector<ale::Pose> truth = circle(12);
    for (const ale::Pose &pose : truth) {
        graph.add_pose(pose);
    }
    for (int k = 0; k < 11; k++) {
        const ale::Pose motion =
            ale::between(truth[static_cast<size_t>(k)], truth[static_cast<size_t>(k) + 1]);
        graph.add_edge({k, k + 1, motion, unit_information, false});
    }
    for (const int k : {1, 3, 5, 7, 9}) {
        graph.add_pose_prior({k, truth[static_cast<size_t>(k)], unit_information});
    }
    graph.add_pose_prior({11, ale::compose({1.0, 0.5, 0}, truth[11]), unit_information});
    ASSERT_TRUE(graph.optimise(30).solved);
    EXPECT_LT(largest_error(truth, graph.poses()), 0.02);
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

TEST(PoseGraph, ALoopStaysOfItsKindWhenThePoseThatItEndsAtGoes)
{
    for (const bool joins : {false, true}) {
        ale::PoseGraph graph;
        for (int k = 0; k <= 6; k++) {
            graph.add_pose({1.0 * k, 0, 0});
        }
        for (int k = 0; k < 6; k++) {
            graph.add_edge({k, k + 1, {1, 0, 0}, unit_information, false});
        }
        graph.add_edge({1, 4, {3, 0, 0}, unit_information, true, !joins, ale::Guess::none, joins});
        graph.remove_pose(4, 3);
        const ale::GraphEdge &loop = graph.edges().back();
        ASSERT_TRUE(loop.robust);
        EXPECT_EQ(loop.joins, joins);
        EXPECT_EQ(loop.recognised, !joins);
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
        const ale::Pose motion =
            ale::between(truth[static_cast<size_t>(k)], truth[static_cast<size_t>(next)]);
        graph.add_edge({k, next, motion, unit_information, next == 0});
    }
    graph.add_edge({3, 23, {0.5, 0.2, 1}, unit_information, true});
    graph.optimise(20);
    EXPECT_LT(largest_error(truth, graph.poses()), 0.05);
    EXPECT_GT(graph.residual2(graph.edges().back()), 1000);
}

// One iteration with a linearised prior, against a dense solution with numerical derivatives.
TEST(PoseGraph, ALinearisedPriorIsWeighedAgainstOdometry)
{
    const ale::Pose start[] = {{0, 0, 0.2}, {1, 0.3, 0.5}, {1.9, 0.8, 0.9}};
    const Eigen::Matrix3d information = Eigen::Vector3d(1e4, 4e4, 9e4).asDiagonal();
    Eigen::Matrix3d prior;
    prior << 5e4, 1e4, 2e3, 1e4, 3e4, -1e3, 2e3, -1e3, 8e4;
    const Eigen::Vector3d right_side(300, -200, 150);
    ale::PoseGraph graph;
    Eigen::MatrixXd h = Eigen::MatrixXd::Zero(9, 9);
    Eigen::VectorXd b = Eigen::VectorXd::Zero(9);
    for (const ale::Pose &pose : start) {
        graph.add_pose(pose);
    }
    for (int k = 0; k < 2; k++) {
        const ale::Pose motion{1, 0.1, 0.3};
        graph.add_edge({k, k + 1, motion, information, false});
        const auto error = [&](const Eigen::VectorXd &step) {
            const auto moved = [&](int i) {
                return ale::Pose{start[i].x + step(3 * i), start[i].y + step(3 * i + 1),
                                 start[i].theta + step(3 * i + 2)};
            };
            const ale::Pose e = ale::between(motion, ale::between(moved(k), moved(k + 1)));
            return Eigen::Vector3d(e.x, e.y, e.theta);
        };
        Eigen::MatrixXd j(3, 9);
        for (int i = 0; i < 9; i++) {
            const Eigen::VectorXd step = 1e-4 * Eigen::VectorXd::Unit(9, i);
            j.col(i) = (error(step) - error(-step)) / 2e-4;
        }
        h += j.transpose() * information * j;
        b -= j.transpose() * information * error(Eigen::VectorXd::Zero(9));
    }
    h.block<3, 3>(6, 6) += prior;
    b.tail<3>() += right_side;
    graph.set_linearised_priors({{2, prior, right_side}});
    graph.optimise(1);
    const Eigen::VectorXd step = h.bottomRightCorner<6, 6>().ldlt().solve(b.tail<6>());
    for (int k = 1; k < 3; k++) {
        const ale::Pose &pose = graph.poses()[static_cast<size_t>(k)];
        EXPECT_NEAR(pose.x - start[k].x, step(3 * k - 3), 1e-6);
        EXPECT_NEAR(pose.y - start[k].y, step(3 * k - 2), 1e-6);
        EXPECT_NEAR(pose.theta - start[k].theta, step(3 * k - 1), 1e-6);
    }
}

// A ring of poses with noisy odometry, closed by one loop.
ale::PoseGraph noisy_ring(unsigned seed)
{
    const std::vector<ale::Pose> truth = circle(40);
    std::mt19937 random(seed);
    std::normal_distribution<double> normal(0, 0.01);
    ale::PoseGraph graph;
    for (const ale::Pose &pose : truth) {
        graph.add_pose(pose);
    }
    for (int k = 0; k < 39; k++) {
        ale::Pose motion = ale::between(truth[static_cast<size_t>(k)], truth[static_cast<size_t>(k) + 1]);
        motion = {motion.x + normal(random), motion.y + normal(random), motion.theta + normal(random)};
        const Eigen::Vector3d sigma(0.01, 0.02, k % 3 == 0 ? 0.02 : 0.005);
        graph.add_edge({k, k + 1, motion, sigma.cwiseAbs2().cwiseInverse().asDiagonal(), false});
    }
    graph.add_edge({0, 39, ale::between(truth[0], truth[39]), 100 * unit_information, true});
    return graph;
}

TEST(PoseGraph, WithoutAPoseOfThePathTheOthersStay)
{
    for (unsigned seed = 1; seed <= 3; seed++) {
        ale::PoseGraph whole = noisy_ring(seed);
        ale::PoseGraph thinned = whole;
        whole.optimise(20);
        for (const int k : {30, 20, 19, 18, 7}) {
            thinned.remove_pose(k, 3);
        }
        thinned.optimise(20);
        std::vector<ale::Pose> expected = whole.poses();
        for (const int k : {30, 20, 19, 18, 7}) {
            expected.erase(expected.begin() + k);
        }
        ASSERT_EQ(thinned.poses().size(), expected.size());
        EXPECT_EQ(thinned.edges().size(), expected.size());
        EXPECT_LT(largest_error(expected, thinned.poses()), 2e-4) << "seed " << seed;
    }
}

TEST(PoseGraph, NeighboursTakeOverTheLoopsOfARemovedPose)
{
    ale::PoseGraph graph = noisy_ring(1);
    const std::vector<ale::Pose> truth = circle(40);
    const auto add_loop = [&](int from, int to) {
        graph.add_edge({from, to,
                        ale::between(truth[static_cast<size_t>(from)], truth[static_cast<size_t>(to)]),
                        unit_information, true});
    };
    add_loop(5, 20);  // ends at it: then at 21, renumbered 20
    add_loop(20, 35); // begins at it: then from 19 to 34
    add_loop(6, 20);
    add_loop(6, 21); // already an edge when the one above moves
    graph.remove_pose(20, 3);
    const auto has = [&](int from, int to) {
        return std::count_if(graph.edges().begin(), graph.edges().end(), [&](const ale::GraphEdge &edge) {
            return edge.robust && edge.from == from && edge.to == to;
        });
    };
    EXPECT_EQ(has(5, 20), 1);
    EXPECT_EQ(has(19, 34), 1);
    EXPECT_EQ(has(6, 20), 1);
    EXPECT_EQ(has(0, 38), 1);
    EXPECT_EQ(graph.edges().size(), 38U + 4U);
    for (const ale::GraphEdge &edge : graph.edges()) {
        EXPECT_LT(edge.from, edge.to);
        EXPECT_LT(edge.to, 39);
        EXPECT_LT(graph.residual2(edge), 60) << "measured as it is";
    }
}

TEST(PoseGraph, NoPoseGathersMoreLoopsThanTheBound)
{
    ale::PoseGraph graph = noisy_ring(1);
    const std::vector<ale::Pose> &poses = graph.poses();
    for (int to = 20; to < 30; to++) {
        for (int from = 0; from < 3; from++) {
            graph.add_edge({from, to,
                            ale::between(poses[static_cast<size_t>(from)], poses[static_cast<size_t>(to)]),
                            unit_information, true});
        }
    }
    for (int gone = 0; gone < 8; gone++) {
        graph.remove_pose(2, 3);
        graph.remove_pose(20 - gone, 3);
    }
    const auto count = static_cast<int>(graph.poses().size());
    for (int to = 1; to < count; to++) {
        const auto loops =
            std::count_if(graph.edges().begin(), graph.edges().end(),
                          [to](const ale::GraphEdge &edge) { return edge.robust && edge.to == to; });
        EXPECT_LE(loops, 3) << to;
    }
    EXPECT_EQ(std::count_if(graph.edges().begin(), graph.edges().end(),
                            [](const ale::GraphEdge &edge) { return !edge.robust; }),
              count - 1);
}

} // namespace
