// lib/graph/loops/loop_closer: a drive around a block, with drift, against the truth.
#include <set>

#include <gtest/gtest.h>

#include "graph/loops/loop_closer.h"
#include "graph/optimise/scan_node.h"
#include "lib/graph/bent_corridor.hpp"
#include "lib/graph/ring_corridor.hpp"

namespace
{

// With the tracked motion; this tracker never applies a correction.
void add(ale::LoopCloser *closer, const ale::Node &node)
{
    closer->add(node, closer->nodes().empty() ? node.smooth
                                              : ale::between(closer->nodes().back().smooth, node.smooth));
}

constexpr size_t plenty = 1000;

struct Walk {
    double tracked;
    double corrected;
    ale::LoopStatistics statistics;
};

Walk walk(double laps, double bend_rad_m, unsigned seed)
{
    const std::vector<ale::Pose> truth = ring_corridor::truth(laps);
    ale::LoopCloser closer(plenty);
    std::vector<ale::Pose> tracked;
    for (const ale::Node &node : ring_corridor::drifting(truth, bend_rad_m, seed)) {
        tracked.push_back(node.smooth);
        add(&closer, node);
    }
    return {ring_corridor::largest_error_m(truth, tracked),
            ring_corridor::largest_error_m(truth, closer.poses()), closer.statistics()};
}

TEST(LoopCloser, ADriftingDriveAroundABlockCloses)
{
    for (unsigned seed = 1; seed <= 2; seed++) {
        const Walk w = walk(1.3, 0.0008, seed);
        EXPECT_GT(w.tracked, 0.5);
        EXPECT_LT(w.corrected, 0.25) << "seed " << seed;
        EXPECT_GT(w.statistics.loops, 0U);
    }
}

TEST(LoopCloser, WithoutARevisitNothingMoves)
{
    const Walk w = walk(0.9, 0.0008, 1);
    EXPECT_EQ(w.statistics.loops, 0U);
    EXPECT_NEAR(w.tracked, w.corrected, 1e-6);
}

TEST(LoopCloser, WithoutDriftNothingMoves)
{
    const Walk w = walk(1.3, 0, 2);
    EXPECT_LT(w.tracked, 0.3);
    EXPECT_LE(w.corrected, w.tracked + 0.02);
}

// Largest heading errors along a bent corridor, or with heading drift.
struct HeadingErrors {
    double tracked_rad = 0;
    double corrected_rad = 0;
    uint32_t straightened = 0;

