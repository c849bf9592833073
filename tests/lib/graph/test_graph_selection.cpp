// lib/graph/graph_selection, and mapper_graph as the mapper fills it.
#include <algorithm>
#include <map>
#include <set>

#include <gtest/gtest.h>

#include "graph/graph_selection.h"
#include "joined_drive.hpp"

namespace
{

using namespace maps_drive;
using joined_drive::begun;
using joined_drive::joined;

using Graph = std::unique_ptr<ale_mapper_graph_t>;

Graph graph_of(const ale_mapper_t *mapper)
{
    auto graph = std::make_unique<ale_mapper_graph_t>();
    EXPECT_TRUE(ale_mapper_graph(mapper, graph.get()));
    return graph;
}

std::map<uint8_t, uint32_t> kinds_of(const ale_mapper_graph_t &graph)
{
    std::map<uint8_t, uint32_t> count;
    std::for_each(graph.loop, graph.loop + graph.loops,
                  [&count](const ale_graph_loop_t &loop) { count[loop.kind]++; });
    return count;
}

TEST(MapperGraph, HasEveryKeyframeWhereTheMapperPlacesItAndEveryLoop)
{
    const Keyframes keyframes = drifting_keyframes::walk(1.25, 0.0008, 2);
    const std::vector<ale::Pose> truth = ring_corridor::truth(1.25);
    const Mapper mapper(ale_mapper_create(ALE_MAPPER_KEYFRAMES));
    EXPECT_EQ(graph_of(mapper.get())->keyframes, 0U);
    add(mapper.get(), keyframes, 0, keyframes.size());
    const Graph graph = graph_of(mapper.get());
    const ale_mapper_statistics_t statistics = ale_mapper_statistics(mapper.get());
    EXPECT_EQ(graph->epoch, 1U);
    ASSERT_EQ(graph->keyframes, keyframes.size());
    for (uint32_t k = 0; k < graph->keyframes; k++) {
        const ale_mapper_pose_t placed = ale_mapper_pose(mapper.get(), k);
        EXPECT_EQ(graph->keyframe[k].scan, placed.scan);
        EXPECT_EQ(graph->keyframe[k].map_id, 0U);
        EXPECT_EQ(graph->keyframe[k].pose.x_um, placed.pose.x_um);
        EXPECT_EQ(graph->keyframe[k].pose.theta_bam, placed.pose.theta_bam);
        EXPECT_EQ(graph->keyframe[k].tied, k > 0);
    }
    std::map<uint8_t, uint32_t> kinds = kinds_of(*graph);
    EXPECT_EQ(kinds[ALE_LOOP_RECOGNISED], statistics.recognised);
    EXPECT_GE(kinds[ALE_LOOP_CLOSED], statistics.loops) << "with those that confirmed them";
    EXPECT_GE(statistics.loops, 1U);
    EXPECT_EQ(kinds[ALE_LOOP_JOINS], 0U);
    EXPECT_EQ(graph->keyframes_left_out + graph->loops_left_out, 0U);
    for (uint32_t k = 0; k < graph->loops; k++) { // by the truth: where a place was seen again
        const ale::Pose &earlier = truth[graph->loop[k].from];
        const ale::Pose &later = truth[graph->loop[k].to];
        EXPECT_LT(std::hypot(earlier.x - later.x, earlier.y - later.y), 4);
    }
}

TEST(MapperGraph, TellsWhichMapAKeyframeIsInAndWhatJoinedTwo)
{
    const Keyframes keyframes = joined_drive::keyframes(0);
    const Mapper mapper(ale_mapper_create(ALE_MAPPER_KEYFRAMES));
    add(mapper.get(), keyframes, 0, joined);
    const Graph apart = graph_of(mapper.get());
    for (uint32_t k = 0; k < apart->keyframes; k++) {
        EXPECT_EQ(apart->keyframe[k].map_id, k < begun ? 0U : 1U);
        EXPECT_EQ(apart->keyframe[k].tied, k > 0 && k != begun) << "nothing but a guess lies between maps";
    }
    EXPECT_EQ(kinds_of(*apart)[ALE_LOOP_JOINS], 0U);
    add(mapper.get(), keyframes, joined, keyframes.size());
    const Graph one = graph_of(mapper.get());
    for (uint32_t k = 0; k < one->keyframes; k++) {
        EXPECT_EQ(one->keyframe[k].map_id, 0U);
        EXPECT_EQ(one->keyframe[k].tied, k > 0 && k != begun);
    }
    ASSERT_EQ(kinds_of(*one)[ALE_LOOP_JOINS], 1U);
    EXPECT_EQ(one->loop[0].kind, ALE_LOOP_JOINS) << "the most telling first";
    EXPECT_LT(one->loop[0].from, begun);
    EXPECT_EQ(one->loop[0].to, joined);
}

// As large as the mapper's graph can be: each node with three loops to earlier ones, of all kinds.
class FullGraph : public testing::Test
{
  protected:
    static constexpr int nodes_count = ALE_MAPPER_KEYFRAMES;
    static constexpr int guess_at = 1001;

