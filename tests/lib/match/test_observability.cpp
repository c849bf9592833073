// lib/match/observability.c against Eigen in double: the least eigenvalue of what walls tell, and landmarks
// that tell nothing.
#include <memory>
#include <random>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "lib/map/walls.h"
#include "lib/motion/convert.h"

extern "C" {
#include "match/observability.h"
}

namespace
{
// What a robot at a heading sees of a map.
struct Scene {
    std::unique_ptr<ale_local_map_t> map = std::make_unique<ale_local_map_t>();
    std::unique_ptr<ale_fit_t> fit = std::make_unique<ale_fit_t>();
    std::vector<ale_observation_t> observations;
    Eigen::Matrix2d told = Eigen::Matrix2d::Zero();
    Eigen::Vector2d pull = Eigen::Vector2d::Zero();
    double heading_rad;

    explicit Scene(double heading = 0.3) : heading_rad(heading)
    {
        ale_local_map_clear(map.get());
        fit->motion.pose.theta_bam = convert::bam(heading);
    }

    void see(double normal_rad, double length_m, double sigma_m, double sigma_rad,
             ale_observation_kind_t kind, const ale_association_t &association)
    {
        ale_observation_t observation = {};
        observation.kind = kind;
        observation.normal_bam = convert::bam(normal_rad - heading_rad);
        observation.start_um = -convert::um(length_m / 2);
        observation.end_um = convert::um(length_m / 2);
        observation.var_offset_um2 = std::llround(sigma_m * sigma_m * 1e12);
        observation.var_angle_urad2 = std::llround(sigma_rad * sigma_rad * 1e12);
        fit->association[observations.size()] = association;
        observations.push_back(observation);
    }

    void add_wall(double normal_rad, double sigma_m, double drift_m = 0)
    {
        ale_wall_t wall = make_wall(0, 0, normal_rad, 1);
        wall.scale_error_um = convert::um(drift_m);
        ale_local_map_add(map.get(), &wall);
        see(normal_rad, 1, sigma_m, 0.01, ALE_OBSERVATION_LINE,
            {static_cast<uint16_t>(map->count - 1), ALE_NO_LANDMARK, {}});
        const Eigen::Vector2d n(std::cos(normal_rad), std::sin(normal_rad));
        told += n * n.transpose() / (sigma_m * sigma_m + 4e-6);
        pull += n * drift_m / (sigma_m * sigma_m + 4e-6);
    }

    void add_mark(double mark_normal_rad, double normal_rad, double length_m, double sigma_rad, int seen)
    {
        const int32_t index = static_cast<int32_t>(observations.size());
        map->landmarks.landmark[index] = {};
        map->landmarks.landmark[index].normal_bam = convert::bam(mark_normal_rad);
        map->landmarks.landmark[index].var_um2 = 9000000;
        map->landmarks.landmark[index].seen = static_cast<uint16_t>(seen);
        see(normal_rad, length_m, 0.015, sigma_rad, ALE_OBSERVATION_SEGMENT, {ALE_NO_WALL, index, {}});
    }

    ale_observability_t observability() const
    {
        return ale_observability_of(map.get(), observations.data(),
                                    static_cast<uint32_t>(observations.size()), fit.get());
    }
};

// Two long walls that face each other across the way.
Scene corridor()
{
    Scene scene;
    scene.add_wall(reference::pi / 2, 0.003);
    scene.add_wall(-reference::pi / 2, 0.003);
    return scene;
}
} // namespace

