// lib/match/odometry_scale_error.c against Eigen in double, and against what a filter that takes the wheels'
// scale for noise really does in a corridor.
#include <cmath>
#include <deque>
#include <random>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "lib/motion/convert.h"

extern "C" {
#include "match/odometry_scale_error.h"
#include "motion/wheel_scale.h"
}

namespace
{
constexpr double per_mm2_q20 = 1048576;

/* What walls with such information (1/m^2) and such pulls tell. */
ale_observability_t hold_of(const Eigen::Matrix2d &information, const Eigen::Vector2d &pull)
{
    const Eigen::Matrix2d told = information * 1e-6 * per_mm2_q20;
    const Eigen::Vector2d pulled = pull * 1e-6 * per_mm2_q20 * 1e6;
    const double along = std::atan2(2 * told(0, 1), told(0, 0) - told(1, 1)) / 2 + reference::pi / 2;
    return {true,
            false,
            convert::bam(along),
            std::llround(told(0, 0)),
            std::llround(told(0, 1)),
            std::llround(told(1, 1)),
            std::llround(pulled[0]),
            std::llround(pulled[1])};
}

ale_motion_t predicted(double sigma_m)
{
    ale_motion_t motion;
    ale_motion_init(&motion, 0, {0, 0, convert::bam(0.6)}, 1, 1);
    ale_motion_widen(&motion, convert::um(sigma_m), 1000);
    return motion;
}
} // namespace

TEST(WheelDrift, AScanTakesFromItWhatItsWallsWeighBesideThePrediction)
{
    std::mt19937 rng(8);
    std::uniform_real_distribution<double> unit(0, 1);
    for (int n = 0; n < 200; n++) {
        const double sigma = 0.001 + 0.01 * unit(rng);
        Eigen::Matrix2d information = Eigen::Matrix2d::Zero();
        Eigen::Vector2d pull(0, 0);
        for (int k = 0; k < 4; k++) {
            const double a = 2 * reference::pi * unit(rng);
            const Eigen::Vector2d across(std::cos(a), std::sin(a));
            const double weight = 1 / std::pow(0.002 + 0.02 * unit(rng), 2);
            information += weight * across * across.transpose();
            pull += weight * (0.1 * unit(rng) - 0.05) * across;
        }
        const Eigen::Vector2d before(0.1 * unit(rng), 0.1 * unit(rng));
        const Eigen::Matrix2d prior = Eigen::Matrix2d::Identity() / (sigma * sigma);
        const Eigen::Vector2d expected = (prior + information).inverse() * (prior * before + pull);
        ale_observability_t observability = hold_of(information, pull);
        observability.along_bam =
            convert::bam(6 * unit(rng)); // landmarks may turn it: what walls tell is not asked along it
        const ale_motion_t motion = predicted(sigma);
        ale_scale_error_t map_uncertainty = {convert::um(before[0]), convert::um(before[1])};
        ale_scale_error_update(&map_uncertainty, &observability, &motion);
        EXPECT_NEAR(static_cast<double>(map_uncertainty.x_um) * 1e-6, expected[0], 2e-5) << n;
        EXPECT_NEAR(static_cast<double>(map_uncertainty.y_um) * 1e-6, expected[1], 2e-5) << n;
    }
}

TEST(WheelDrift, StaysAlongBareWallsAndIsGoneWhereOldWallsHold)
{
    const ale_motion_t motion = predicted(0.003);
    ale_scale_error_t map_uncertainty = {0, 0};
    for (int k = 0; k < 100; k++) {
        ale_scale_error_predict(&map_uncertainty, {50000 * k, 0, 0}, {50000 * (k + 1), 0, 0}, 20000);
        const ale_observability_t across = hold_of(Eigen::Vector2d(0, 1e7).asDiagonal(), {0, 0});
        ale_scale_error_update(&map_uncertainty, &across, &motion);
    }
    EXPECT_NEAR(static_cast<double>(map_uncertainty.x_um), 100000, 200);
    EXPECT_EQ(ale_scale_error_along(&map_uncertainty, -(1 << 30), 0), -map_uncertainty.x_um);
    for (int k = 0; k < 20; k++) {
        const ale_observability_t determined = hold_of(Eigen::Vector2d(1e6, 1e7).asDiagonal(), {0, 0});
        ale_scale_error_update(&map_uncertainty, &determined, &motion);
    }
    EXPECT_NEAR(static_cast<double>(map_uncertainty.x_um), 0, 10);
}

