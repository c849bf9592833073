// lib/match/map_uncertainty.c against Eigen in double: A^(-1/2) B A^(-1/2) over random walls, each with a
// drift that turns the map, and against random walks that bend and come back.
#include <memory>
#include <random>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "lib/map/walls.h"
#include "lib/motion/convert.h"

extern "C" {
#include "match/map_uncertainty.h"
}

namespace
{
/* Metres and radians. */
Eigen::Matrix3d matrix(const ale_map_uncertainty_t &d)
{
    Eigen::Matrix3d out;
    out << static_cast<double>(d.xx_um2), static_cast<double>(d.xy_um2), static_cast<double>(d.xt_um_urad),
        static_cast<double>(d.xy_um2), static_cast<double>(d.yy_um2), static_cast<double>(d.yt_um_urad),
        static_cast<double>(d.xt_um_urad), static_cast<double>(d.yt_um_urad), static_cast<double>(d.tt_urad2);
    return out * 1e-12;
}

ale_map_uncertainty_t map_uncertainty(const Eigen::Matrix3d &m)
{
    const auto um2 = [](double v) { return static_cast<int64_t>(std::llround(v * 1e12)); };
    return {um2(m(0, 0)), um2(m(0, 1)), um2(m(1, 1)), um2(m(0, 2)), um2(m(1, 2)), um2(m(2, 2))};
}

ale_map_uncertainty_t shifted(double sigma_m)
{
    return map_uncertainty(Eigen::Vector3d(sigma_m * sigma_m, sigma_m * sigma_m, 1e-6).asDiagonal());
}

/* What a shift and a turn about the origin make of place and heading. */
Eigen::Matrix3d lever(const Eigen::Vector2d &place)
{
    Eigen::Matrix3d j = Eigen::Matrix3d::Identity();
    j(0, 2) = -place[1];
    j(1, 2) = place[0];
    return j;
}

// Walls that a scan was matched to at a place, with a drift each.
struct Place {
    std::unique_ptr<ale_local_map_t> map = std::make_unique<ale_local_map_t>();
    std::unique_ptr<ale_fit_t> fit = std::make_unique<ale_fit_t>();
    std::vector<ale_observation_t> observations;
    Eigen::Vector2d at;
    double whole = 0;
    Eigen::Matrix2d facing = Eigen::Matrix2d::Zero();
    Eigen::Matrix2d drifted = Eigen::Matrix2d::Zero();
    Eigen::Vector2d common = Eigen::Vector2d::Zero();
    double turned = 0;

    explicit Place(const Eigen::Vector2d &place = {0, 0}) : at(place)
    {
        ale_local_map_clear(map.get());
        fit->motion.pose = {convert::um(place[0]), convert::um(place[1]), 0};
    }

    void add(double normal_rad, double length_m, const ale_map_uncertainty_t &its)
    {
        ale_wall_t wall = make_wall(0, 0, normal_rad, length_m / 2, 10);
        wall.map_uncertainty = its;
        const size_t n = observations.size();
        ale_local_map_add(map.get(), &wall);
        fit->association[n] = {static_cast<uint16_t>(map->count - 1), ALE_NO_LANDMARK, {}};
        ale_observation_t observation = {};
        observation.kind = ALE_OBSERVATION_LINE;
        observation.end_um = convert::um(length_m);
        observations.push_back(observation);
        const Eigen::Matrix3d here = lever(at) * matrix(its) * lever(at).transpose();
        const Eigen::Vector2d across(std::cos(normal_rad), std::sin(normal_rad));
        whole += length_m;
        facing += length_m * across * across.transpose();
        drifted += length_m * across.dot(here.topLeftCorner<2, 2>() * across) * across * across.transpose();
        common += length_m * across.dot(here.topRightCorner<2, 1>()) * across;
        turned += length_m * here(2, 2);
    }

    Eigen::Matrix3d got(const ale_map_uncertainty_t &before) const
    {
        const ale_map_uncertainty_t here = ale_map_uncertainty_here(
            map.get(), observations.data(), static_cast<uint32_t>(observations.size()), fit.get(), &before);
        return matrix(ale_map_uncertainty_at(&here, {fit->motion.pose.x_um, fit->motion.pose.y_um}));
    }