TEST(Hold, WallsHoldWhatTheLeastEigenvalueOfTheirInformationSays)
{
    std::mt19937 rng(11);
    std::uniform_real_distribution<double> unit(0, 1);
    int determined = 0;
    for (int n = 0; n < 500; n++) {
        Scene scene;
        const double first = 2 * reference::pi * unit(rng);
        for (int k = 0; k < 3; k++) {
            scene.add_wall(first + unit(rng), 0.002 + 0.02 * unit(rng));
        }
        const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> truth(scene.told);
        const double sigma = 1 / std::sqrt(truth.eigenvalues()[0]);
        const ale_observability_t observability = scene.observability();
        if (std::abs(sigma - 0.03) > 0.0005) {
            EXPECT_EQ(observability.determined, sigma < 0.03) << sigma;
        }
        const double along = convert::radians(observability.along_bam);
        const Eigen::Vector2d u(std::cos(along), std::sin(along));
        EXPECT_GT(std::abs(u.dot(truth.eigenvectors().col(0))), 0.9999) << n;
        determined += observability.determined;
    }
    EXPECT_GT(determined, 50);
    EXPECT_LT(determined, 450);
}

TEST(Hold, WallsPullWithWhatTheWheelsScaleHasGivenThem)
{
    Scene scene;
    scene.add_wall(0.4, 0.003, 0.02);
    scene.add_wall(2.1, 0.005, -0.05);
    scene.add_mark(reference::pi, reference::pi, 0.1, 0.15, 20);
    const ale_observability_t observability = scene.observability();
    const double per_m2 = 1e6 / 1048576; /* of what is said per mm^2 in Q20 */
    EXPECT_NEAR(static_cast<double>(observability.xx_q20) * per_m2, scene.told(0, 0),
                1e-3 * scene.told.trace());
    EXPECT_NEAR(static_cast<double>(observability.xy_q20) * per_m2, scene.told(0, 1),
                1e-3 * scene.told.trace());
    EXPECT_NEAR(static_cast<double>(observability.yy_q20) * per_m2, scene.told(1, 1),
                1e-3 * scene.told.trace());
    EXPECT_NEAR(static_cast<double>(observability.bias_x_q20) * per_m2 * 1e-6, scene.pull[0],
                1e-3 * scene.pull.norm());
    EXPECT_NEAR(static_cast<double>(observability.bias_y_q20) * per_m2 * 1e-6, scene.pull[1],
                1e-3 * scene.pull.norm());
}

TEST(Hold, WhatFacesTheRobotOutOfAGrazingWallHoldsNothing)
{
    Scene scene = corridor();
    EXPECT_FALSE(scene.observability().determined);
    for (int k = 0; k < 4; k++) {
        scene.add_mark(reference::pi, reference::pi, 0.12, 0.6, 20); /* of no direction of its own */
    }
    EXPECT_FALSE(scene.observability().determined);
    EXPECT_NEAR(std::abs(std::cos(convert::radians(scene.observability().along_bam))), 1, 1e-3);
}

TEST(Hold, ASurfaceAcrossTheWayHoldsOnceItWasSeenThreeTimes)
{
    Scene once = corridor();
    once.add_mark(reference::pi, reference::pi, 0.1, 0.15, 2);
    EXPECT_FALSE(once.observability().determined);
    Scene confirmed = corridor();
    confirmed.add_mark(reference::pi, reference::pi, 0.1, 0.15, 3);
    EXPECT_TRUE(confirmed.observability().determined);
}

TEST(Hold, WhereNothingTellsTheWayToTwentyCentimetresItIsBare)
{
    Scene scene = corridor();
    EXPECT_TRUE(scene.observability().degenerate);
    scene.add_mark(reference::pi, reference::pi, 0.5, 0.5, 20);
    EXPECT_TRUE(scene.observability().degenerate) << "to 250 mm";
    scene.add_mark(reference::pi, reference::pi, 0.2, 0.5, 20);
    EXPECT_FALSE(scene.observability().degenerate) << "to 100 mm";
    EXPECT_FALSE(scene.observability().determined);
}

TEST(Hold, APieceOfTheWallThatMetAMarkWhichFacesAlongHoldsNothing)
{
    Scene scene = corridor();
    scene.add_mark(reference::pi, 0.6 * reference::pi, 0.15, 0.15, 20);
    EXPECT_FALSE(scene.observability().determined);
}
