// lib/graph/mapper: a tracker that begins new maps and joins them.
#include <gtest/gtest.h>

#include "joined_drive.hpp"

namespace
{

using namespace maps_drive;

using joined_drive::begun;
using joined_drive::joined;
using joined_drive::lap;
using joined_drive::laps;

Mapper mapper_of(uint32_t keyframes = ALE_MAPPER_KEYFRAMES)
{
    return Mapper(ale_mapper_create(keyframes));
}

TEST(Maps, AMapThatJoinsMovesAsOne)
{
    const Keyframes keyframes = joined_drive::keyframes(0);
    const std::vector<ale::Pose> truth = ring_corridor::truth(laps);
    const Mapper mapper = mapper_of();
    add(mapper.get(), keyframes, 0, joined);
    EXPECT_EQ(ale_mapper_statistics(mapper.get()).maps, 2U);
    EXPECT_EQ(ale_mapper_statistics(mapper.get()).joins, 0U);
    EXPECT_EQ(ale_mapper_pose(mapper.get(), begun).map_id, 1U);
    EXPECT_EQ(ale_mapper_pose(mapper.get(), begun).pose.x_um, keyframes[begun]->map.x_um);
    add(mapper.get(), keyframes, joined, keyframes.size());
    EXPECT_EQ(ale_mapper_statistics(mapper.get()).maps, 1U);
    EXPECT_EQ(ale_mapper_statistics(mapper.get()).joins, 1U);
    for (size_t k = 0; k < keyframes.size(); k++) {
        EXPECT_EQ(ale_mapper_pose(mapper.get(), static_cast<uint32_t>(k)).map_id, 0U);
        EXPECT_LT(error_m(mapper.get(), k, truth[k]), 0.4) << k;
    }
}

// What has joined is tied: it is drawn tight together with the other map.
TEST(Maps, AfterTheDriveAJoinedMapLiesOnTheOther)
{
    const Keyframes keyframes = joined_drive::keyframes(0.0003);
    const std::vector<ale::Pose> truth = ring_corridor::truth(laps);
    const Mapper mapper = mapper_of();
    add(mapper.get(), keyframes, 0, keyframes.size());
    while (ale_mapper_refine(mapper.get())) {
    }
    for (size_t k = joined; k < keyframes.size(); k++) {
        const ale::Pose earlier =
            ale::from_core(ale_mapper_pose(mapper.get(), static_cast<uint32_t>(k - lap)).pose);
        const ale::Pose later = ale::from_core(ale_mapper_pose(mapper.get(), static_cast<uint32_t>(k)).pose);
        const ale::Pose seen = ale::between(earlier, later);
        const ale::Pose true_way = ale::between(truth[k - lap], truth[k]);
        EXPECT_LT(std::hypot(seen.x - true_way.x, seen.y - true_way.y), 0.03) << k;
    }
}

// The prediction has put the second map upon the first: nothing ties them all the same.
TEST(Maps, NothingIsMatchedAcrossMaps)
{
    Keyframes keyframes = drifting_keyframes::walk(laps, 0.0008, 3);
    begin_map(keyframes, begun, keyframes.size(), 1, {0, 0, 0});
    const Mapper mapper = mapper_of();
    add(mapper.get(), keyframes, 0, keyframes.size());
    const ale_mapper_statistics_t statistics = ale_mapper_statistics(mapper.get());
    EXPECT_EQ(statistics.candidates, 0U);
    EXPECT_EQ(statistics.maps, 2U);
    for (size_t k = 0; k < keyframes.size(); k++) {
        EXPECT_EQ(ale_mapper_pose(mapper.get(), static_cast<uint32_t>(k)).pose.x_um, keyframes[k]->map.x_um);
    }
}

// A loop within the second map moves that alone.
TEST(Maps, ALoopInOneMapLeavesTheOtherWhereItIs)
{
    Keyframes keyframes = drifting_keyframes::walk(1.4, 0.0008, 2);
    constexpr size_t first = 20;
    begin_map(keyframes, first, keyframes.size(), 1, elsewhere());
    const Mapper mapper = mapper_of();
    add(mapper.get(), keyframes, 0, keyframes.size());
    EXPECT_GT(ale_mapper_statistics(mapper.get()).loops, 0U);
    for (size_t k = 0; k <= first; k++) {
        const ale_pose_t placed = ale_mapper_pose(mapper.get(), static_cast<uint32_t>(k)).pose;
        EXPECT_NEAR(placed.x_um, keyframes[k]->map.x_um, 2) << k;
        EXPECT_NEAR(placed.y_um, keyframes[k]->map.y_um, 2) << k;
    }
    const auto correction = std::make_unique<ale_correction_t>();
    ASSERT_TRUE(ale_mapper_correction(mapper.get(), correction.get()));
    for (uint32_t scan = 0; scan < 10 * first; scan++) {
        const ale_pose_t shift = ale_correction_at(correction.get(), scan);
        EXPECT_NEAR(shift.x_um, 0, 2);
        EXPECT_NEAR(shift.y_um, 0, 2);
    }
}

// The tracker joins maps before it has applied a correction of the one that moves.
TEST(Maps, ACorrectionUnderWayMovesWithTheMapThatJoins)
{
    Keyframes keyframes = drifting_keyframes::walk(1.4, 0.0008, 2);
    begin_map(keyframes, 20, keyframes.size(), 1, elsewhere());
    const Mapper mapper = mapper_of();
    const auto correction = std::make_unique<ale_correction_t>();
    size_t k = 0;
    for (; k < keyframes.size(); k++) {
        add(mapper.get(), keyframes, k, k + 1);
        if (ale_mapper_correction(mapper.get(), correction.get())) {
            break;
        }
    }
    ASSERT_LT(k + 1, keyframes.size());
    std::vector<ale_pose_t> before;
    for (uint32_t i = 0; i <= k; i++) {
        before.push_back(ale_mapper_pose(mapper.get(), i).pose);
    }
    const ale_pose_t shift = undo(elsewhere());
    tell_join(keyframes, k + 1, {1, 1, 0, shift});
    const ale_pose_t tracked = keyframes[k + 1]->map;
    keyframes[k + 1]->map = ale_pose_compose(shift, tracked);
    keyframes[k + 1]->map_id = 0;
    add(mapper.get(), keyframes, k + 1, k + 2);
    const ale_pose_t corrected =
        ale_pose_compose(shift, ale_pose_compose(correction->shift[correction->count - 1].shift, tracked));
    const ale_pose_t placed = ale_mapper_pose(mapper.get(), static_cast<uint32_t>(k + 1)).pose;
    EXPECT_NEAR(placed.x_um, corrected.x_um, 20000);
    EXPECT_NEAR(placed.y_um, corrected.y_um, 20000);
    for (uint32_t i = 20; i <= k; i++) {
        const ale_pose_t moved = ale_pose_compose(shift, before[i]);
        EXPECT_NEAR(ale_mapper_pose(mapper.get(), i).pose.x_um, moved.x_um, 20000) << i;
        EXPECT_NEAR(ale_mapper_pose(mapper.get(), i).pose.y_um, moved.y_um, 20000) << i;
    }
}

TEST(Maps, OfSeveralJoinsSinceTheLastKeyframeOnlyTheToldOneIsMade)
{
    Keyframes keyframes = drifting_keyframes::walk(0.5, 0, 3);
    begin_map(keyframes, 20, 30, 1, elsewhere());
    begin_map(keyframes, 30, 50, 2, elsewhere());
    tell_join(keyframes, 50, {2, 2, 0, undo(elsewhere())});
    const Mapper mapper = mapper_of();
    add(mapper.get(), keyframes, 0, keyframes.size());
    EXPECT_EQ(ale_mapper_statistics(mapper.get()).maps, 2U);
    EXPECT_EQ(ale_mapper_pose(mapper.get(), 20).map_id, 1U);
    EXPECT_EQ(ale_mapper_pose(mapper.get(), 30).map_id, 0U);
    EXPECT_EQ(ale_mapper_pose(mapper.get(), 60).map_id, 0U);
}

// Map 2 joins 1, and later 1 joins 0: all of it moves twice.
TEST(Maps, AMapJoinsWithAllThatHasJoinedIt)
{
    Keyframes keyframes = drifting_keyframes::walk(0.5, 0, 3);
    begin_map(keyframes, 20, 30, 1, elsewhere());
    begin_map(keyframes, 30, 40, 2, {0, 7000000, 0});
    const Keyframes truth = drifting_keyframes::walk(0.5, 0, 3);
    const ale_pose_t to_first = ale_pose_compose(elsewhere(), undo({0, 7000000, 0}));
    for (size_t k = 40; k < 50; k++) {
        keyframes[k]->map_id = 1;
        keyframes[k]->map = ale_pose_compose(elsewhere(), keyframes[k]->map);
    }
    tell_join(keyframes, 40, {1, 2, 1, to_first});
    tell_join(keyframes, 50, {2, 1, 0, undo(elsewhere())});
    const Mapper mapper = mapper_of();
    add(mapper.get(), keyframes, 0, keyframes.size());
    EXPECT_EQ(ale_mapper_statistics(mapper.get()).maps, 1U);
    EXPECT_EQ(ale_mapper_statistics(mapper.get()).joins, 2U);
    for (size_t k = 0; k < keyframes.size(); k++) {
        EXPECT_LT(error_m(mapper.get(), k, ale::from_core(truth[k]->map)), 0.1) << k;
    }
}

// The walls of a map move with the scan that saw them first: from its first keyframe on.
TEST(Maps, TheFirstKeyframeOfAMapIsHeld)
{
    Keyframes keyframes = drifting_keyframes::walk(1.2, 0, 3);
    for (uint32_t map = 1; map < 8; map++) {
        begin_map(keyframes, 20 * map, 20 * map + 20, map, elsewhere());
    }
    begin_map(keyframes, 160, keyframes.size(), 8, elsewhere());
    const Mapper mapper = mapper_of(64);
    add(mapper.get(), keyframes, 0, keyframes.size());
    EXPECT_EQ(ale_mapper_statistics(mapper.get()).keyframes, 64U);
    EXPECT_EQ(ale_mapper_statistics(mapper.get()).maps, 9U);
    for (uint32_t map = 0; map < 9; map++) {
        uint32_t first = 0;
        while (ale_mapper_pose(mapper.get(), first).map_id != map) {
            first++;
        }
        EXPECT_EQ(ale_mapper_pose(mapper.get(), first).scan, 200 * map);
    }
}

// More maps than keyframes that are held.
TEST(Maps, AGraphOfManyMapsIsThinned)
{
    Keyframes keyframes = drifting_keyframes::walk(0.7, 0, 3);
    for (uint32_t k = 0; k < keyframes.size(); k++) {
        keyframes[k]->map_id = k;
        keyframes[k]->broken = true;
    }
    const Mapper mapper = mapper_of(64);
    add(mapper.get(), keyframes, 0, keyframes.size());
    EXPECT_EQ(ale_mapper_statistics(mapper.get()).keyframes, 64U);
    EXPECT_EQ(ale_mapper_statistics(mapper.get()).maps, 64U);
}

TEST(Maps, ThePriorMapIsThatOfTheFirstMap)
{
    Keyframes keyframes = drifting_keyframes::walk(0.5, 0.0012, 2);
    begin_map(keyframes, 10, keyframes.size(), 1, {0, 0, 0});
    const Mapper mapper = mapper_of();
    ASSERT_EQ(ale_mapper_set_prior_map(mapper.get(), 1, drifting_keyframes::corridor_map().get()), 0);
    add(mapper.get(), keyframes, 0, keyframes.size());
    for (size_t k = 10; k < keyframes.size(); k++) {
        EXPECT_EQ(ale_mapper_pose(mapper.get(), static_cast<uint32_t>(k)).pose.x_um, keyframes[k]->map.x_um);
    }
}

} // namespace
