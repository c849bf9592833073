// lib/track/drift.c against Eigen in double: A^(-1/2) B A^(-1/2) over random walls.
#include <memory>
#include <random>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "convert.h"
#include "walls.h"

extern "C" {
#include "track/drift.h"
}

namespace
{
// Walls that a scan was matched to, with a drift each.
struct Place {
    std::unique_ptr<ale_local_map_t> map = std::make_unique<ale_local_map_t>();
    std::unique_ptr<ale_fit_t> fit = std::make_unique<ale_fit_t>();
    std::vector<ale_view_t> views;
    Eigen::Matrix2d facing = Eigen::Matrix2d::Zero();
    Eigen::Matrix2d drifted = Eigen::Matrix2d::Zero();

    Place()
    {
        ale_local_map_clear(map.get());
    }

    void add(double normal_rad, double length_m, double sigma_m)
    {
        ale_wall_t wall = make_wall(0, 0, normal_rad, length_m / 2, 10);
        wall.drift = {std::llround(sigma_m * sigma_m * 1e12), 1000000};
        const size_t n = views.size();
        ale_local_map_add(map.get(), &wall);
        fit->match[n] = {static_cast<uint16_t>(map->count - 1), ALE_NO_MARK, {}};
        ale_view_t view = {};
        view.kind = ALE_VIEW_WALL;
        view.end_um = convert::um(length_m);
        views.push_back(view);
        const Eigen::Vector2d across(std::cos(normal_rad), std::sin(normal_rad));
        facing += length_m * across * across.transpose();
        drifted += length_m * sigma_m * sigma_m * across * across.transpose();
    }

    Eigen::Matrix2d got(const ale_drift_here_t &before) const
    {
        const ale_drift_here_t here =
            ale_drift_here(map.get(), views.data(), static_cast<uint32_t>(views.size()), fit.get(), &before);
        Eigen::Matrix2d out;
        out << static_cast<double>(here.xx_um2), static_cast<double>(here.xy_um2),
            static_cast<double>(here.xy_um2), static_cast<double>(here.yy_um2);
        return out * 1e-12;
    }
};
} // namespace

TEST(Drift, OfAPlaceIsTheMeanOfItsWallsEachAcrossItself)
{
    std::mt19937 rng(5);
    std::uniform_real_distribution<double> unit(0, 1);
    for (int n = 0; n < 200; n++) {
        Place place;
        for (int k = 0; k < 5; k++) {
            place.add(2 * reference::pi * unit(rng), 1 + 4 * unit(rng), 0.01 + 0.3 * unit(rng));
        }
        const Eigen::Matrix2d old = 0.04 * Eigen::Matrix2d::Identity();
        const Eigen::Matrix2d a = place.facing + 0.1 * Eigen::Matrix2d::Identity();
        const Eigen::Matrix2d root = Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(a).operatorInverseSqrt();
        const Eigen::Matrix2d truth = root * (place.drifted + 0.1 * old) * root;
        const double size = truth.trace();
        EXPECT_LT((place.got({40000000000, 0, 40000000000, 0}) - truth).norm(), 1e-3 * size);
    }
}

TEST(Drift, AlongACorridorStaysWhateverItsWallsKnowAcrossThem)
{
    Place corridor;
    corridor.add(reference::pi / 2, 8, 0.005);
    corridor.add(-reference::pi / 2, 8, 0.005);
    const Eigen::Matrix2d got = corridor.got({90000000000, 0, 1000000, 0});
    EXPECT_NEAR(std::sqrt(got(0, 0)), 0.3, 0.001);
    EXPECT_NEAR(std::sqrt(got(1, 1)), 0.005, 0.001);
    corridor.add(0, 2, 0.3);
    EXPECT_NEAR(std::sqrt(corridor.got({0, 0, 0, 0})(0, 0)), 0.3, 0.01);
}

TEST(Drift, AWallIsBornWithWhatIsUnknownAcrossIt)
{
    ale_motion_t motion;
    ale_motion_init(&motion, 0, {0, 0, convert::bam(1.0)}, 1, 1);
    ale_motion_widen(&motion, 1000, 1000);
    motion.cov.m[0][0] = int64_t{200000} * 200000;
    const ale_drift_here_t here = {0, 0, 0, 0};
    const double along =
        std::sqrt(static_cast<double>(ale_drift_of_new_wall(&here, &motion, convert::bam(1.0)).var_um2));
    const double aside = std::sqrt(static_cast<double>(
        ale_drift_of_new_wall(&here, &motion, convert::bam(1.0 + reference::pi / 2)).var_um2));
    EXPECT_NEAR(along, 200000, 100);
    EXPECT_LT(aside, 4000);
    const ale_drift_here_t on = ale_drift_go_on(&here, &motion);
    EXPECT_NEAR(static_cast<double>(on.xx_um2), 4e10 * std::cos(1.0) * std::cos(1.0), 2e7);
    EXPECT_NEAR(static_cast<double>(on.xy_um2), 4e10 * std::cos(1.0) * std::sin(1.0), 2e7);
}

TEST(Drift, WhatAScanLeavesOpenGrowsWithTheStepsAndInThatDirectionAlone)
{
    ale_motion_t before;
    ale_motion_init(&before, 0, {0, 0, convert::bam(0.4)}, 1, 1);
    ale_motion_t predicted = before;
    predicted.cov.m[0][0] += 1000000; /* 1 mm a step ahead, */
    predicted.cov.m[1][1] += 4000000; /* 2 mm to the left */
    ale_drift_here_t here = {0, 0, 0, 0};
    int64_t slid_um = 0;
    for (int k = 0; k < 50; k++) {
        ale_drift_slide(&here, &slid_um, convert::bam(0.4), &before, &predicted);
    }
    const double var = 50000.0 * 50000;
    EXPECT_NEAR(static_cast<double>(slid_um), 50000, 60);
    EXPECT_NEAR(static_cast<double>(here.xx_um2), var * std::cos(0.4) * std::cos(0.4), 0.003 * var);
    EXPECT_NEAR(static_cast<double>(here.xy_um2), var * std::cos(0.4) * std::sin(0.4), 0.003 * var);
    EXPECT_NEAR(static_cast<double>(here.yy_um2), var * std::sin(0.4) * std::sin(0.4), 0.003 * var);
    slid_um = 0; /* held, and left open again the other way: what there is stays */
    ale_drift_slide(&here, &slid_um, convert::bam(0.4 + reference::pi / 2), &before, &predicted);
    EXPECT_NEAR(static_cast<double>(slid_um), 2000, 3);
    EXPECT_NEAR(static_cast<double>(here.xx_um2 + here.yy_um2), var + 4e6, 0.003 * var);
}