/* A filter that takes wheels and walls for independent, along a corridor with a door frame every two metres,
 * each seen from three metres on. It learns the scale of its wheels from the ways that it found, as the unit
 * does; what it does not know is what was wrong with them, or with its first match. */
class CorridorFilter
{
  public:
    static constexpr double prior_weight = 1 / (0.0025 * 0.0025);
    static constexpr double frame_weight = 1 / (0.015 * 0.015);
    static constexpr double ends_m2 = 2 * 0.004 * 0.004; // of the first way
    static constexpr double prior_m2 = ends_m2 / (0.05 * 0.05);

    CorridorFilter(double counted_m, double first_match_m) : counted_m_(counted_m), excess_m_(first_match_m)
    {
    }
    // Goes on by 5 cm to `at`, where frames at these places are in view, each with the error it was born
    // with.
    void step(const std::deque<std::pair<double, double>> &frames)
    {
        const double before = error;
        error += counted_m_ * (1 + excess_m_ * way_m_ / (way_m_ * way_m_ + prior_m2)) - 0.05;
        double told = prior_weight * error;
        double weight = prior_weight;
        for (const auto &frame : frames) {
            told += frame_weight * frame.second;
            weight += frame_weight;
        }
        error = told / weight;
        excess_m_ += 0.05 + error - before - counted_m_;
        way_m_ += counted_m_;
    }
    double error = 0;

  private:
    double counted_m_;
    double excess_m_;
    double way_m_ = 0;
};

/* Where the robot gets to when one sigma is wrong with the scale of the wheels, or with the first match that
 * teaches it: the two are independent. */
TEST(WheelDrift, IsWhatAWrongScaleDoesToAFilterThatTakesItForNoise)
{
    struct Frame {
        double at;
        int32_t drift_um;
    };
    const double counted = 0.05 * 1.05;
    ale_wheel_scale_t scale;
    ale_wheel_scale_init(&scale, 50000);
    ale_scale_error_t map_uncertainty = {0, 0};
    const ale_motion_t motion = predicted(0.0025);
    std::deque<Frame> frames = {{2, 0}};
    CorridorFilter by_scale(counted, 0);
    CorridorFilter by_match(0.05, std::sqrt(CorridorFilter::ends_m2));
    std::deque<std::pair<double, double>> scale_frames = {{2, 0}};
    std::deque<std::pair<double, double>> match_frames = {{2, 0}};
    for (int k = 1; k <= 160; k++) {
        const double at = 0.05 * k;
        const int64_t drift_before = map_uncertainty.x_um;
        ale_scale_error_predict(&map_uncertainty, {convert::um(at - 0.05), 0, 0}, {convert::um(at), 0, 0},
                                ale_wheel_scale_error_ppm(&scale));
        while (frames.front().at < at) {
            frames.pop_front();
            scale_frames.pop_front();
            match_frames.pop_front();
        }
        double weight = 0;
        Eigen::Vector2d pull(0, 0);
        for (const Frame &frame : frames) {
            weight += CorridorFilter::frame_weight;
            pull[0] += CorridorFilter::frame_weight * frame.drift_um * 1e-6;
        }
        by_scale.step(scale_frames);
        by_match.step(match_frames);
        const ale_observability_t observability = hold_of(Eigen::Vector2d(weight, 1e7).asDiagonal(), pull);
        ale_scale_error_update(&map_uncertainty, &observability, &motion);
        const double next = frames.back().at + 2;
        if (next - at < 3) {
            frames.push_back({next, static_cast<int32_t>(map_uncertainty.x_um)});
            scale_frames.emplace_back(next, by_scale.error);
            match_frames.emplace_back(next, by_match.error);
        }
        const ale_wheel_lesson_t lesson = {k * 100000 - 100000, k * 100000, convert::um(counted),
                                           convert::um(counted), map_uncertainty.x_um - drift_before};
        ale_wheel_scale_learn(&scale, &lesson);
        const double error = std::hypot(by_scale.error, by_match.error);
        ASSERT_NEAR(static_cast<double>(map_uncertainty.x_um) * 1e-6, error, 0.0005 + 0.1 * error) << at;
    }
    EXPECT_GT(by_scale.error, 0.01) << "which is far from noise";
}
