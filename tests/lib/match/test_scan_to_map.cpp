// lib/map/wall.c and scan_to_map.c against their twins in double.
#include <memory>
#include <random>

#include <gtest/gtest.h>

#include "lib/map/walls.h"
#include "lib/motion/convert.h"

extern "C" {
#include "match/scan_to_map.h"
#include "relocate/hypothesis.h"
}

namespace
{
// A room of four walls and a niche about the origin, and what a robot at a pose sees of it.
struct Scene {
    std::unique_ptr<ale_local_map_t> map = std::make_unique<ale_local_map_t>();
    std::vector<ale_observation_t> observations;
    std::vector<reference::WallPair> pairs;

    Scene()
    {
        ale_local_map_clear(map.get());
        const double walls[5][4] = {{3, 0, reference::pi, 2},
                                    {0, 2, -reference::pi / 2, 3},
                                    {-3, 0, 0, 2},
                                    {0, -2, reference::pi / 2, 3},
                                    {2, 1.2, -2.4, 0.5}};
        for (const auto &w : walls) {
            const ale_wall_t wall = make_wall(w[0], w[1], w[2], w[3], 10);
            ale_local_map_add(map.get(), &wall);
        }
    }

    void look(const reference::Pose &p, double noise, std::mt19937 &rng, uint16_t first = 0,
              uint16_t last = 4)
    {
        std::normal_distribution<double> normal;
        observations.clear();
        pairs.clear();
        for (uint16_t i = first; i <= last; i++) {
            const ale_wall_t &w = map->wall[i];
            const double angle = convert::radians(w.normal_bam);
            const Eigen::Vector2d anchor(w.anchor.x_um * 1e-6, w.anchor.y_um * 1e-6);
            const Eigen::Vector2d n(std::cos(angle), std::sin(angle));
            const Eigen::Vector2d seen =
                reference::rotation(-p[2]) * (anchor + n * noise * normal(rng) - p.head<2>());
            ale_observation_t v = {};
            v.centre = {convert::um(seen[0]), convert::um(seen[1])};
            v.normal_bam = convert::bam(angle - p[2] + noise * normal(rng));
            v.start_um = w.start_um / 2;
            v.end_um = w.end_um / 2;
            v.var_offset_um2 = 9000000;
            v.var_angle_urad2 = 9000000;
            observations.push_back(v);
            pairs.push_back({Eigen::Vector2d(v.centre.x_um * 1e-6, v.centre.y_um * 1e-6),
                             convert::radians(v.normal_bam), 13e-6, 13e-6, anchor, angle});
        }
    }

    ale_fit_t fit(const ale_motion_t &predicted)
    {
        const ale_gate_t gate = {600000, 300000, 4, 100000};
        const ale_scene_t scene = {map.get(), observations.data(), static_cast<uint32_t>(observations.size()),
                                   nullptr};
        ale_local_map_approach(map.get(), {0, 0}, 10000000);
        ale_fit_t out;
        ale_register_scan(&predicted, &scene, &gate, &out);
        return out;
    }
};

ale_motion_t at(const reference::Pose &p, double sigma_m, double sigma_rad)
{
    ale_motion_t m;
    ale_motion_init(&m, 0, convert::pose(p), 1, 1);
    ale_motion_widen(&m, convert::um(sigma_m), convert::um(sigma_rad));
    return m;
}
TEST(Hypothesis, EveryOtherRoundLooksForTheBestPairBesideTheFirst)
{
    std::mt19937 rng(11);
    Scene s;
    s.look({0.4, 0.3, -1.2}, 0, rng);
    s.observations[2].end_um -=
        500000; // the west wall is the shortest of the four, and still half as long as the east one
    const double east = s.observations[0].end_um - s.observations[0].start_um;
    const double west = s.observations[2].end_um - s.observations[2].start_um;
    double shown = 0;
    for (int k = 0; k < 4; k++) {
        shown += s.observations[k].end_um - s.observations[k].start_um;
    }
    for (const uint32_t rounds : {0U, 1U, 2U, 3U}) {
        const ale_search_t search = {0, 0, rounds};
        EXPECT_NEAR(ale_search_pair_q8(&search, s.observations.data(), 4),
                    256 * (rounds % 2 == 0 ? east : west) / shown, 1);
        EXPECT_GT(ale_search_pair_q8(&search, s.observations.data(), 2), 0) << "the only pair is taken again";
        EXPECT_EQ(ale_search_pair_q8(&search, s.observations.data(), 1), 0) << "one view is no pair";
    }
}

TEST(Hypothesis, ACallEndsWithItsRound)
{
    std::mt19937 rng(11);
    Scene s;
    s.look({0.4, 0.3, -1.2}, 0, rng);
    ale_local_map_approach(s.map.get(), {0, 0}, 10000000);
    ale_search_t search = {0, 0, 0};
    for (uint32_t round = 0; round < 4; round++) {
        ale_hypothesis_t found[ALE_MAX_HYPOTHESES];
        EXPECT_EQ(search.rounds, round);
        EXPECT_GE(ale_search(&search, s.map.get(), s.observations.data(), 4, found), 2U)
            << "a rectangle looks the same after half a turn";
    }
}

} // namespace

