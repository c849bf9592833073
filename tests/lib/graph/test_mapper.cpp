// lib/graph/mapper: the C interface.
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

struct Received {
    std::vector<Correction> corrections;
    uint32_t last_scan = 0;
};

// Adds all keyframes, with the poses of a tracker that applies every correction at once.
Received follow(ale_mapper_t *mapper, const std::vector<drifting_keyframes::Keyframe> &keyframes)
{
    Received received;
    ale_pose_t shift = {0, 0, 0};
    for (const auto &original : keyframes) {
        auto keyframe = std::make_unique<ale_keyframe_t>(*original);
        keyframe->corrections = static_cast<uint32_t>(received.corrections.size());
        keyframe->map = ale_pose_compose(shift, original->map);
        EXPECT_EQ(ale_mapper_add(mapper, keyframe.get()), 0);
        auto correction = std::make_unique<ale_correction_t>();
        if (ale_mapper_correction(mapper, correction.get())) {
            shift = ale_pose_compose(correction->shift[correction->count - 1].shift, shift);
            received.corrections.push_back(std::move(correction));
        }
        received.last_scan = original->scan;
    }
    return received;
}

double error_m(const ale_pose_t &pose, const ale::Pose &truth)
{
    return std::hypot(pose.x_um * 1e-6 - truth.x, pose.y_um * 1e-6 - truth.y);
}

TEST(Mapper, CorrectionsMoveTheTrackerToTheGraph)
{
    const auto keyframes = drifting_keyframes::walk(1.25, 0.0008, 2);
    const std::vector<ale::Pose> truth = ring_corridor::truth(1.25);
    const Mapper mapper(ale_mapper_create(ALE_MAPPER_KEYFRAMES));
    const Received received = follow(mapper.get(), keyframes);
    ASSERT_GT(received.corrections.size(), 0U);
    const uint32_t count = ale_mapper_statistics(mapper.get()).keyframes;
    ASSERT_EQ(count, keyframes.size());
    double tracked = 0;
    double corrected = 0;
    for (uint32_t k = 0; k < count; k++) {
        // as a wall first seen in this keyframe moves
        ale_pose_t moved = keyframes[k]->map;
        for (const Correction &correction : received.corrections) {
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

// A wall first seen in a removed keyframe moves with the keyframe before it.
TEST(Mapper, AFullMapperIsThinnedAndStaysRight)
{
    const auto keyframes = drifting_keyframes::walk(1.4, 0.0008, 2);
    const std::vector<ale::Pose> truth = ring_corridor::truth(1.4);
    constexpr uint32_t capacity = 70;
    const Mapper mapper(ale_mapper_create(capacity));
    const Received received = follow(mapper.get(), keyframes);
    const ale_mapper_statistics_t statistics = ale_mapper_statistics(mapper.get());
    EXPECT_EQ(statistics.keyframes, capacity);
    EXPECT_EQ(statistics.keyframes + statistics.thinned, keyframes.size());
    ASSERT_GT(received.corrections.size(), 0U);
    for (const Correction &correction : received.corrections) {
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

// Half a lap: no place is seen twice, so that only the prior map can correct the drift.
TEST(Mapper, KeyframesAreMatchedWithThePriorMap)
{
    const auto keyframes = drifting_keyframes::walk(0.55, 0.0012, 2);
    const std::vector<ale::Pose> truth = ring_corridor::truth(0.55);
    const Mapper mapper(ale_mapper_create(ALE_MAPPER_KEYFRAMES));
    ASSERT_EQ(ale_mapper_set_prior_map(mapper.get(), 1, drifting_keyframes::corridor_map().get()), 0);
    ASSERT_GT(follow(mapper.get(), keyframes).corrections.size(), 0U);
    double while_driving = 0;
    for (uint32_t k = 0; k < keyframes.size(); k++) {
        while_driving = std::max(while_driving, error_m(ale_mapper_pose(mapper.get(), k).pose, truth[k]));
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
    EXPECT_LT(while_driving, 0.1);
    EXPECT_LT(refined, 0.02);
}

TEST(Mapper, APriorMapOfAnotherEpochIsNotUsed)
{
    const auto keyframes = drifting_keyframes::walk(0.55, 0.0012, 2);
    const Mapper mapper(ale_mapper_create(ALE_MAPPER_KEYFRAMES));
    ASSERT_EQ(ale_mapper_set_prior_map(mapper.get(), 7, drifting_keyframes::corridor_map().get()), 0);
    EXPECT_EQ(follow(mapper.get(), keyframes).corrections.size(), 0U);
}

TEST(Mapper, ANewEpochStartsANewGraph)
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
    const Received received[2] = {follow(mappers[0].get(), keyframes), follow(mappers[1].get(), keyframes)};
    ASSERT_EQ(received[0].corrections.size(), received[1].corrections.size());
    for (size_t k = 0; k < received[0].corrections.size(); k++) {
        EXPECT_EQ(std::memcmp(received[0].corrections[k].get(), received[1].corrections[k].get(),
                              sizeof(ale_correction_t)),
                  0);
    }
}

} // namespace
