#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <memory>
#include <thread>
#include <vector>

#include "firmware/room.hpp"
#include "firmware/surroundings.hpp"

extern "C" {
#include "estimate/estimate.h"
}

namespace
{

constexpr int64_t kPeriod = 100000;

class Estimate : public surroundings::WithExchange
{
  protected:
    void SetUp() override
    {
        config = ale_config_default();
        estimator = ale_estimator_create(&config, &exchange);
        ASSERT_NE(estimator, nullptr);
    }
    void TearDown() override
    {
        ale_estimator_destroy(estimator);
    }

    bool push(int64_t stamp_us, bool lost = false, double x = 0)
    {
        auto *record = static_cast<ale_scan_record_t *>(ale_ring_reserve(exchange.scans));
        if (!record) {
            return false;
        }
        record->lost = lost;
        record->arrival_us = ale_clock_now_us(&exchange.clock);
        room::fill(record->scan, x, 0, stamp_us);
        ale_ring_commit(exchange.scans);
        return true;
    }
    void request(const ale_request_t &wanted)
    {
        auto *slot = static_cast<ale_request_t *>(ale_ring_reserve(exchange.requests));
        ASSERT_NE(slot, nullptr);
        *slot = wanted;
        ale_ring_commit(exchange.requests);
    }
    /* As a pipeline of its own sees it from the middle. */
    std::unique_ptr<ale_map_t> map_of_the_room()
    {
        std::vector<uint8_t> memory(ale_pipeline_size());
        auto *pipeline = reinterpret_cast<ale_pipeline_t *>(memory.data());
        EXPECT_EQ(ale_pipeline_init(pipeline, &config.pipeline), 0);
        auto scan = std::make_unique<ale_scan_t>();
        ale_estimate_t estimate;
        for (int k = 1; k <= 10; k++) {
            room::fill(*scan, 0, 0, kPeriod * k);
            ale_pipeline_scan(pipeline, scan.get(), &estimate);
        }
        auto map = std::make_unique<ale_map_t>();
        ale_pipeline_copy_map(pipeline, map.get());
        EXPECT_GE(map->line_count, 3);
        return map;
    }
    bool pop(ale_result_t &result)
    {
        if (ale_ring_ready(exchange.results) == 0) {
            return false;
        }
        result = *static_cast<ale_result_t *>(ale_ring_at(exchange.results, 0));
        ale_ring_release(exchange.results);
        return true;
    }