    Eigen::Matrix3d expected(const ale_map_uncertainty_t &before) const
    {
        const Eigen::Matrix3d old = 0.1 * lever(at) * matrix(before) * lever(at).transpose();
        const Eigen::Matrix2d a = facing + 0.1 * Eigen::Matrix2d::Identity();
        const Eigen::Matrix2d root = Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(a).operatorInverseSqrt();
        const Eigen::Matrix2d var = root * (drifted + old.topLeftCorner<2, 2>()) * root;
        Eigen::Vector2d with_turn = a.inverse() * (common + old.topRightCorner<2, 1>());
        const double may = 0.75 * turned / whole;
        with_turn *= std::min(1.0, std::sqrt(may / with_turn.dot(var.inverse() * with_turn)));
        Eigen::Matrix3d out;
        out << var, with_turn, with_turn.transpose(), turned / whole;
        return out;
    }
};
} // namespace

TEST(Drift, OfAPlaceIsTheMeanOfItsWallsEachAcrossItself)
{
    std::mt19937 rng(5);
    std::uniform_real_distribution<double> unit(0, 1);
    const auto any = [&](double most) { return most * (2 * unit(rng) - 1); };
    for (int n = 0; n < 200; n++) {
        Place place({any(40), any(40)});
        for (int k = 0; k < 5; k++) {
            const Eigen::Vector2d turned_at(any(40), any(40));
            const Eigen::Vector3d sigma(0.01 + 0.3 * unit(rng), 0.01 + 0.3 * unit(rng), 0.02 * unit(rng));
            const Eigen::Matrix3d there = sigma.cwiseAbs2().asDiagonal();
            place.add(2 * reference::pi * unit(rng), 1 + 4 * unit(rng),
                      map_uncertainty(lever(-turned_at) * there * lever(-turned_at).transpose()));
        }
        const ale_map_uncertainty_t old = shifted(0.2);
        const Eigen::Matrix3d truth = place.expected(old);
        const Eigen::Vector3d sigma = truth.diagonal().cwiseSqrt();
        const Eigen::Matrix3d off = place.got(old) - truth;
        for (int i = 0; i < 9; i++) {
            EXPECT_NEAR(off(i / 3, i % 3), 0, 3e-3 * sigma[i / 3] * sigma[i % 3]) << n << " " << i;
        }
    }
}

TEST(Drift, AlongACorridorStaysWhateverItsWallsKnowAcrossThem)
{
    Place corridor;
    corridor.add(reference::pi / 2, 8, shifted(0.005));
    corridor.add(-reference::pi / 2, 8, shifted(0.005));
    const Eigen::Matrix3d got = corridor.got({90000000000, 0, 1000000, 0, 0, 0});
    EXPECT_NEAR(std::sqrt(got(0, 0)), 0.3, 0.001);
    EXPECT_NEAR(std::sqrt(got(1, 1)), 0.005, 0.001);
    corridor.add(0, 2, shifted(0.3));
    EXPECT_NEAR(std::sqrt(corridor.got({})(0, 0)), 0.3, 0.01);
}

TEST(Drift, OfWhatIsBornIsWhatTheScanLeavesOpenThere)
{
    ale_motion_t motion;
    ale_motion_init(&motion, 0, {5000000, -3000000, convert::bam(1.0)}, 1, 1);
    ale_motion_widen(&motion, 1000, 1000);
    motion.cov.m[0][0] = int64_t{200000} * 200000;
    const ale_map_uncertainty_t none = {};
    const ale_map_uncertainty_t born = ale_map_uncertainty_inherit(&none, &motion);
    const Eigen::Matrix3d got = matrix(ale_map_uncertainty_at(&born, {5000000, -3000000}));
    EXPECT_NEAR(got(0, 0), 0.04 * std::cos(1.0) * std::cos(1.0), 4e-6);
    EXPECT_NEAR(got(0, 1), 0.04 * std::cos(1.0) * std::sin(1.0), 4e-6);
    EXPECT_NEAR(got(0, 2), 0, 1e-9);
    EXPECT_NEAR(got(2, 2), 1.1e-6, 1e-8);
}

/* What a turn of the map far out does to a place depends on how far from there it is, not on how far from the
 * origin: a way out, aside and back ends beside the origin, and far off. */