    void SetUp() override
    {
        for (int k = 0; k < nodes_count; k++) {
            ale::Node node{};
            node.scan = static_cast<uint32_t>(7 * k);
            node.map_id = k < guess_at ? 0 : 5;
            nodes.push_back(node);
            poses.push_back({0.1 * k, 1, 0});
            if (k > 0) {
                const ale::Guess guess = k == guess_at ? ale::Guess::near : ale::Guess::none;
                edges.push_back({k - 1, k, {}, information, false, false, guess});
            }
        }
    }
    void add_loop(int from, int to, ale_loop_kind_t kind)
    {
        edges.push_back({from,
                         to,
                         {},
                         information,
                         true,
                         kind == ALE_LOOP_RECOGNISED,
                         ale::Guess::none,
                         kind == ALE_LOOP_JOINS});
        loops.insert({7U * static_cast<uint32_t>(from), 7U * static_cast<uint32_t>(to), kind});
    }
    void select()
    {
        ale::select_graph(nodes, poses, edges, &graph);
    }
    // Whatever is told is so, and what is not is counted.
    void expect_true() const
    {
        EXPECT_EQ(graph.keyframes + graph.keyframes_left_out, nodes.size());
        EXPECT_EQ(graph.loops + graph.loops_left_out, loops.size());
        uint32_t untied = 0;
        for (uint32_t k = 0; k < graph.keyframes; k++) {
            const ale_graph_keyframe_t &keyframe = graph.keyframe[k];
            const uint32_t node = keyframe.scan / 7;
            EXPECT_EQ(keyframe.map_id, node < guess_at ? 0U : 5U);
            EXPECT_NEAR(keyframe.pose.x_um, 1e5 * node, 1);
            EXPECT_TRUE(k == 0 || keyframe.scan > graph.keyframe[k - 1].scan);
            untied += keyframe.tied ? 0 : 1;
            const bool begins = k > 0 && keyframe.map_id != graph.keyframe[k - 1].map_id;
            EXPECT_EQ(keyframe.tied, k > 0 && !begins);
        }
        EXPECT_EQ(untied, 2U);
        for (uint32_t k = 0; k < graph.loops; k++) {
            const ale_graph_loop_t &loop = graph.loop[k];
            ASSERT_LT(loop.from, loop.to);
            ASSERT_LT(loop.to, graph.keyframes);
            EXPECT_EQ(loops.count({graph.keyframe[loop.from].scan, graph.keyframe[loop.to].scan,
                                   static_cast<ale_loop_kind_t>(loop.kind)}),
                      1U);
        }
    }

    const Eigen::Matrix3d information = Eigen::Matrix3d::Identity();
    std::vector<ale::Node> nodes;
    std::vector<ale::Pose> poses;
    std::vector<ale::GraphEdge> edges;
    std::set<std::tuple<uint32_t, uint32_t, ale_loop_kind_t>> loops; // by scans
    ale_mapper_graph_t graph{};
};

TEST_F(FullGraph, WithoutLoopsIsThinnedEvenly)
{
    select();
    expect_true();
    ASSERT_EQ(graph.keyframes, static_cast<uint32_t>(ALE_GRAPH_KEYFRAMES));
    EXPECT_EQ(graph.keyframe[0].scan, 0U);
    EXPECT_EQ(graph.keyframe[graph.keyframes - 1].scan, 7U * (nodes_count - 1));
    for (uint32_t k = 1; k < graph.keyframes; k++) {
        EXPECT_LE(graph.keyframe[k].scan - graph.keyframe[k - 1].scan, 7U * 6);
    }
}

TEST_F(FullGraph, WithMoreLoopsThanFitTellsTheMostTellingAndLeavesRoomForTheWay)
{
    for (int k = 200; k < nodes_count; k++) {
        for (const int back : {60, 120, 180}) {
            add_loop(k - back, k,
                     k % 100 == 0 && back == 60   ? ALE_LOOP_JOINS
                     : k % 20 == 0 && back == 120 ? ALE_LOOP_CLOSED
                                                  : ALE_LOOP_RECOGNISED);
        }
    }
    select();
    expect_true();
    EXPECT_EQ(graph.keyframes, static_cast<uint32_t>(ALE_GRAPH_KEYFRAMES));
    std::map<uint8_t, uint32_t> kinds = kinds_of(graph);
    EXPECT_EQ(kinds[ALE_LOOP_JOINS], 19U) << "all of them";
    EXPECT_EQ(kinds[ALE_LOOP_CLOSED], 93U) << "all of them";
    EXPECT_GT(kinds[ALE_LOOP_RECOGNISED], 0U);
    uint32_t widest = 0;
    for (uint32_t k = 1; k < graph.keyframes; k++) {
        widest = std::max(widest, graph.keyframe[k].scan - graph.keyframe[k - 1].scan);
    }
    EXPECT_LE(widest, 7U * 8) << "half of the list is the way's";
}

TEST_F(FullGraph, OfASmallGraphOnlyTheNumberOfLoopsIsBounded)
{
    nodes.resize(ALE_GRAPH_KEYFRAMES);
    poses.resize(ALE_GRAPH_KEYFRAMES);
    edges.resize(ALE_GRAPH_KEYFRAMES - 1);
    edges[200].guess = ale::Guess::near;
    for (size_t k = 201; k < nodes.size(); k++) {
        nodes[k].map_id = 5;
    }
    for (int k = 300; k < ALE_GRAPH_KEYFRAMES; k++) {
        for (const int back : {20, 40, 60}) {
            add_loop(k - back, k, ALE_LOOP_RECOGNISED);
        }
    }
    select();
    EXPECT_EQ(graph.keyframes, static_cast<uint32_t>(ALE_GRAPH_KEYFRAMES));
    EXPECT_EQ(graph.keyframes_left_out, 0U);
    EXPECT_EQ(graph.loops, static_cast<uint32_t>(ALE_GRAPH_LOOPS));
    EXPECT_EQ(graph.loops + graph.loops_left_out, loops.size());
    EXPECT_EQ(graph.loop[0].to, ALE_GRAPH_KEYFRAMES - 1) << "the latest first";
    EXPECT_FALSE(graph.keyframe[201].tied);
}

} // namespace
