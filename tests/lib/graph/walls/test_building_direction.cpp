// lib/graph/walls/building_direction: drives past given walls, with heading drift.
#include "graph/walls/building_direction.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "graph/optimise/pose_graph.h"

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

// Straight ahead, half a metre a node, turning now and then; the heading drifts by `drift` a node.
Drive drive(size_t count, double drift, const std::vector<double> &walls, double sigma, unsigned seed)
{
    std::mt19937 random(seed);
    std::normal_distribution<double> normal(0, sigma);
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

TEST(BuildingDirection, TrueHeadingsInARightAngledBuildingShowNoDrift)
{
    const Drive made = drive(60, 0, {0.2, 0.2 + ale::pi / 2, 0.2}, 0.5 * degree, 1);
    const auto building = ale::building_constraint_from_walls(made.nodes, made.truth);
    EXPECT_EQ(building.priors.size(), made.nodes.size());
    EXPECT_FALSE(ale::has_heading_drift(building, made.truth));
}

TEST(BuildingDirection, DriftIsDetectedAndThePriorsAreTheTrueHeadings)
{
    const Drive made = drive(60, 0.1 * degree, {0.2, 0.2 + ale::pi / 2, 0.2}, 0, 2);
    const auto building = ale::building_constraint_from_walls(made.nodes, made.drifted);
    EXPECT_TRUE(ale::has_heading_drift(building, made.drifted));
    const double common = ale::wrapped(building.priors[0].heading_rad -
                                       made.truth[0].theta); // the building's own direction is free
    for (const ale::HeadingPrior &prior : building.priors) {
        const double off = prior.heading_rad - made.truth[static_cast<size_t>(prior.pose)].theta;
        EXPECT_NEAR(ale::wrapped(off - common), 0, 0.01 * degree);
    }
}

TEST(BuildingDirection, FurnitureAtAnAngleDoesNotTurnTheBuilding)
{
    // A chest at 25 degrees in every fifth wall's place, and in the middle of the drive nothing but chests.
    Drive made = drive(60, 0, {0, ale::pi / 2, 0, ale::pi / 2, 0.44}, 0.3 * degree, 7);
    const Drive chests = drive(60, 0, {0.44, 0.44 + ale::pi / 2}, 0.3 * degree, 8);
    std::copy(chests.nodes.begin() + 25, chests.nodes.begin() + 40, made.nodes.begin() + 25);
    const auto building = ale::building_constraint_from_walls(made.nodes, made.truth);
    EXPECT_EQ(building.priors.size(), made.nodes.size() - 15);
    EXPECT_FALSE(ale::has_heading_drift(building, made.truth));
}

// Standard deviation of the errors of the priors.
double deviation(const ale::BuildingConstraint &building, const Drive &made)
{
    double sum = 0;
    double sum2 = 0;
    for (const ale::HeadingPrior &prior : building.priors) {
        const double off =
            ale::wrapped(prior.heading_rad - made.truth[static_cast<size_t>(prior.pose)].theta - ale::pi / 8);
        sum += off;
        sum2 += off * off;
    }
    const auto count = static_cast<double>(building.priors.size());
    return std::sqrt(sum2 / count - (sum / count) * (sum / count));
}

TEST(BuildingDirection, AWrongHeadingDoesNotBiasTheGate)
{
    const Drive made = drive(400, 0, {0, 0, 0, ale::pi / 2, ale::pi / 2, ale::pi / 2}, 4 * degree, 10);
    std::vector<ale::Pose> turned = made.truth;
    for (size_t k = turned.size() / 2; k < turned.size(); k++) {
        turned[k].theta = ale::wrapped(turned[k].theta + 4 * degree);
    }
    const ale::BuildingConstraint building =
        ale::building_constraint_from_walls(made.nodes, turned, ale::WallSource::all_scans);
    double sum[2] = {0, 0};
    double count[2] = {0, 0};
    for (const ale::HeadingPrior &prior : building.priors) {
        const auto pose = static_cast<size_t>(prior.pose);
        const size_t half = pose < turned.size() / 2 ? 0 : 1;
        sum[half] += ale::wrapped(prior.heading_rad - made.truth[pose].theta);
        count[half] += 1;
    }
    EXPECT_NEAR(sum[1] / count[1], sum[0] / count[0], 0.5 * degree);
}

TEST(BuildingDirection, ScansAfterTheKeyframesAverageTheirNoise)
{
    const std::vector<double> walls{0, ale::pi / 2, 0};
    Drive made = drive(60, 0, walls, 2 * degree, 9);
    const ale::BuildingConstraint alone = ale::building_constraint_from_walls(made.nodes, made.truth);
    constexpr int scans = 8;
    for (unsigned scan = 0; scan < scans; scan++) {
        const Drive later = drive(60, 0, walls, 2 * degree, 20 + scan);
        for (size_t k = 0; k < made.nodes.size(); k++) {
            const std::vector<ale::WallDirection> &seen = later.nodes[k].walls;
            made.nodes[k].later_walls.insert(made.nodes[k].later_walls.end(), seen.begin(), seen.end());
            made.nodes[k].later_scans = scans;
        }
    }
    const ale::BuildingConstraint all =
        ale::building_constraint_from_walls(made.nodes, made.truth, ale::WallSource::all_scans);
    ASSERT_EQ(all.priors.size(), made.nodes.size());
    ASSERT_EQ(alone.priors.size(), made.nodes.size());
    EXPECT_LT(deviation(all, made), 0.5 * deviation(alone, made));
    EXPECT_GT(all.priors[0].information, 2 * alone.priors[0].information);
    EXPECT_EQ(ale::building_constraint_from_walls(made.nodes, made.truth).direction_rad, alone.direction_rad)
        << "later scans have no effect on the keyframes alone";
}

TEST(BuildingDirection, ABuildingWithoutRightAnglesGivesNoPriors)
{
    const Drive made = drive(60, 0.1 * degree, {0.2, 0.2 + ale::pi / 4, 0.2 + ale::pi / 6, 1.2}, 0, 3);
    EXPECT_TRUE(ale::building_constraint_from_walls(made.nodes, made.drifted).priors.empty());
}

TEST(BuildingDirection, AWingAtAnAngleIsNoDrift)
{
    Drive made = drive(64, 0, {0, ale::pi / 2, 0}, 0.3 * degree, 11);
    const Drive wing = drive(64, 0, {30 * degree, 120 * degree, 30 * degree}, 0.3 * degree, 12);
    std::copy(wing.nodes.begin() + 32, wing.nodes.end(), made.nodes.begin() + 32);
    const auto building = ale::building_constraint_from_walls(made.nodes, made.truth);
    EXPECT_LE(building.priors.size(), 32);
    EXPECT_FALSE(ale::has_heading_drift(building, made.truth));
}

TEST(BuildingDirection, TooFewNodesOrWallsGiveNoPriors)
{
    const Drive few = drive(5, degree, {0, 0, 0}, 0, 4);
    EXPECT_TRUE(ale::building_constraint_from_walls(few.nodes, few.drifted).priors.empty());
    Drive blind = drive(60, degree, {}, 0, 5);
    EXPECT_TRUE(ale::building_constraint_from_walls(blind.nodes, blind.drifted).priors.empty());
    EXPECT_TRUE(ale::building_constraint_from_walls({}, {}).priors.empty());
}

ale::PoseGraph chain_of(const Drive &made, double turn_sigma)
{
    ale::PoseGraph graph;
    graph.add_pose(made.drifted[0]);
    const Eigen::Matrix3d information = ale::information_from_deviations(0.01, turn_sigma);
    for (size_t k = 1; k < made.nodes.size(); k++) {
        const ale::Pose motion = ale::between(made.drifted[k - 1], made.drifted[k]);
        graph.add_pose(made.drifted[k]);
        graph.add_edge({static_cast<int>(k) - 1, static_cast<int>(k), motion, information, false});
    }
    return graph;
}

TEST(BuildingDirection, TheGraphCorrectsDriftedHeadings)
{
    const Drive made = drive(100, 0.05 * degree, {0, ale::pi / 2, 0}, 0.3 * degree, 6);
    ale::PoseGraph graph = chain_of(made, 0.003);
    for (int round = 0; round < 2; round++) {
        graph.set_building_constraint(ale::building_constraint_from_walls(made.nodes, graph.poses()));
        ASSERT_TRUE(graph.optimise(10).solved);
    }
    for (size_t k = 0; k < made.nodes.size(); k++) {
        EXPECT_NEAR(ale::wrapped(graph.poses()[k].theta - made.truth[k].theta), 0, 1.2 * degree) << k;
    }
    EXPECT_FALSE(ale::has_heading_drift(ale::building_constraint_from_walls(made.nodes, graph.poses()),
                                        graph.poses()));
}

TEST(BuildingDirection, LargeDriftIsCorrectedToo)
{
    const Drive made = drive(150, 0.35 * degree, {0, ale::pi / 2, 0}, 0.3 * degree, 13);
    ale::PoseGraph graph = chain_of(made, 0.01);
    for (int round = 0; round < 2; round++) {
        graph.set_building_constraint(ale::building_constraint_from_walls(made.nodes, graph.poses()));
        ASSERT_TRUE(graph.optimise(10).solved);
    }
    for (size_t k = 0; k < made.nodes.size(); k++) {
        EXPECT_NEAR(ale::wrapped(graph.poses()[k].theta - made.truth[k].theta), 0, 1.2 * degree) << k;
    }
}

TEST(BuildingDirection, WithoutDriftTheBoundIsTighter)
{
    EXPECT_FALSE(ale::matches_contradict(106, 100, 500, true));
    EXPECT_TRUE(ale::matches_contradict(109, 100, 500, true));
    EXPECT_FALSE(ale::matches_contradict(104, 100, 500, false));
    EXPECT_TRUE(ale::matches_contradict(106, 100, 500, false));
    EXPECT_FALSE(ale::matches_contradict(1060, 1000, 300, true)); // poor matches
    EXPECT_TRUE(ale::matches_contradict(1060, 1000, 300, false));
}

} // namespace