TEST(Refine, FindsThePoseThatItsTwinFinds)
{
    std::mt19937 rng(4);
    std::normal_distribution<double> normal;
    Scene s;
    double worst_m = 0;
    double worst_rad = 0;
    for (int n = 0; n < 300; n++) {
        const reference::Pose truth(0.5 * normal(rng), 0.4 * normal(rng), normal(rng));
        const reference::Pose start =
            reference::compose(truth, {0.04 * normal(rng), 0.04 * normal(rng), 0.02 * normal(rng)});
        s.look(truth, 0.001, rng);
        const ale_fit_t fit = s.fit(at(start, 0.05, 0.03));
        const Eigen::Matrix3d cov = Eigen::Vector3d(0.0025, 0.0025, 0.0009).asDiagonal();
        const reference::Pose twin = reference::refine(convert::pose(convert::pose(start)), cov, s.pairs);
        const reference::Pose got = convert::pose(fit.motion.pose);
        ASSERT_EQ(fit.matched, 5);
        worst_m = std::max(worst_m, (got - twin).head<2>().norm());
        worst_rad = std::max(worst_rad, std::abs(reference::wrap(got[2] - twin[2])));
    }
    EXPECT_LT(worst_m, 60e-6);
    EXPECT_LT(worst_rad, 40e-6);
}

TEST(Refine, TheErrorsOfManyPosesHaveTheCovarianceThatItStates)
{
    std::mt19937 rng(5);
    std::normal_distribution<double> normal;
    Scene s;
    double sum = 0;
    const int runs = 400;
    for (int n = 0; n < runs; n++) {
        const reference::Pose truth(0.3, -0.2, 0.4);
        s.look(truth, std::sqrt(13e-6), rng);
        const ale_fit_t fit =
            s.fit(at(reference::compose(truth, {0.03 * normal(rng), 0.03 * normal(rng), 0.01 * normal(rng)}),
                     0.03, 0.01));
        const reference::Pose off =
            reference::compose(reference::inverse(truth), convert::pose(fit.motion.pose));
        Eigen::Matrix3d cov;
        for (int i = 0; i < 9; i++) {
            cov(i / 3, i % 3) = static_cast<double>(fit.motion.cov.m[i / 3][i % 3]) * 1e-12;
        }
        const Eigen::Vector3d e(off[0], off[1], reference::wrap(off[2]));
        sum += e.dot(cov.ldlt().solve(e));
    }
    EXPECT_GT(sum / runs, 3 / 1.3);
    EXPECT_LT(sum / runs, 3 * 1.3);
}

TEST(Refine, WhatTheSceneDoesNotDetermineComesFromThePredictionWithItsVariance)
{
    std::mt19937 rng(6);
    Scene s;
    s.look({0, 0, 0}, 0, rng, 0, 0); // the wall ahead alone: nothing is known sideways
    const ale_fit_t fit = s.fit(at({0.02, 0.07, 0.01}, 0.1, 0.05));
    EXPECT_NEAR(fit.motion.pose.x_um, 0, 1500);
    EXPECT_NEAR(fit.motion.pose.y_um, 70000, 3000);
    EXPECT_GT(fit.motion.cov.m[1][1], int64_t{90000} * 90000);
    EXPECT_LT(fit.motion.cov.m[0][0], int64_t{5000} * 5000);
    EXPECT_FALSE(ale_information_determines(&fit.information, 30000));
}