    ale_config_t config{};
    ale_estimator_t *estimator = nullptr;
};

TEST_F(Estimate, AScanIsAsRoughAsItsScannerIs)
{
    auto usual = std::make_unique<ale_result_t>();
    auto rough = std::make_unique<ale_result_t>();
    ASSERT_TRUE(push(kPeriod));
    ale_estimator_step(estimator);
    ASSERT_TRUE(pop(*usual));
    auto *record = static_cast<ale_scan_record_t *>(ale_ring_reserve(exchange.scans));
    record->noise = ale_noise_default();
    record->noise.bearing_nrad *= 10;
    record->lost = false;
    record->arrival_us = ale_clock_now_us(&exchange.clock);
    room::fill(record->scan, 0, 0, 2 * kPeriod);
    ale_ring_commit(exchange.scans);
    ale_estimator_step(estimator);
    ASSERT_TRUE(pop(*rough));
    ASSERT_GE(rough->features.line_count, 3);
    EXPECT_GT(rough->features.line[0].var_alpha_nrad2, 2 * usual->features.line[0].var_alpha_nrad2);
}

TEST_F(Estimate, EveryScanIsAnsweredOnceInItsOrderWithFeaturesAndTimes)
{
    auto result = std::make_unique<ale_result_t>();
    for (int k = 0; k < 20; k++) {
        ASSERT_TRUE(push(kPeriod * (k + 1)));
        ale_estimator_step(estimator);
        ASSERT_TRUE(pop(*result));
        EXPECT_EQ(result->estimate.stamp_us, kPeriod * (k + 1));
        EXPECT_EQ(result->estimate.scan, static_cast<uint32_t>(k));
        EXPECT_FALSE(result->estimate.predicted);
        EXPECT_TRUE(result->has_scan);
        EXPECT_GE(result->features.line_count, 3);
        EXPECT_NEAR(result->estimate.smooth.x_um, 0, 3000);
        EXPECT_GT(result->total_ns, 0);
        int64_t sum = 0;
        for (const int32_t stage : result->stage_ns) {
            EXPECT_GE(stage, 0);
            sum += stage;
        }
        EXPECT_LE(sum, result->total_ns);
        for (int stage = 0; stage < ALE_STAGES; stage++) {
            const int64_t span = int64_t{result->stage_end_ns[stage]} - result->stage_start_ns[stage];
            EXPECT_GE(result->stage_start_ns[stage], 0);
            EXPECT_GE(span, result->stage_ns[stage]) << "a stage takes place between its start and its end";
        }
        EXPECT_FALSE(pop(*result));
    }
}

TEST_F(Estimate, ACorrectionTakesEffectAtTheScanItIsDueAtAndIsToldWithIt)
{
    auto result = std::make_unique<ale_result_t>();
    push(kPeriod);
    ale_estimator_step(estimator);
    ASSERT_TRUE(pop(*result));
    ASSERT_EQ(ale_ring_ready(exchange.keyframes), 1U) << "the first scan is a keyframe";
    const auto *keyframe = static_cast<ale_keyframe_t *>(ale_ring_at(exchange.keyframes, 0));
    auto *correction = static_cast<ale_correction_t *>(ale_ring_reserve(exchange.corrections));
    correction->epoch = keyframe->epoch;
    correction->due = 6;
    correction->count = 1;
    correction->shift[0] = {0, {300000, 0, 0}};
    ale_ring_commit(exchange.corrections);
    const uint32_t moves = result->map_moves;
    for (int k = 1; k < 9; k++) {
        push(kPeriod * (k + 1));
        ale_estimator_step(estimator);
        ASSERT_TRUE(pop(*result));
        EXPECT_NEAR(result->estimate.map.x_um, k < 6 ? 0 : 300000, 5000) << k;
        EXPECT_NEAR(result->estimate.smooth.x_um, 0, 5000) << k;
        EXPECT_EQ(result->corrected, k == 6);
        EXPECT_EQ(result->map_moves, moves + (k < 6 ? 0 : 1))
            << "a map handed over before is not this pose's";
        EXPECT_EQ(ale_ring_ready(exchange.corrections), k < 5 ? 1U : 0U);
    }
    EXPECT_EQ(result->correction.x_um, 300000);
    EXPECT_EQ(result->corrections_late, 0u);
}

TEST_F(Estimate, ACorrectionThatComesAfterItsScanIsTakenAndCounted)
{
    auto result = std::make_unique<ale_result_t>();
    push(kPeriod);
    ale_estimator_step(estimator);
    ASSERT_TRUE(pop(*result));
    const uint32_t epoch = static_cast<ale_keyframe_t *>(ale_ring_at(exchange.keyframes, 0))->epoch;
    for (int k = 1; k < 4; k++) {
        if (k == 3) {
            auto *correction = static_cast<ale_correction_t *>(ale_ring_reserve(exchange.corrections));
            correction->epoch = epoch;
            correction->due = 2;
            correction->count = 1;
            correction->shift[0] = {0, {300000, 0, 0}};
            ale_ring_commit(exchange.corrections);
        }
        push(kPeriod * (k + 1));
        ale_estimator_step(estimator);
        ASSERT_TRUE(pop(*result));
        EXPECT_EQ(result->corrected, k == 3);
        EXPECT_EQ(result->corrections_late, k == 3 ? 1u : 0u);
    }
    const ale_shortfall_t shortfall = ale_estimator_shortfall(estimator);
    EXPECT_EQ(shortfall.scans, 4u);
    EXPECT_EQ(shortfall.overloaded, 0u);
    EXPECT_EQ(shortfall.corrections_late, 1u);
}

TEST_F(Estimate, PiecesOfTilesAreTakenOneAScanFromTheirScanOnAndThoseThatComeLaterAreCounted)
{
    exchange.has_tiles = true;
    ale_estimator_load_tiles(estimator, nullptr);
    uint32_t epoch = 0;
    const auto comes = [&](uint32_t due) {
        auto *piece = static_cast<ale_tile_change_t *>(ale_ring_reserve(exchange.tiles));
        *piece = {};
        piece->epoch = epoch;
        piece->due = due;
        piece->last = true;
        ale_ring_commit(exchange.tiles);
    };
    const auto waiting_after = [&](uint32_t scan) {
        push(kPeriod * (scan + 1));
        ale_estimator_step(estimator);
        return ale_ring_ready(exchange.tiles);
    };
    EXPECT_EQ(waiting_after(0), 0U);
    ASSERT_EQ(ale_ring_ready(exchange.whereabouts), 1U);
    epoch = static_cast<ale_whereabouts_t *>(ale_ring_at(exchange.whereabouts, 0))->epoch;
    comes(3);
    comes(3);
    EXPECT_EQ(waiting_after(1), 2U);
    EXPECT_EQ(waiting_after(2), 1U);
    EXPECT_EQ(waiting_after(3), 0U);
    EXPECT_EQ(ale_estimator_shortfall(estimator).tiles_late, 0U) << "the second one was there in time";
    comes(4);
    EXPECT_EQ(waiting_after(4), 0U);
    EXPECT_EQ(ale_estimator_shortfall(estimator).tiles_late, 1U);
}

TEST_F(Estimate, WhatScansHaveShownIsToldWhenTheRobotHasGoneOnAndWhereItStaysNowAndThen)
{
    const auto told_after = [&](int64_t stamp_us, double x) {
        EXPECT_TRUE(push(stamp_us, false, x));
        ale_estimator_step(estimator);
        auto result = std::make_unique<ale_result_t>();
        EXPECT_TRUE(pop(*result));
        return ale_ring_ready(exchange.observations);
    };
    const std::vector<uint32_t> expected = {1, 1, 1, 2, 2, 2, 3, 3, 3, 3, 3, 3};
    for (size_t k = 0; k < expected.size(); k++) {
        EXPECT_EQ(told_after(kPeriod * static_cast<int64_t>(k + 1), 0), expected[k]) << k;
    }
    EXPECT_EQ(told_after(kPeriod * 13, 0.05), 3U);
    for (int k = 14; k <= 30; k++) {
        told_after(kPeriod * k, 0.15); // the smooth pose follows in its own time
    }
    const uint32_t there = ale_ring_ready(exchange.observations);
    EXPECT_GT(there, 3U);
    EXPECT_LE(there, 8U);
    EXPECT_EQ(told_after(kPeriod * 31, 0.15), there);
    EXPECT_EQ(told_after(kPeriod * 82, 0.15), there + 1);
    const auto *last = static_cast<ale_scan_observation_t *>(ale_ring_at(exchange.observations, there));
    EXPECT_EQ(last->scan, 31U);
    EXPECT_GE(last->line_count, 3U);
}

TEST_F(Estimate, ALostScanIsAnsweredByPrediction)
{
    auto result = std::make_unique<ale_result_t>();
    push(kPeriod);
    push(2 * kPeriod, true);
    push(3 * kPeriod);
    ale_estimator_step(estimator);
    ASSERT_TRUE(pop(*result));
    ASSERT_TRUE(pop(*result));
    EXPECT_TRUE(result->estimate.predicted);
    EXPECT_FALSE(result->has_scan);
    EXPECT_EQ(result->estimate.stamp_us, 2 * kPeriod);
    EXPECT_EQ(result->overloaded, 0u);
    ASSERT_TRUE(pop(*result));
    EXPECT_FALSE(result->estimate.predicted);
    EXPECT_EQ(result->estimate.scan, 2u);
}

TEST_F(Estimate, WhenOverloadedTheNewestScansWinAndTheOthersAreCounted)
{
    auto result = std::make_unique<ale_result_t>();
    constexpr int kCount = 12;
    for (int k = 0; k < kCount; k++) {
        push(kPeriod * (k + 1));
    }
    ale_estimator_step(estimator);
    for (int k = 0; k < kCount; k++) {
        ASSERT_TRUE(pop(*result));
        const bool old = kCount - 1 - k > ALE_MAX_BACKLOG;
        EXPECT_EQ(result->estimate.predicted, old) << k;
        EXPECT_EQ(result->estimate.stamp_us, kPeriod * (k + 1));
    }
    EXPECT_EQ(result->overloaded, static_cast<uint32_t>(kCount - 1 - ALE_MAX_BACKLOG));
}

TEST_F(Estimate, AFullResultRingIsCountedAndTheTaskGoesOn)
{
    auto result = std::make_unique<ale_result_t>();
    for (int k = 0; k < ALE_RESULT_SLOTS + 5; k++) {
        push(kPeriod * (k + 1));
        ale_estimator_step(estimator);
    }
    EXPECT_EQ(ale_ring_refused(exchange.results), 5u);
    while (pop(*result)) {
    }
    push(kPeriod * 1000);
    ale_estimator_step(estimator);
    ASSERT_TRUE(pop(*result));
    EXPECT_EQ(result->estimate.scan, static_cast<uint32_t>(ALE_RESULT_SLOTS + 5));
}

TEST_F(Estimate, AScanThatIsAnsweredAfterItsDeadlineIsCounted)
{
    auto result = std::make_unique<ale_result_t>();
    push(kPeriod);
    static_cast<ale_scan_record_t *>(ale_ring_at(exchange.scans, 0))->arrival_us -= ALE_DEADLINE_US + 1;
    ale_estimator_step(estimator);
    ASSERT_TRUE(pop(*result));
    EXPECT_EQ(result->late, 1u);
}

TEST_F(Estimate, OdometryMovesThePredictedPose)
{
    auto result = std::make_unique<ale_result_t>();
    push(kPeriod);
    ale_estimator_step(estimator);
    for (int k = 0; k <= 60; k++) {
        auto *sample = static_cast<ale_odometry_t *>(ale_ring_reserve(exchange.odometry));
        *sample = {kPeriod / 2 + k * 10000, {k * 5000, 0, 0}}; // 0.5 m/s
        ale_ring_commit(exchange.odometry);
    }
    for (int k = 2; k <= 5; k++) {
        push(kPeriod * k, true);
        ale_estimator_step(estimator);
    }
    EXPECT_EQ(ale_ring_ready(exchange.odometry), 0u);
    while (pop(*result)) {
    }
    EXPECT_NEAR(result->estimate.smooth.x_um, 200000, 20000);
}

TEST_F(Estimate, TheMapIsHandedOverWhenItHasChangedAndNotMoreThanOnceASecond)
{
    auto result = std::make_unique<ale_result_t>();
    const int64_t begin = ale_rt_now_ns();
    const ale_map_t *map = nullptr;
    int handed = 0;
    for (int64_t stamp = kPeriod; !map || map->line_count < 3; stamp += kPeriod) {
        push(stamp);
        ale_estimator_step(estimator);
        pop(*result);
        bool fresh = false;
        map = static_cast<const ale_map_t *>(ale_snapshot_newest(exchange.map, &fresh));
        handed += fresh;
    }
    const int64_t seconds = (ale_rt_now_ns() - begin) / 1000000000;
    EXPECT_GE(handed, 1);
    EXPECT_LE(handed, seconds + 1);
}

TEST_F(Estimate, ALoadedMapIsShownBeforeTheFirstScan)
{
    auto map = std::make_unique<ale_map_t>();
    map->version = 1;
    map->line_count = 1;
    map->line[0].id = 1;
    map->line[0].start = {1000000, -1000000};
    map->line[0].end = {1000000, 1000000};
    map->line[0].var_alpha_nrad2 = 1000000000;
    map->line[0].var_rho_um2 = 1000000;
    map->line[0].seen = 50;
    ale_estimator_load_map(estimator, map.get(), nullptr);
    ale_estimator_step(estimator);
    bool fresh = false;
    EXPECT_EQ(static_cast<const ale_map_t *>(ale_snapshot_newest(exchange.map, &fresh))->line_count, 1);
    EXPECT_TRUE(fresh);
}

TEST_F(Estimate, AConfigurationThatTheCoreRefusesGivesNoEstimator)
{
    config.pipeline.extract.smooth_span = 4;
    EXPECT_EQ(ale_estimator_create(&config, &exchange), nullptr);
}

/* The task as it runs: a producer and a consumer in threads of their own (for the thread sanitizer). */
TEST_F(Estimate, AsATaskItAnswersEverythingBeforeItEnds)
{
    constexpr int kCount = 300;
    const ale_rt_task_config_t description = {"estimate", ALE_RT_HARD, ale_estimator_run, estimator, 0};
    ale_rt_task_t *task = ale_rt_task_start(&description);
    ASSERT_NE(task, nullptr);
    std::atomic<bool> done{false};
    int answers = 0;
    int disorder = 0;
    std::thread consumer([&] {
        auto result = std::make_unique<ale_result_t>();
        bool fresh = false;
        int64_t stamp_us = 0;
        for (bool last = false; !last;) {
            last = done;
            while (pop(*result)) {
                disorder += result->estimate.stamp_us <= stamp_us;
                stamp_us = result->estimate.stamp_us;
                answers++;
            }
            ale_snapshot_newest(exchange.map, &fresh);
            std::this_thread::yield();
        }
    });
    for (int k = 0; k < kCount;) {
        if (push(kPeriod * (k + 1), k % 7 == 3)) {
            k++;
        } else {
            std::this_thread::yield();
        }
        ale_rt_release_post(exchange.arrived);
    }
    ale_rt_task_stop(task);
    ale_rt_release_post(exchange.arrived);
    ale_rt_task_join(task);
    done = true;
    consumer.join();
    EXPECT_EQ(disorder, 0);
    EXPECT_EQ(answers, kCount - static_cast<int>(ale_ring_refused(exchange.results)));
}

TEST_F(Estimate, AResetBetweenTwoScansMakesTheNextOneTheOrigin)
{
    auto result = std::make_unique<ale_result_t>();
    const auto drive_to = [&](int k, double x) {
        ASSERT_TRUE(push(kPeriod * k, false, x));
        ale_estimator_step(estimator);
        ASSERT_TRUE(pop(*result));
    };
    for (int k = 1; k <= 10; k++) {
        drive_to(k, 0.02 * k);
    }
    EXPECT_NEAR(result->estimate.map.x_um, 180000, 5000);
    request({ALE_REQUEST_RESET, false, false, {}});
    drive_to(11, 0.2);
    EXPECT_NEAR(result->estimate.map.x_um, 0, 5000);
}

TEST_F(Estimate, ALoadedMapWithAKnownPoseIsWhereTheRobotIs)
{
    auto result = std::make_unique<ale_result_t>();
    ale_exchange_load(&exchange, map_of_the_room().get());
    request({ALE_REQUEST_LOAD_MAP, true, false, {300000, 0, 0}});
    for (int k = 1; k <= 10; k++) {
        ASSERT_TRUE(push(kPeriod * k, false, 0.3));
        ale_estimator_step(estimator);
        ASSERT_TRUE(pop(*result));
    }
    EXPECT_NEAR(result->estimate.map.x_um, 300000, 10000);
    EXPECT_EQ(result->estimate.state, ALE_STATE_GOOD);
}

TEST_F(Estimate, RelocationPutsTheRobotWhereTheOperatorSays)
{
    auto result = std::make_unique<ale_result_t>();
    for (int k = 1; k <= 20; k++) {
        ASSERT_TRUE(push(kPeriod * k));
        ale_estimator_step(estimator);
        ASSERT_TRUE(pop(*result));
        if (k == 10) {
            request({ALE_REQUEST_RELOCATE, false, false, {100000, 50000, 0}});
        }
        if (k == 11) {
            EXPECT_NE(result->estimate.state, ALE_STATE_LOST);
        }
    }
    EXPECT_NEAR(result->estimate.map.x_um, 0, 10000) << "what it sees says otherwise, and it is near enough";
}

TEST_F(Estimate, AFrozenMapStaysAsItIs)
{
    auto result = std::make_unique<ale_result_t>();
    for (const bool frozen : {true, false}) {
        request({ALE_REQUEST_FREEZE, false, frozen, {}});
        bool changed = false;
        for (int k = 1; k <= 10; k++) {
            ASSERT_TRUE(push(kPeriod * (k + (frozen ? 0 : 10))));
            ale_estimator_step(estimator);
            ASSERT_TRUE(pop(*result));
            changed = changed || result->estimate.map_changed;
        }
        EXPECT_NE(changed, frozen);
    }
}

} // namespace