TEST(Drift, OfAWayThatComesBackIsThatOfManyRandomWalks)
{
    const int steps = 30;
    std::vector<Eigen::Vector2d> way;
    for (int k = 0; k < 3 * steps; k++) {
        const double on = static_cast<double>(k % steps) / steps;
        const std::array<Eigen::Vector2d, 3> at = {Eigen::Vector2d(26 * on, 0), Eigen::Vector2d(26, 12 * on),
                                                   Eigen::Vector2d(26 - 26 * on, 12)};
        way.push_back(at.at(static_cast<size_t>(k / steps)));
    }
    ale_motion_t motion;
    ale_motion_init(&motion, 0, {0, 0, 0}, 1, 1);
    ale_map_uncertainty_t here = {};
    for (const Eigen::Vector2d &p : way) {
        motion.pose = {convert::um(p[0]), convert::um(p[1]), 0};
        here = ale_map_uncertainty_inherit(&here, &motion);
    }
    const Eigen::Matrix3d got = matrix(ale_map_uncertainty_at(&here, {0, 12000000}));
    const double turn_sigma = std::sqrt(got(2, 2) / (3 * steps));
    std::mt19937 rng(4);
    std::normal_distribution<double> normal;
    Eigen::Matrix3d expected = Eigen::Matrix3d::Zero();
    const int walks = 4000;
    for (int n = 0; n < walks; n++) {
        Eigen::Vector3d error(0, 0, 0);
        for (size_t k = 0; k < way.size(); k++) {
            error[2] += turn_sigma * normal(rng);
            const Eigen::Vector2d next = k + 1 < way.size() ? way[k + 1] : Eigen::Vector2d(0, 12);
            const Eigen::Vector2d step = next - way[k];
            error[0] += -error[2] * step[1] + 0.001 * normal(rng);
            error[1] += error[2] * step[0] + 0.001 * normal(rng);
        }
        expected += error * error.transpose() / walks;
    }
    for (int i = 0; i < 9; i++) {
        const double scale = std::sqrt(expected(i / 3, i / 3) * expected(i % 3, i % 3));
        EXPECT_NEAR(got(i / 3, i % 3), expected(i / 3, i % 3), 0.06 * scale) << i;
    }
    EXPECT_GT(std::sqrt(got(1, 1)), 10 * turn_sigma * std::sqrt(3.0 * steps)) << "a lever of over ten metres";
}

TEST(Drift, WhatAScanLeavesOpenGrowsWithTheStepsAndInThatDirectionAlone)
{
    ale_motion_t before;
    ale_motion_init(&before, 0, {0, 0, convert::bam(0.4)}, 1, 1);
    ale_motion_t predicted = before;
    predicted.cov.m[0][0] += 1000000; /* 1 mm a step ahead, */
    predicted.cov.m[1][1] += 4000000; /* 2 mm to the left */
    ale_map_uncertainty_t here = {};
    int64_t drifted_um = 0;
    for (int k = 0; k < 50; k++) {
        ale_map_uncertainty_drift(&here, &drifted_um, convert::bam(0.4), &before, &predicted);
    }
    const double var = 50000.0 * 50000;
    EXPECT_NEAR(static_cast<double>(drifted_um), 50000, 60);
    EXPECT_NEAR(static_cast<double>(here.xx_um2), var * std::cos(0.4) * std::cos(0.4), 0.003 * var);
    EXPECT_NEAR(static_cast<double>(here.xy_um2), var * std::cos(0.4) * std::sin(0.4), 0.003 * var);
    EXPECT_NEAR(static_cast<double>(here.yy_um2), var * std::sin(0.4) * std::sin(0.4), 0.003 * var);
    drifted_um = 0; /* held, and left open again the other way: what there is stays */
    ale_map_uncertainty_drift(&here, &drifted_um, convert::bam(0.4 + reference::pi / 2), &before, &predicted);
    EXPECT_NEAR(static_cast<double>(drifted_um), 2000, 3);
    EXPECT_NEAR(static_cast<double>(here.xx_um2 + here.yy_um2), var + 4e6, 0.003 * var);
}

TEST(Drift, WhatScansLeaveOpenAgainAndAgainDoesNotGrowBeyondAnyMeaning)
{
    ale_motion_t before;
    ale_motion_init(&before, 0, {30000000, -20000000, convert::bam(0.4)}, 1, 1);
    ale_motion_t predicted = before;
    predicted.cov.m[0][0] += 250000000000; /* half a metre a step */
    ale_map_uncertainty_t here = {};
    for (int k = 0; k < 1000; k++) {
        int64_t drifted_um = 0; /* held for a moment in between */
        ale_map_uncertainty_drift(&here, &drifted_um, convert::bam(0.4), &before, &predicted);
    }
    EXPECT_GT(here.xx_um2, 3000000000000);
    EXPECT_LE(here.xx_um2, 4000000000000);
}