TEST(Refine, WithoutAnyViewThePredictionStays)
{
    Scene s;
    const ale_motion_t predicted = at({1, 2, 0.5}, 0.1, 0.05);
    const ale_fit_t fit = s.fit(predicted);
    EXPECT_EQ(fit.matched, 0);
    EXPECT_EQ(fit.motion.pose.x_um, predicted.pose.x_um);
    EXPECT_EQ(fit.motion.pose.theta_bam, predicted.pose.theta_bam);
    EXPECT_NEAR(static_cast<double>(fit.motion.cov.m[0][0]), 1e10, 1e6);
}

/* A scan without noise, fitted once. */
struct FittedOnce {
    Scene s;
    ale_scene_t scene;
    ale_motion_t predicted = at({0.48, 0.25, -1.17}, 0.1, 0.05);
    ale_fit_t first;
    ale_gate_t gate = {250000, 200000, 6, 100000};

    FittedOnce()
    {
        std::mt19937 rng(12);
        s.look({0.4, 0.3, -1.2}, 0, rng);
        scene = {s.map.get(), s.observations.data(), 5, nullptr};
        first = s.fit(predicted);
    }

    /* Into `fit`, with `other` as working memory. */
    bool again(int32_t most_work, int64_t least_more_um, ale_fit_t *other, ale_fit_t *fit) const
    {
        const ale_second_fit_t second = {&predicted, false, predicted.pose, &gate, most_work, least_more_um};
        *fit = first;
        return ale_register_again(&scene, &second, other, fit);
    }
};

TEST(Refine, ASecondFitLooksAtNoMoreThanIsLeftUnlessItTakesOneStep)
{
    const FittedOnce fitted;
    const ale_fit_t &first = fitted.first;
    EXPECT_GE(first.work, 3 * 5 * ALE_OBSERVATION_WORK);
    int brief = 0;
    int whole = 0;
    for (int32_t most_work = 0; most_work < 4 * first.work; most_work += 50) {
        ale_fit_t fit;
        ale_fit_t other;
        fitted.again(most_work, 0, &other, &fit);
        const double off_m =
            (convert::pose(fit.motion.pose) - reference::Pose(0.4, 0.3, -1.2)).head<2>().norm();
        EXPECT_EQ(fit.matched, 5);
        if (other.iterations == 1) {
            EXPECT_EQ(whole, 0) << "it had less before, and took more steps";
            EXPECT_LT(off_m, 0.01);
            brief++;
        } else {
            EXPECT_EQ(other.iterations, ALE_REGISTER_ITERATIONS);
            EXPECT_LE(first.work + other.work, most_work);
            EXPECT_LT(off_m, 0.001);
            whole++;
        }
    }
    EXPECT_GT(brief, 10);
    EXPECT_GT(whole, 10);
}

/* Of two fits that explain alike the second is kept, unless it is to explain more. */
TEST(Refine, ASecondFitIsKeptIfItExplainsAsMuchMoreAsItMust)
{
    FittedOnce fitted;
    fitted.first.motion.stamp_us = 7;
    for (const int64_t more_um : {0, 1}) {
        ale_fit_t fit;
        ale_fit_t other;
        EXPECT_EQ(fitted.again(ALE_SCAN_WORK, more_um, &other, &fit), more_um == 0);
        EXPECT_EQ(fit.motion.stamp_us == 7, more_um > 0) << "which one is kept";
    }
}

TEST(Refine, AScanOf682BeamsHasLooksEnoughForTwoWholeFits)
{
    EXPECT_GE(ALE_SCAN_WORK - 682 * ALE_BEAM_WORK, 2 * ALE_REGISTER_ITERATIONS * ALE_ASSOCIATION_WORK);
}

TEST(Refine, AScanThatDeterminesAllDirectionsSaysSo)
{
    std::mt19937 rng(7);
    Scene s;
    s.look({0, 0, 0}, 0, rng);
    const ale_fit_t fit = s.fit(at({0, 0, 0}, 0.05, 0.03));
    EXPECT_TRUE(ale_information_determines(&fit.information, 30000));
    EXPECT_FALSE(ale_information_determines(&fit.information, 300));
}

