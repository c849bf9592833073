// lib/track/step_recover.c: whether wheels have told of a way through a time that no scan watched.
#include <gtest/gtest.h>

#include "room_pipeline.h"

extern "C" {
#include "track/pipeline_state.h"
#include "track/step_predict.h"
#include "track/step_recover.h"
}

namespace
{

constexpr double begun = 10;   // s: the last scan before
constexpr double unseen = 4.1; // s, to the first one after

/* Whether a robot that stood, and whose wheels then tell of such a way (metres, by seconds since the last
 * scan; nothing: they are silent), has driven. */
template <typename Way> bool has_driven(const Way &way)
{
    const room::Pipeline p = room::make(ale_pipeline_default_config());
    std::mt19937 rng(1);
    const reference::Pose place(1, 0, 0.4);
    ale_estimate_t e = {};
    for (double t = begun - 3; t < begun + 0.01; t += 0.1) {
        const ale_odometry_t still = {std::llround(t * 1e6), {0, 0, 0}};
        ale_pipeline_odometry(p.get(), &still);
        const ale_scan_t scan = room::scan_at(
            room::l_shape(), room::Sensor(), [&](double) { return place; }, t, rng);
        ale_pipeline_scan(p.get(), &scan, &e);
    }
    for (double t = 0.02; t < unseen + 0.01; t += 0.02) {
        if (const std::optional<double> m = way(t)) {
            const ale_odometry_t told = {std::llround((begun + t) * 1e6),
                                         {static_cast<int32_t>(std::llround(*m * 1e6)), 0, 0}};
            ale_pipeline_odometry(p.get(), &told);
        }
    }
    const ale_prediction_t prediction = ale_step_predict(p.get(), std::llround((begun + unseen) * 1e6));
    EXPECT_TRUE(prediction.counted);
    EXPECT_TRUE(ale_recover_is_unwatched(p.get(), &prediction));
    return ale_recover_has_driven(p.get(), &prediction);
}

TEST(StepRecover, WheelsThatCountThroughTheTimeHaveTold)
{
    EXPECT_TRUE(has_driven([](double t) -> std::optional<double> { return 0.15 * t; }));
}

TEST(StepRecover, WheelsThatWereSilentAndThenTellWhatTheyCountedHaveTold)
{
    EXPECT_TRUE(has_driven([](double t) -> std::optional<double> {
        return t > 0.05 && t < 4 ? std::nullopt : std::optional<double>(0.15 * t);
    }));
}

/* A robot at 2 m/s whose wheels are dead from just after the last scan until just before the next one. */
TEST(StepRecover, WhatTheyCountAtBothEndsOfTheTimeIsNoWayThroughIt)
{
    EXPECT_FALSE(has_driven([](double t) -> std::optional<double> {
        return 2 * (std::min(t, 0.1) + std::max(0.0, t - (unseen - 0.1)));
    }));
}

TEST(StepRecover, WheelsThatStandHaveToldOfNone)
{
    EXPECT_FALSE(has_driven([](double) -> std::optional<double> { return 0; }));
}

} // namespace
