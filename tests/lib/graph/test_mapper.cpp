// lib/graph/mapper: what C sees of it.
#include <cstring>

#include <gtest/gtest.h>

#include "drifting_keyframes.hpp"

extern "C" {
#include "graph/mapper.h"
}

namespace
{

struct DestroyMapper {
    void operator()(ale_mapper_t *mapper) const
    {
        ale_mapper_destroy(mapper);
    }
};
using Mapper = std::unique_ptr<ale_mapper_t, DestroyMapper>;
using Correction = std::unique_ptr<ale_correction_t>;

struct Heard {
    std::vector<Correction> corrections;
    uint32_t last_scan = 0;
};

// All keyframes, each as a tracker that takes every correction at once would place it.
Heard follow(ale_mapper_t *mapper, const std::vector<drifting_keyframes::Keyframe> &keyframes)
{
    Heard heard;
    ale_pose_t shift = {0, 0, 0};
    for (const auto &original : keyframes) {
        auto keyframe = std::make_unique<ale_keyframe_t>(*original);
        keyframe->corrections = static_cast<uint32_t>(heard.corrections.size());
        keyframe->map = ale_pose_compose(shift, original->map);
        EXPECT_EQ(ale_mapper_add(mapper, keyframe.get()), 0);
        auto correction = std::make_unique<ale_correction_t>();
        if (ale_mapper_correction(mapper, correction.get())) {
            shift = ale_pose_compose(correction->shift[correction->count - 1].shift, shift);
            heard.corrections.push_back(std::move(correction));
        }
        heard.last_scan = original->scan;
    }
    return heard;
}

double error_m(const ale_pose_t &pose, const ale::Pose &truth)
{
    return std::hypot(pose.x_um * 1e-6 - truth.x, pose.y_um * 1e-6 - truth.y);
}

TEST(Mapper, CorrectionsTakeTheTrackerWhereTheGraphPutsIt)
{
    const auto keyframes = drifting_keyframes::walk(1.25, 0.0008, 2);
    const std::vector<ale::Pose> truth = ring_corridor::truth(1.25);
    const Mapper mapper(ale_mapper_create(ALE_MAPPER_KEYFRAMES));
    const Heard heard = follow(mapper.get(), keyframes);
    ASSERT_GT(heard.corrections.size(), 0U);
    const uint32_t count = ale_mapper_statistics(mapper.get()).keyframes;
    ASSERT_EQ(count, keyframes.size());
    double tracked = 0;
    double corrected = 0;
    for (uint32_t k = 0; k < count; k++) {
        // the way a wall goes that was born in this keyframe
        ale_pose_t moved = keyframes[k]->map;
        for (const Correction &correction : heard.corrections) {
            moved = ale_pose_compose(ale_correction_at(correction.get(), 10 * k), moved);
        }
        const ale_mapper_pose_t placed = ale_mapper_pose(mapper.get(), k);
        EXPECT_EQ(placed.scan, 10 * k);
        EXPECT_NEAR(moved.x_um, placed.pose.x_um, 6000) << k;
        EXPECT_NEAR(moved.y_um, placed.pose.y_um, 6000) << k;
        tracked = std::max(tracked, error_m(keyframes[k]->map, truth[k]));
        corrected = std::max(corrected, error_m(placed.pose, truth[k]));
    }
    EXPECT_GT(tracked, 0.5);
    EXPECT_LT(corrected, 0.25);
}

// Only some keyframes are held, and what was born in one that is not moves with the one before
// it.
TEST(Mapper, AFullMapperThinsOutAndStaysRight)
{
    const auto keyframes = drifting_keyframes::walk(1.4, 0.0008, 2);
    const std::vector<ale::Pose> truth = ring_corridor::truth(1.4);
    constexpr uint32_t capacity = 70;
    const Mapper mapper(ale_mapper_create(capacity));
    const Heard heard = follow(mapper.get(), keyframes);
    const ale_mapper_statistics_t statistics = ale_mapper_statistics(mapper.get());
    EXPECT_EQ(statistics.keyframes, capacity);
    EXPECT_EQ(statistics.keyframes + statistics.thinned, keyframes.size());
    ASSERT_GT(heard.corrections.size(), 0U);
    for (const Correction &correction : heard.corrections) {
        EXPECT_LE(correction->count, capacity);
    }
    for (uint32_t k = 0; k < capacity; k++) {
        const ale_mapper_pose_t placed = ale_mapper_pose(mapper.get(), k);
        ASSERT_EQ(placed.scan % 10, 0U);
        EXPECT_LT(error_m(placed.pose, truth[placed.scan / 10]), 0.3) << k;
        if (k > 0) {
            EXPECT_GT(placed.scan, ale_mapper_pose(mapper.get(), k - 1).scan);
        }
    }
    EXPECT_GT(error_m(keyframes.back()->map, truth.back()), 0.5);
}

TEST(Mapper, ACorrectionIsDueAFixedNumberOfScansAfterItsKeyframe)
{
    const auto keyframes = drifting_keyframes::walk(1.1, 0.0008, 1);
    const Mapper mapper(ale_mapper_create(ALE_MAPPER_KEYFRAMES));
    for (const auto &keyframe : keyframes) {
        ale_mapper_add(mapper.get(), keyframe.get());
        auto correction = std::make_unique<ale_correction_t>();
        if (ale_mapper_correction(mapper.get(), correction.get())) {
            EXPECT_EQ(correction->due, keyframe->scan + ALE_CORRECTION_DELAY_SCANS);
            EXPECT_EQ(correction->epoch, 1U);
            EXPECT_FALSE(ale_mapper_correction(mapper.get(), correction.get())) << "handed out once";
            return;
        }
    }
    FAIL() << "no loop was closed";
}

std::unique_ptr<ale_map_t> corridor_map()
{
    auto map = std::make_unique<ale_map_t>();
    for (const ring_corridor::Wall &w : ring_corridor::walls()) {
        ale_map_line_t &line = map->line[map->line_count++];
        line.start = {convert::um(w.a.x()), convert::um(w.a.y())};
        line.end = {convert::um(w.b.x()), convert::um(w.b.y())};
        line.seen = 50;
    }
    return map;
}

// Half a lap: no place is seen twice, so that nothing but the map can tell of the drift.
TEST(Mapper, KeyframesAreLaidOnTheMapThatTheDriveBeganIn)
{
    const auto keyframes = drifting_keyframes::walk(0.55, 0.0012, 2);
    const std::vector<ale::Pose> truth = ring_corridor::truth(0.55);
    const Mapper mapper(ale_mapper_create(ALE_MAPPER_KEYFRAMES));
    ASSERT_EQ(ale_mapper_know(mapper.get(), 1, corridor_map().get()), 0);
    ASSERT_GT(follow(mapper.get(), keyframes).corrections.size(), 0U);
    double under_way = 0;
    for (uint32_t k = 0; k < keyframes.size(); k++) {
        under_way = std::max(under_way, error_m(ale_mapper_pose(mapper.get(), k).pose, truth[k]));
    }
    while (ale_mapper_refine(mapper.get())) {
    }
    double tracked = 0;
    double refined = 0;
    for (uint32_t k = 0; k < keyframes.size(); k++) {
        tracked = std::max(tracked, error_m(keyframes[k]->map, truth[k]));
        refined = std::max(refined, error_m(ale_mapper_pose(mapper.get(), k).pose, truth[k]));
    }
    EXPECT_GT(tracked, 0.3);
    EXPECT_LT(under_way, 0.1);
    EXPECT_LT(refined, 0.02);
}

TEST(Mapper, WhatWasKnownOfAMapIsNotBelievedOfTheNext)
{
    const auto keyframes = drifting_keyframes::walk(0.55, 0.0012, 2);
    const Mapper mapper(ale_mapper_create(ALE_MAPPER_KEYFRAMES));
    ASSERT_EQ(ale_mapper_know(mapper.get(), 7, corridor_map().get()), 0);
    EXPECT_EQ(follow(mapper.get(), keyframes).corrections.size(), 0U);
}

TEST(Mapper, AMapBegunAnewBeginsTheGraphAnew)
{
    const auto keyframes = drifting_keyframes::walk(0.1, 0, 1);
    const Mapper mapper(ale_mapper_create(ALE_MAPPER_KEYFRAMES));
    for (const auto &keyframe : keyframes) {
        ale_mapper_add(mapper.get(), keyframe.get());
    }
    auto next = std::make_unique<ale_keyframe_t>(*keyframes.front());
    next->epoch = 2;
    ale_mapper_add(mapper.get(), next.get());
    EXPECT_EQ(ale_mapper_statistics(mapper.get()).keyframes, 1U);
}

TEST(Mapper, TheSameKeyframesGiveTheSameBytes)
{
    const auto keyframes = drifting_keyframes::walk(1.1, 0.0008, 1);
    const Mapper mappers[2] = {Mapper(ale_mapper_create(ALE_MAPPER_KEYFRAMES)),
                               Mapper(ale_mapper_create(ALE_MAPPER_KEYFRAMES))};
    const Heard heard[2] = {follow(mappers[0].get(), keyframes), follow(mappers[1].get(), keyframes)};
    ASSERT_EQ(heard[0].corrections.size(), heard[1].corrections.size());
    for (size_t k = 0; k < heard[0].corrections.size(); k++) {
        EXPECT_EQ(std::memcmp(heard[0].corrections[k].get(), heard[1].corrections[k].get(),
                              sizeof(ale_correction_t)),
                  0);
    }
}

} // namespace