// Twin: the Kalman filter of a wall's (offset, angle) in Eigen.
TEST(Wall, IsSharpenedAsByTheKalmanFilterInDouble)
{
    std::mt19937 rng(8);
    std::normal_distribution<double> normal;
    for (int n = 0; n < 200; n++) {
        ale_wall_t w = make_wall(1, 2, 0.7, 1.5, 10);
        Eigen::Matrix2d p = Eigen::Vector2d(4e6, 4e6).asDiagonal();
        for (int k = 0; k < 5; k++) {
            const ale_wall_error_t e = {std::llround(2000 * normal(rng)), std::llround(2000 * normal(rng)),
                                        std::llround(1e6 * normal(rng)), 0};
            const ale_point_t anchor = w.anchor;
            const double before = convert::radians(w.normal_bam);
            ale_wall_observe(&w, &e, 6000000, 5000000);
            Eigen::Matrix2d h;
            h << 1, static_cast<double>(e.t_um) * 1e-6, 0, 1;
            const Eigen::Matrix2d r = Eigen::Vector2d(6e6, 5e6).asDiagonal();
            const Eigen::Matrix2d gain = p * h.transpose() * (h * p * h.transpose() + r).inverse();
            const Eigen::Vector2d step =
                gain * Eigen::Vector2d(static_cast<double>(e.offset_um), static_cast<double>(e.angle_urad));
            p = (Eigen::Matrix2d::Identity() - gain * h) * p;
            const double moved = (w.anchor.x_um - anchor.x_um) * std::cos(before) +
                                 (w.anchor.y_um - anchor.y_um) * std::sin(before);
            EXPECT_NEAR(moved, step[0], 4);
            EXPECT_NEAR((convert::radians(w.normal_bam) - before) * 1e6, step[1], 4);
            EXPECT_NEAR(static_cast<double>(w.var_offset_um2), p(0, 0), 1e-4 * p(0, 0) + 50);
            EXPECT_NEAR(static_cast<double>(w.var_angle_urad2), p(1, 1), 1e-4 * p(1, 1) + 50);
        }
    }
}

TEST(Hypothesis, TwoViewsAndTwoWallsGiveThePose)
{
    std::mt19937 rng(9);
    std::normal_distribution<double> normal;
    Scene s;
    for (int n = 0; n < 200; n++) {
        const reference::Pose truth(normal(rng), normal(rng), 3 * normal(rng));
        s.look(truth, 0, rng);
        ale_pose_t got;
        ASSERT_TRUE(
            ale_pose_of_pair(&s.observations[0], &s.observations[1], &s.map->wall[0], &s.map->wall[1], &got));
        EXPECT_NEAR(got.x_um, truth[0] * 1e6, 20);
        EXPECT_NEAR(got.y_um, truth[1] * 1e6, 20);
        EXPECT_NEAR(reference::wrap(convert::radians(got.theta_bam) - truth[2]), 0, 3e-6);
    }
    ale_pose_t none;
    EXPECT_FALSE(
        ale_pose_of_pair(&s.observations[0], &s.observations[2], &s.map->wall[0], &s.map->wall[2], &none));
}

TEST(Hypothesis, TheSearchFindsThePlaceOfAScanInBoundedSteps)
{
    std::mt19937 rng(10);
    Scene s;
    s.look({1.1, -0.6, 2.5}, 0, rng);
    ale_local_map_approach(s.map.get(), {0, 0}, 10000000);
    ale_search_t search = {0, 0, 0};
    ale_hypothesis_t best = {};
    while (search.rounds == 0) {
        ale_hypothesis_t found[ALE_MAX_HYPOTHESES];
        const uint32_t count = ale_search(&search, s.map.get(), s.observations.data(), 5, found);
        for (uint32_t i = 0; i < count; i++) {
            best = found[i].score_um > best.score_um ? found[i] : best;
        }
    }
    EXPECT_NEAR(best.pose.x_um, 1100000, 100);
    EXPECT_NEAR(best.pose.y_um, -600000, 100);
    EXPECT_EQ(best.observations, 5);
}
