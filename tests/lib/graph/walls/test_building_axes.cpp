// lib/graph/walls/building_axes: drives through rooms whose walls are given, with headings that drift.
#include "graph/walls/building_axes.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace
{

constexpr double degree = ale::pi / 180;

// A node that sees walls of one metre each in these directions of the world.
ale::Node seeing(double heading, const std::vector<double> &walls)
{
    ale::Node node{};
    for (const double wall : walls) {
        node.walls.push_back({ale::wrapped(wall - heading), 1});
    }
    return node;
}

struct Drive {
    std::vector<ale::Node> nodes;
    std::vector<ale::Pose> truth;
    std::vector<ale::Pose> drifted;
};

// Straight on, half a metre a node, turning now and then; the heading drifts by so much a node.
Drive drive(size_t count, double drift, const std::vector<double> &walls, double stray, unsigned seed)
{
    std::mt19937 random(seed);
    std::normal_distribution<double> normal(0, stray);
    Drive made;
    for (size_t k = 0; k < count; k++) {
        const double heading = ale::wrapped(0.3 * static_cast<double>(k / 10));
        std::vector<double> seen;
        for (const double wall : walls) {
            seen.push_back(wall + normal(random));
        }
        made.nodes.push_back(seeing(heading, seen));
        made.truth.push_back({0.5 * static_cast<double>(k), 0, heading});
        made.drifted.push_back(
            {0.5 * static_cast<double>(k), 0, ale::wrapped(heading + drift * static_cast<double>(k))});
    }
    return made;
}

TEST(BuildingAxes, TrueHeadingsInARightAngledBuildingAreLeftAlone)
{
    const Drive made = drive(60, 0, {0.2, 0.2 + ale::pi / 2, 0.2}, 0.5 * degree, 1);
    const auto headings = ale::headings_by_walls(made.nodes, made.truth);
    EXPECT_EQ(headings.priors.size(), made.nodes.size());
    EXPECT_FALSE(ale::have_drifted(headings, made.truth));
}

TEST(BuildingAxes, DriftIsSeenAndTheSuggestionsAreTheTrueHeadings)
{
    const Drive made = drive(60, 0.1 * degree, {0.2, 0.2 + ale::pi / 2, 0.2}, 0, 2);
    const auto headings = ale::headings_by_walls(made.nodes, made.drifted);
    EXPECT_TRUE(ale::have_drifted(headings, made.drifted));
    const double common =
        ale::wrapped(headings.priors[0].theta - made.truth[0].theta); // the building's own direction is free
    for (const ale::HeadingPrior &prior : headings.priors) {
        const double off = prior.theta - made.truth[static_cast<size_t>(prior.pose)].theta;
        EXPECT_NEAR(ale::wrapped(off - common), 0, 0.01 * degree);
    }
}

TEST(BuildingAxes, FurnitureAtAnAngleDoesNotTurnTheBuilding)
{
    // A chest at 25 degrees in every fifth wall's place, and in the middle of the drive nothing but chests.
    Drive made = drive(60, 0, {0, ale::pi / 2, 0, ale::pi / 2, 0.44}, 0.3 * degree, 7);
    const Drive chests = drive(60, 0, {0.44, 0.44 + ale::pi / 2}, 0.3 * degree, 8);
    std::copy(chests.nodes.begin() + 25, chests.nodes.begin() + 40, made.nodes.begin() + 25);
    const auto headings = ale::headings_by_walls(made.nodes, made.truth);
    EXPECT_EQ(headings.priors.size(), made.nodes.size() - 15);
    EXPECT_FALSE(ale::have_drifted(headings, made.truth));
}

// Root mean square of what the priors miss the true headings by, but for what all of them miss.
double spread(const ale::BuildingHeadings &headings, const Drive &made)
{
    double sum = 0;
    double sum2 = 0;
    for (const ale::HeadingPrior &prior : headings.priors) {
        const double off =
            ale::wrapped(prior.theta - made.truth[static_cast<size_t>(prior.pose)].theta - ale::pi / 8);
        sum += off;
        sum2 += off * off;
    }
    const auto count = static_cast<double>(headings.priors.size());
    return std::sqrt(sum2 / count - (sum / count) * (sum / count));
}

TEST(BuildingAxes, WhereHeadingsAreOffAsManyStraysAreHeardFromEitherSide)
{
    const Drive made = drive(400, 0, {0, 0, 0, ale::pi / 2, ale::pi / 2, ale::pi / 2}, 4 * degree, 10);
    std::vector<ale::Pose> turned = made.truth;
    for (size_t k = turned.size() / 2; k < turned.size(); k++) {
        turned[k].theta = ale::wrapped(turned[k].theta + 4 * degree);
    }
    const ale::BuildingHeadings headings =
        ale::headings_by_walls(made.nodes, turned, ale::Witnesses::all_scans);
    double sum[2] = {0, 0};
    double count[2] = {0, 0};
    for (const ale::HeadingPrior &prior : headings.priors) {
        const auto pose = static_cast<size_t>(prior.pose);
        const size_t half = pose < turned.size() / 2 ? 0 : 1;
        sum[half] += ale::wrapped(prior.theta - made.truth[pose].theta);
        count[half] += 1;
    }
    EXPECT_NEAR(sum[1] / count[1], sum[0] / count[0], 0.5 * degree);
}

TEST(BuildingAxes, ScansAfterTheKeyframesAverageTheirNoise)
{
    const std::vector<double> walls{0, ale::pi / 2, 0};
    Drive made = drive(60, 0, walls, 2 * degree, 9);
    const ale::BuildingHeadings alone = ale::headings_by_walls(made.nodes, made.truth);
    constexpr int scans = 8;
    for (unsigned scan = 0; scan < scans; scan++) {
        const Drive later = drive(60, 0, walls, 2 * degree, 20 + scan);
        for (size_t k = 0; k < made.nodes.size(); k++) {
            const std::vector<ale::WallSight> &seen = later.nodes[k].walls;
            made.nodes[k].walls_after.insert(made.nodes[k].walls_after.end(), seen.begin(), seen.end());
            made.nodes[k].scans_after = scans;
        }
    }
    const ale::BuildingHeadings all =
        ale::headings_by_walls(made.nodes, made.truth, ale::Witnesses::all_scans);
    ASSERT_EQ(all.priors.size(), made.nodes.size());
    ASSERT_EQ(alone.priors.size(), made.nodes.size());
    EXPECT_LT(spread(all, made), 0.5 * spread(alone, made));
    EXPECT_GT(all.priors[0].information, 2 * alone.priors[0].information);
    EXPECT_EQ(ale::headings_by_walls(made.nodes, made.truth).building, alone.building)
        << "who asks the keyframes alone is told no more";
}

TEST(BuildingAxes, BuildingWithoutRightAnglesSaysNothing)
{
    const Drive made = drive(60, 0.1 * degree, {0.2, 0.2 + ale::pi / 4, 0.2 + ale::pi / 6, 1.2}, 0, 3);
    EXPECT_TRUE(ale::headings_by_walls(made.nodes, made.drifted).priors.empty());
}

TEST(BuildingAxes, AWingAtAnAngleIsNoDrift)
{
    Drive made = drive(64, 0, {0, ale::pi / 2, 0}, 0.3 * degree, 11);
    const Drive wing = drive(64, 0, {30 * degree, 120 * degree, 30 * degree}, 0.3 * degree, 12);
    std::copy(wing.nodes.begin() + 32, wing.nodes.end(), made.nodes.begin() + 32);
    const auto headings = ale::headings_by_walls(made.nodes, made.truth);
    EXPECT_LE(headings.priors.size(), 32);
    EXPECT_FALSE(ale::have_drifted(headings, made.truth));
}

TEST(BuildingAxes, TooFewNodesOrTooLittleWallSayNothing)
{
    const Drive few = drive(5, degree, {0, 0, 0}, 0, 4);
    EXPECT_TRUE(ale::headings_by_walls(few.nodes, few.drifted).priors.empty());
    Drive blind = drive(60, degree, {}, 0, 5);
    EXPECT_TRUE(ale::headings_by_walls(blind.nodes, blind.drifted).priors.empty());
    EXPECT_TRUE(ale::headings_by_walls({}, {}).priors.empty());
}

ale::PoseGraph chain_of(const Drive &made, double turn_sigma)
{
    ale::PoseGraph graph;
    graph.add_pose(made.drifted[0]);
    const Eigen::Matrix3d information = ale::known_to(0.01, turn_sigma);
    for (size_t k = 1; k < made.nodes.size(); k++) {
        const ale::Pose motion = ale::between(made.drifted[k - 1], made.drifted[k]);
        graph.add_pose(made.drifted[k]);
        graph.add_edge({static_cast<int>(k) - 1, static_cast<int>(k), motion, information, false});
    }
    return graph;
}

TEST(BuildingAxes, GraphTurnsDriftedHeadingsBackButForTheFirstPoseThatIsHeld)
{
    const Drive made = drive(100, 0.05 * degree, {0, ale::pi / 2, 0}, 0.3 * degree, 6);
    ale::PoseGraph graph = chain_of(made, 0.003);
    for (int round = 0; round < 2; round++) {
        graph.set_headings(ale::headings_by_walls(made.nodes, graph.poses()));
        ASSERT_TRUE(graph.optimise(10).solved);
    }
    for (size_t k = 0; k < made.nodes.size(); k++) {
        EXPECT_NEAR(ale::wrapped(graph.poses()[k].theta - made.truth[k].theta), 0, 1.2 * degree) << k;
    }
    EXPECT_FALSE(ale::have_drifted(ale::headings_by_walls(made.nodes, graph.poses()), graph.poses()));
}

TEST(BuildingAxes, DriftThatTurnsTheWholeDriveAgainstItselfIsMendedToo)
{
    const Drive made = drive(150, 0.35 * degree, {0, ale::pi / 2, 0}, 0.3 * degree, 13);
    ale::PoseGraph graph = chain_of(made, 0.01);
    for (int round = 0; round < 2; round++) {
        graph.set_headings(ale::headings_by_walls(made.nodes, graph.poses()));
        ASSERT_TRUE(graph.optimise(10).solved);
    }
    for (size_t k = 0; k < made.nodes.size(); k++) {
        EXPECT_NEAR(ale::wrapped(graph.poses()[k].theta - made.truth[k].theta), 0, 1.2 * degree) << k;
    }
}

TEST(BuildingAxes, WhereNothingHasDriftedViewsAreTornSooner)
{
    EXPECT_FALSE(ale::are_torn(106, 100, 500, true));
    EXPECT_TRUE(ale::are_torn(109, 100, 500, true));
    EXPECT_FALSE(ale::are_torn(104, 100, 500, false));
    EXPECT_TRUE(ale::are_torn(106, 100, 500, false));
    EXPECT_FALSE(ale::are_torn(1060, 1000, 300, true)); // poor matches
    EXPECT_TRUE(ale::are_torn(1060, 1000, 300, false));
}

} // namespace
