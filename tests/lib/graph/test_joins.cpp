// lib/graph/mapper: maps that it joins by itself, and those that it must not.
#include <gtest/gtest.h>

#include <cstdlib>

#include "alike_worlds.hpp"

namespace
{

using namespace alike_worlds;
using namespace maps_drive;

// One drive, up to three with ALE_LONG_TESTS=1 (make test-all).
unsigned seeds(unsigned most)
{
    return std::getenv("ALE_LONG_TESTS") ? most : 1;
}

// The wheels have lost a little.
ale_pose_t nearby()
{
    return ale::to_core({1.5, -1, 0.4});
}

// They have told a wrong way.
ale_pose_t far_off()
{
    return ale::to_core({12, -8, 1.5});
}

struct Outcome {
    uint32_t maps_driven = 0; // not joined while driving
    uint32_t joined_at = 0;   // keyframe
    uint32_t maps = 0;        // not joined in the end
    bool in_first = false;    // and the drive is in the first
    double error_m = 0;       // of the worst node, where all is joined
};

// Drives with a tracker that begins a new map at keyframe `begun`, off by this, and does as corrections say;
// refines. prior: the first map as it was saved, or null. unwatched_s: how long no scans came before that
// map.
Outcome drive(const Walls &walls, const Path &path, size_t begun, unsigned seed, ale_pose_t off = nearby(),
              const ale_map_t *prior = nullptr, ale_claim_t claim = ALE_CLAIM_NEAR, int unwatched_s = 0)
{
    Keyframes keyframes = keyframes_along(walls, path, seed);
    begin_map(keyframes, begun, keyframes.size(), 1, off, claim);
    for (size_t k = 0; k < keyframes.size(); k++) { // half a metre a second
        keyframes[k]->stamp_us = static_cast<int64_t>(k) * 800000 + (k < begun ? 0 : unwatched_s * 1000000);
    }
    const Mapper mapper(ale_mapper_create(ALE_MAPPER_KEYFRAMES));
    if (prior) {
        EXPECT_EQ(ale_mapper_set_prior_map(mapper.get(), 1, prior), 0);
    }
    const auto correction = std::make_unique<ale_correction_t>();
    ale_pose_t shift = {0, 0, 0};
    uint32_t corrections = 0;
    uint32_t map_id = 0;
    bool joined = false;
    Outcome outcome;
    for (size_t k = 0; k < keyframes.size(); k++) {
        ale_keyframe_t &keyframe = *keyframes[k];
        keyframe.map_id = joined ? map_id : keyframe.map_id;
        keyframe.map = ale_pose_compose(shift, keyframe.map);
        keyframe.corrections = corrections;
        EXPECT_EQ(ale_mapper_add(mapper.get(), &keyframe), 0);
        if (ale_mapper_correction(mapper.get(), correction.get())) {
            corrections++;
            shift = ale_pose_compose(correction->shift[correction->count - 1].shift, shift);
            if (correction->joins) {
                EXPECT_EQ(correction->joined_map_id, 1U);
                joined = true;
                map_id = correction->into_map_id;
                outcome.joined_at = static_cast<uint32_t>(k);
            }
        }
    }
    outcome.maps_driven = ale_mapper_statistics(mapper.get()).maps;
    while (ale_mapper_refine(mapper.get())) {
    }
    outcome.maps = ale_mapper_statistics(mapper.get()).maps;
    outcome.in_first = ale_mapper_pose(mapper.get(), 0).map_id == ALE_FIRST_MAP;
    for (size_t k = 0; outcome.maps == 1 && k < path.size(); k++) {
        outcome.error_m = std::max(outcome.error_m, error_m(mapper.get(), k, path[k]));
    }
    return outcome;
}

Path joined_paths(Path first, const Path &second)
{
    first.insert(first.end(), second.begin(), second.end());
    return first;
}

// From the first room through the corridor into the second.
Path through_both_rooms()
{
    return path_through({{0.8, 5.8 - 2.5},
                         {2.5, 4.2},
                         {3.6, 4.6},
                         {2.5, 3},
                         {2.5, 1},
                         {10.5, 1},
                         {10.5, 4.2},
                         {11.6, 4.6},
                         {9, 3.2},
                         {10.4, 4.4}});
}

// Within the second room only.
Path in_second_room()
{
    return path_through(
        {{9.2, 3.2}, {10.5, 4.2}, {11.6, 4.6}, {11.8, 3.2}, {10, 3}, {9.2, 3.6}, {10.5, 4.4}, {11.8, 3.4}});
}

TEST(Joins, OfTwoEqualRoomsNeitherIsTaken)
{
    const Path known = through_both_rooms();
    for (unsigned seed = 1; seed <= seeds(3); seed++) {
        const Outcome outcome =
            drive(two_rooms(0.4), joined_paths(known, in_second_room()), known.size(), seed);
        EXPECT_EQ(outcome.maps_driven, 2U);
        EXPECT_EQ(outcome.maps, 2U);
    }
}

// Wheels that have told of the way deny the room that they have not led to.
TEST(Joins, OfTwoEqualRoomsThatIsTakenWhichWheelsHaveLedTo)
{
    const Path path = joined_paths(through_both_rooms(), in_second_room());
    const size_t begun = through_both_rooms().size();
    const Outcome outcome = drive(two_rooms(0.4), path, begun, 1, nearby(), nullptr, ALE_CLAIM_DRIVEN);
    EXPECT_EQ(outcome.maps_driven, 1U);
    EXPECT_LT(outcome.error_m, 0.15);
}

TEST(Joins, AMapThatWheelsHaveLedToIsNotJoinedElsewhere)
{
    const Path path =
        joined_paths(through_both_rooms(),
                     path_through({{10.5, 4.2}, {10.5, 1}, {4, 1}, {2.5, 1}, {2.5, 3}, {2.5, 1}, {10.5, 1}}));
    const size_t begun = through_both_rooms().size();
    EXPECT_EQ(drive(two_rooms(0), path, begun, 1, far_off()).maps, 1U);
    EXPECT_EQ(drive(two_rooms(0), path, begun, 1, far_off(), nullptr, ALE_CLAIM_DRIVEN).maps, 2U);
}

// Where nothing has told of the way, a few nodes near where the robot stood before are no more than
// elsewhere.
TEST(Joins, WhereNobodyWatchedTheRobotMayBeAnywhere)
{
    const Path known = through_both_rooms();
    const Path path = joined_paths(known, path_through({{10.5, 4.2}, {10.5, 1}, {8, 1}}));
    EXPECT_EQ(drive(two_rooms(0), path, known.size(), 1).maps, 1U);
    EXPECT_EQ(drive(two_rooms(0), path, known.size(), 1, nearby(), nullptr, ALE_CLAIM_REACHED, 1).maps, 2U);
}

// When all is known few nodes are enough where the robot can have got to in the time.
TEST(Joins, AfterTheDriveAPlaceWithinReachOfARobotThatNobodyWatchedIsTaken)
{
    const Path known = through_both_rooms();
    const Path path = joined_paths(known, path_through({{10.5, 4.2}, {10.5, 1}, {8, 1}}));
    const Outcome outcome =
        drive(two_rooms(0), path, known.size(), 1, nearby(), nullptr, ALE_CLAIM_REACHED, 4);
    EXPECT_EQ(outcome.maps_driven, 2U);
    EXPECT_EQ(outcome.maps, 1U);
    EXPECT_LT(outcome.error_m, 0.15);
}

// A room that is like no other, and nowhere like itself.
Walls odd_room()
{
    Walls walls = {{0, 0, 7, 0},       {7, 0, 7, 3},       {7, 3, 4.2, 3},
                   {4.2, 3, 4.2, 5.4}, {4.2, 5.4, 0, 5.4}, {0, 5.4, 0, 0}};
    add_box(&walls, 1.4, 3.6, 2.2, 4.2);
    add_box(&walls, 5.6, 1.9, 6.1, 3);
    add_box(&walls, 2.8, 0, 3.1, 0.7);
    return walls;
}

// Three metres are enough, wherever the robot was carried, if nothing that is known looks like that place.
TEST(Joins, AfterTheDriveAPlaceThatNothingResemblesIsTakenHoweverFar)
{
    const Path known =
        path_through({{0.8, 1}, {4.5, 1.2}, {4.2, 2.4}, {3, 3}, {3, 4.6}, {0.8, 4.6}, {0.7, 1.4}});
    const Path path = joined_paths(known, path_through({{4.8, 1.4}, {3.2, 2.4}, {3.2, 4}}));
    const Outcome outcome =
        drive(odd_room(), path, known.size(), 1, far_off(), nullptr, ALE_CLAIM_REACHED, 60);
    EXPECT_EQ(outcome.maps_driven, 2U);
    EXPECT_EQ(outcome.maps, 1U);
    EXPECT_LT(outcome.error_m, 0.15);
}

// The corridor beyond the second room is not known; the first room explains it nearly as well.
TEST(Joins, UnknownGroundThatLooksLikeKnownIsNotTakenForIt)
{
    const Path known = through_both_rooms();
    const Path out =
        path_through({{10, 3}, {10.5, 4.2}, {11.6, 4.4}, {10.5, 3.4}, {10.5, 1}, {16, 1}, {16.2, 1.2}});
    const Outcome outcome = drive(two_rooms(0.4), joined_paths(known, out), known.size(), 1);
    EXPECT_EQ(outcome.maps_driven, 2U);
    EXPECT_TRUE(outcome.maps == 2 || outcome.error_m < 0.15);
}

// Without the second niche.
TEST(Joins, WhatIsBesideTheRoomsTellsThemApart)
{
    const Path known = through_both_rooms();
    const Path along = path_through({{10.5, 4.2}, {10.5, 1}, {4, 1}, {2.5, 1}, {2.5, 3}});
    for (unsigned seed = 1; seed <= seeds(2); seed++) {
        const Outcome outcome = drive(two_rooms(0), joined_paths(known, along), known.size(), seed);
        EXPECT_EQ(outcome.maps_driven, 1U) << "as soon as it has seen enough";
        EXPECT_GT(outcome.joined_at, known.size());
        EXPECT_EQ(outcome.maps, 1U);
        EXPECT_LT(outcome.error_m, 0.15);
    }
}

TEST(Joins, ACorridorThatIsTheSameAfterHalfATurnIsNotJoined)
{
    const Path known = path_through({{-7, 0.1}, {7, 0.1}, {7, -0.1}, {-7, -0.1}});
    const Path again = path_through({{-6, 0}, {6, 0}, {6.4, 0}, {1, 0}});
    for (unsigned seed = 1; seed <= seeds(2); seed++) {
        const Outcome outcome = drive(turned_corridor(0), joined_paths(known, again), known.size(), seed);
        EXPECT_EQ(outcome.maps_driven, 2U);
        EXPECT_EQ(outcome.maps, 2U);
    }
}

TEST(Joins, OneBoxTellsBothEndsOfTheCorridorApart)
{
    const Path known = path_through({{-7, 0.3}, {7, 0.3}, {7, 0.1}, {-7, 0.1}});
    const Path again = path_through({{-6, 0.2}, {4.4, 0.2}, {5, 0.4}, {1, 0.4}});
    for (unsigned seed = 1; seed <= seeds(2); seed++) {
        const Outcome outcome = drive(turned_corridor(0.9), joined_paths(known, again), known.size(), seed);
        EXPECT_EQ(outcome.maps, 1U);
        EXPECT_LT(outcome.error_m, 0.15);
    }
}

// A bare corridor holds nothing along it.
TEST(Joins, ABareCorridorIsNotJoined)
{
    const Walls walls = {{-30, -1, 30, -1}, {30, -1, 30, 1}, {30, 1, -30, 1}, {-30, 1, -30, -1}};
    const Path known = path_through({{-15, 0}, {15, 0}});
    const Path again = path_through({{-5, 0}, {5, 0}});
    const Outcome outcome = drive(walls, joined_paths(known, again), known.size(), 1);
    EXPECT_EQ(outcome.maps, 2U);
}

// The whole drive in a map of its own, with a saved one loaded.
Outcome drive_lost(const Walls &walls, const std::unique_ptr<ale_map_t> &saved, const Path &path,
                   unsigned seed)
{
    return drive(walls, path, 0, seed, elsewhere(), saved.get());
}

std::unique_ptr<ale_map_t> saved_rooms(double niche)
{
    Path whole = through_both_rooms();
    whole.push_back({16, 1, 0});
    whole.push_back({-3, 1, 0});
    return map_of(two_rooms(niche), whole);
}

std::unique_ptr<ale_map_t> saved_corridor(double extra)
{
    return map_of(turned_corridor(extra), path_through({{-7, 0.3}, {7, 0.3}, {7, 0.1}, {-7, 0.1}}));
}

TEST(Joins, ADriveThatBeginsLostJoinsTheSavedMap)
{
    const Path path =
        path_through({{10.5, 4.2}, {11.6, 4.6}, {10.5, 3.4}, {10.5, 1}, {15, 1}, {4, 1}, {2.5, 1}, {2.5, 3}});
    for (unsigned seed = 1; seed <= seeds(3); seed++) {
        const Outcome outcome = drive_lost(two_rooms(0), saved_rooms(0), path, seed);
        EXPECT_TRUE(outcome.in_first);
        EXPECT_GT(outcome.joined_at, 0U) << "while driving";
        EXPECT_LT(outcome.error_m, 0.15);
    }
}

// What stands in the room and is in no map hides nothing that the robot can do without.
TEST(Joins, ASavedMapIsFoundAmongThingsThatItDoesNotHold)
{
    Walls walls = two_rooms(0);
    for (const double x : {1.2, 3.4, 9.3, 11.5}) {
        add_box(&walls, x, 2.6, x + 0.3, 2.9);
        add_box(&walls, x - 0.3, 1.6, x, 1.9);
    }
    const Path path =
        path_through({{10.5, 4.2}, {11.6, 4.6}, {10.5, 3.4}, {10.5, 1}, {4, 1}, {2.5, 1}, {2.5, 3}});
    const Outcome outcome = drive_lost(walls, saved_rooms(0), path, 1);
    EXPECT_TRUE(outcome.in_first);
    EXPECT_LT(outcome.error_m, 0.15);
}

TEST(Joins, ADriveThatBeginsLostJoinsNoMapOfAnotherPlace)
{
    const Path path = path_through({{-6, 0.2}, {6, 0.2}, {6.4, 0}, {-6, -0.2}});
    EXPECT_FALSE(drive_lost(turned_corridor(0.9), saved_rooms(0), path, 1).in_first);
}

TEST(Joins, InASavedMapOfTwoEqualRoomsNeitherIsTaken)
{
    EXPECT_FALSE(drive_lost(two_rooms(0.4), saved_rooms(0.4), in_second_room(), 1).in_first);
}

TEST(Joins, InASavedCorridorThatIsTheSameAfterHalfATurnNeitherEndIsTaken)
{
    const Path path = path_through({{-6, 0.2}, {4.4, 0.2}, {5, 0.4}, {-6, 0.4}});
    EXPECT_FALSE(drive_lost(turned_corridor(0), saved_corridor(0), path, 1).in_first);
    const Outcome told_apart = drive_lost(turned_corridor(0.9), saved_corridor(0.9), path, 1);
    EXPECT_TRUE(told_apart.in_first);
    EXPECT_LT(told_apart.error_m, 0.15);
}

// The tracker joins the map itself while the join found here is under way: that is void.
TEST(Joins, AJoinThatTheTrackerMakesFirstCounts)
{
    const Path known = through_both_rooms();
    const Path path = joined_paths(known, path_through({{10.5, 4.2}, {10.5, 1}, {4, 1}, {2.5, 1}, {2.5, 3}}));
    Keyframes keyframes = keyframes_along(two_rooms(0), path, 1);
    const Keyframes tracked = keyframes_along(two_rooms(0), path, 1);
    begin_map(keyframes, known.size(), keyframes.size(), 1, nearby());
    const Mapper mapper(ale_mapper_create(ALE_MAPPER_KEYFRAMES));
    const auto correction = std::make_unique<ale_correction_t>();
    size_t k = 0;
    while (k < keyframes.size()) {
        add(mapper.get(), keyframes, k, k + 1);
        k++;
        if (ale_mapper_correction(mapper.get(), correction.get()) && correction->joins) {
            break;
        }
        ASSERT_FALSE(ale_mapper_correction(mapper.get(), correction.get()));
    }
    ASSERT_LT(k + 1, keyframes.size());
    EXPECT_FALSE(ale_mapper_correction(mapper.get(), correction.get())) << "none until it is made";
    tell_join(keyframes, k, {1, 1, 0, undo(nearby())});
    for (size_t i = k; i < keyframes.size(); i++) {
        keyframes[i]->map = tracked[i]->map;
        keyframes[i]->map_id = 0;
        keyframes[i]->corrections = i > k ? 1 : 0; // the void one counts
    }
    add(mapper.get(), keyframes, k, keyframes.size());
    EXPECT_EQ(ale_mapper_statistics(mapper.get()).maps, 1U);
    EXPECT_EQ(ale_mapper_statistics(mapper.get()).joins, 1U);
    for (size_t i = 0; i < keyframes.size(); i++) {
        EXPECT_LT(error_m(mapper.get(), i, path[i]), 0.15) << i;
    }
    EXPECT_FALSE(ale_mapper_correction(mapper.get(), correction.get()) && correction->joins);
}

} // namespace
