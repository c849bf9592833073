// lib/graph/loops/join_search: which nodes are searched where.
#include "graph/loops/join_search.h"

#include <set>

#include <gtest/gtest.h>

namespace
{

struct Drive {
    std::vector<ale::Node> nodes;
    std::vector<ale::Pose> poses;

    // A map along a straight way, a node every metre.
    void add_map(uint32_t map_id, int count)
    {
        for (int k = 0; k < count; k++) {
            ale::Node node{};
            node.map_id = map_id;
            nodes.push_back(node);
            poses.push_back({static_cast<double>(k), 0, 0});
        }
    }
    std::vector<ale::JoinTask> tasks(ale::MapKind kind = ale::MapKind::pieces) const
    {
        return ale::tasks_after_drive({nodes, poses, {}, nullptr}, kind);
    }
};

TEST(JoinSearch, AfterTheDriveTheSmallerMapIsSearchedInTheLarger)
{
    Drive drive;
    drive.add_map(0, 9);
    drive.add_map(1, 4);
    std::set<int> queries;
    for (const ale::JoinTask &task : drive.tasks()) {
        queries.insert(task.queries.begin(), task.queries.end());
        EXPECT_LT(task.place, 9) << "place " << task.place;
    }
    EXPECT_EQ(queries, (std::set<int>{9, 10, 11, 12}));
}

TEST(JoinSearch, WhatNoDecisionCanJoinIsNotSearched)
{
    Drive drive;
    drive.add_map(0, 9);
    drive.add_map(1, static_cast<int>(ale::JoinDecision::least_nodes) - 1);
    EXPECT_TRUE(drive.tasks().empty());
}

/* 200 maps of eight nodes, four places each, and two larger ones. */
TEST(JoinSearch, OfTooManyPiecesTheSmallestAreLeftOutAndNoDrive)
{
    Drive drive;
    drive.add_map(0, 60);
    for (uint32_t map_id = 1; map_id <= 200; map_id++) {
        drive.add_map(map_id, 8);
    }
    drive.add_map(201, 40);
    const auto pairs_of = [](const std::vector<ale::JoinTask> &tasks) {
        size_t pairs = 0;
        for (const ale::JoinTask &task : tasks) {
            pairs += task.queries.size();
        }
        return pairs;
    };
    const std::vector<ale::JoinTask> of_pieces = drive.tasks();
    EXPECT_GT(pairs_of(of_pieces), 39000);
    EXPECT_LE(pairs_of(of_pieces), 40000);
    EXPECT_GT(pairs_of(drive.tasks(ale::MapKind::drives)), 600000);
    std::set<int> queries;
    for (const ale::JoinTask &task : of_pieces) {
        queries.insert(task.queries.begin(), task.queries.end());
    }
    EXPECT_TRUE(queries.count(60 + 200 * 8)) << "the second largest";
}

TEST(JoinSearch, NoneOfSomeLargePiecesIsLeftOut)
{
    Drive drive;
    std::set<uint32_t> wanted;
    for (uint32_t map_id = 0; map_id < ALE_ATLAS_MAPS; map_id++) {
        drive.add_map(map_id, 600 - static_cast<int>(map_id));
        wanted.insert(map_id);
    }
    wanted.erase(0); // the largest
    std::set<uint32_t> searched;
    for (const ale::JoinTask &task : drive.tasks()) {
        for (const int query : task.queries) {
            searched.insert(drive.nodes[static_cast<size_t>(query)].map_id);
        }
    }
    EXPECT_EQ(searched, wanted);
}

} // namespace