    HeadingErrors(double bend_rad, double drift_rad_m)
    {
        ale::LoopCloser closer(plenty);
        for (const ale::Node &node : bent_corridor::nodes(bend_rad, drift_rad_m, 4)) {
            add(&closer, node);
        }
        const std::vector<ale::Pose> truth = bent_corridor::truth(bend_rad);
        for (size_t k = 0; k < truth.size(); k++) {
            const double tracked = closer.nodes()[k].smooth.theta;
            tracked_rad = std::max(tracked_rad, std::abs(ale::wrapped(tracked - truth[k].theta)));
            corrected_rad =
                std::max(corrected_rad, std::abs(ale::wrapped(closer.poses()[k].theta - truth[k].theta)));
        }
        straightened = closer.statistics().straightened;
    }
};

TEST(LoopCloser, HeadingDriftIsCorrectedByTheWalls)
{
    const HeadingErrors errors(0, 0.006);
    EXPECT_GT(errors.straightened, 0U);
    EXPECT_GT(errors.tracked_rad, 0.1);
    EXPECT_LT(errors.corrected_rad, 0.5 * errors.tracked_rad);
}

TEST(LoopCloser, ABentCorridorIsNotStraightened)
{
    for (const double bend_rad : {0.05, -0.14}) {
        const HeadingErrors errors(bend_rad, 0);
        EXPECT_EQ(errors.straightened, 0U) << bend_rad;
        EXPECT_EQ(errors.corrected_rad, errors.tracked_rad) << bend_rad;
    }
}

// Twice around the block with room for less than half of one round.
TEST(LoopCloser, AFullGraphIsThinnedAndStaysRight)
{
    const std::vector<ale::Pose> truth = ring_corridor::truth(2);
    ale::LoopCloser closer(ale::LoopCloser::least_capacity);
    double tracked_m = 0;
    for (const ale::Node &node : ring_corridor::drifting(truth, 0.0008, 1)) {
        add(&closer, node);
        ASSERT_LE(closer.nodes().size(), ale::LoopCloser::least_capacity);
        ASSERT_EQ(closer.nodes().size(), closer.poses().size());
        tracked_m = std::max(
            tracked_m, std::hypot(node.smooth.x - truth[node.scan].x, node.smooth.y - truth[node.scan].y));
    }
    std::vector<ale::Pose> true_of_held;
    std::set<int> sides;
    uint32_t before = 0;
    for (const ale::Node &node : closer.nodes()) {
        EXPECT_TRUE(node.scan > before || true_of_held.empty()) << "along the path";
        before = node.scan;
        true_of_held.push_back(truth[node.scan]);
        sides.insert(static_cast<int>(node.scan / 36 % 4));
    }
    EXPECT_EQ(closer.nodes().front().scan, 0U);
    EXPECT_EQ(closer.nodes().back().scan, truth.size() - 1);
    EXPECT_EQ(sides.size(), 4U) << "the whole path is held";
    EXPECT_EQ(closer.statistics().thinned, truth.size() - ale::LoopCloser::least_capacity);
    EXPECT_GT(closer.statistics().loops, 0U);
    EXPECT_GT(tracked_m, 1.0);
    EXPECT_LT(ring_corridor::largest_error_m(true_of_held, closer.poses()), 0.35);
}

TEST(LoopCloser, WallsOfLaterScansAreKeptInTheFrameOfTheNode)
{
    ale::LoopCloser closer(plenty);
    closer.add_walls({0, 0, 0}, {{0.5, 1}}); // no node yet
    ale::Node node{};
    node.smooth = {1, 2, 0.4};
    add(&closer, node);
    for (int scan = 0; scan < ale::most_later_scans + 3; scan++) {
        closer.add_walls({1, 2, 0.7}, {{1.0, 2.5}});
    }
    const ale::Node &kept = closer.nodes().back();
    EXPECT_EQ(kept.later_scans, ale::most_later_scans);
    ASSERT_EQ(kept.later_walls.size(), static_cast<size_t>(ale::most_later_scans));
    EXPECT_NEAR(kept.later_walls[0].direction_rad, 1.3, 1e-12);
    EXPECT_EQ(kept.later_walls[0].length_m, 2.5);
    node.broken = true;
    add(&closer, node);
    EXPECT_EQ(closer.nodes()[0].later_scans, 0) << "the break may lie before them";
    EXPECT_TRUE(closer.nodes()[0].later_walls.empty());
}

TEST(LoopCloser, APlaceThatLooksLikeAnotherIsNoLoop)
{
    std::vector<ale::Node> nodes = ring_corridor::drifting(ring_corridor::truth(0.5), 0, 5);
    ale::LoopCloser closer(plenty);
    for (const ale::Node &node : nodes) {
        add(&closer, node);
    }
    // the same corridor again, beside the first and reached by another path
    const double path_m = nodes.back().path_m + 10;
    for (size_t k = 0; k < 6; k++) {
        ale::Node twin = nodes[k];
        twin.scan = nodes.back().scan + 1 + static_cast<uint32_t>(k);
        twin.smooth = {nodes[k].smooth.x, nodes[k].smooth.y + 4.9, nodes[k].smooth.theta};
        twin.path_m = path_m + 0.5 * static_cast<double>(k);
        twin.broken = k == 0;
        add(&closer, twin);
    }
    EXPECT_EQ(closer.statistics().loops, 0U);
}

// Two drives around the block, each bent its own way and in a frame of its own.
ale::LoopCloser two_drives(double bend_rad_m, unsigned seed)
{
    ale::LoopCloser closer(plenty);
    for (uint32_t drive = 0; drive < 2; drive++) {
        const double bend = drive == 0 ? bend_rad_m : -bend_rad_m;
        for (ale::Node &node : ring_corridor::drifting(ring_corridor::truth(0.3), bend, seed + drive)) {
            const bool is_first = closer.nodes().empty();
            const ale::Node *before = is_first ? nullptr : &closer.nodes().back();
            node.scan += 1000 * drive;
            node.map_id = drive;
            node.broken = node.path_m == 0;
            node.path_m += 1000 * drive;
            node.smooth.x += 10000 * drive;
            node.tracked = node.smooth;
            const ale::Pose motion = is_first ? node.tracked : ale::between(before->tracked, node.tracked);
            closer.append(node, motion);
        }
    }
    return closer;
}

size_t maps_of(const ale::LoopCloser &closer)
{
    std::set<uint32_t> maps;
    for (const ale::Node &node : closer.nodes()) {
        maps.insert(node.map_id);
    }
    return maps.size();
}

TEST(LoopCloser, DrivesThatAreBentJoin)
{
    ale::LoopCloser closer = two_drives(0.003, 1);
    EXPECT_EQ(maps_of(closer), 2U);
    while (closer.join_maps()) {
    }
    EXPECT_EQ(maps_of(closer), 1U);
}

TEST(LoopCloser, AJoinThatIsKnownIsMadeAsItWasFound)
{
    ale::LoopCloser closer = two_drives(0.003, 1);
    std::vector<ale::FoundJoin> made;
    while (closer.join_maps(&made)) {
    }
    ASSERT_EQ(made.size(), 1U);
    ale::LoopCloser again = two_drives(0.003, 1);
    again.make_join(made[0]);
    EXPECT_EQ(maps_of(again), 1U);
    for (size_t k = 0; k < closer.poses().size(); k++) {
        const ale::Pose off = ale::between(closer.poses()[k], again.poses()[k]);
        EXPECT_EQ(ale::length(off.x, off.y), 0) << k;
    }
}

} // namespace
