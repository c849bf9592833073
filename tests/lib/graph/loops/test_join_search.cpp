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
};

TEST(JoinSearch, AfterTheDriveTheSmallerMapIsSearchedInTheLarger)
{
    Drive drive;
    drive.add_map(0, 9);
    drive.add_map(1, 4);
    std::set<int> queries;
    for (const ale::JoinTask &task : ale::tasks_after_drive({drive.nodes, drive.poses, {}, nullptr})) {
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
    EXPECT_TRUE(ale::tasks_after_drive({drive.nodes, drive.poses, {}, nullptr}).empty());
}

} // namespace
