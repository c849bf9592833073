// The board: newest wins, the trail is kept whole, and the link's health is what arrived.
#include "operator/console/board.h"

#include <cmath>
#include <thread>

#include <gtest/gtest.h>

using console::Board;
using console::Topic;
using std::chrono::milliseconds;

namespace
{

void drive(Board &board, int from, int to, float step_m)
{
    for (int k = from; k < to; k++) {
        board.extend_trail({static_cast<float>(k) * step_m, 0, k == 0});
    }
}

} // namespace

TEST(Board, WhatWasPinnedLastIsReadAndNumbered)
{
    Board board;
    EXPECT_FALSE(board.newest(Topic::pose).text);
    board.pin(Topic::pose, "first");
    board.pin(Topic::pose, "second");
    board.pin(Topic::map, "map");
    EXPECT_EQ(*board.newest(Topic::pose).text, "second");
    EXPECT_EQ(board.newest(Topic::pose).number, 2U);
    EXPECT_EQ(board.newest(Topic::map).number, 1U);
}

TEST(Board, EveryPinWakesTheReader)
{
    Board board;
    int woken = 0;
    board.on_change([&] { woken++; });
    board.pin(Topic::scan, "");
    board.pin(Topic::scan, "");
    EXPECT_EQ(woken, 2);
    board.on_change(nullptr);
    board.pin(Topic::scan, "");
    EXPECT_EQ(woken, 2);
}

TEST(Board, ATrailPointTooNearTheLastIsLeftOut)
{
    Board board;
    drive(board, 0, 100, 0.001F);
    EXPECT_LE(board.trail(0, 0, 1000).points.size(), 6U);
    EXPECT_GE(board.trail(0, 0, 1000).points.size(), 4U);
}

TEST(Board, ATrailIsHandedOutInPiecesThatJoin)
{
    Board board;
    drive(board, 0, 50, 0.1F);
    const auto first = board.trail(0, 0, 20);
    EXPECT_EQ(first.first, 0U);
    EXPECT_EQ(first.points.size(), 20U);
    const auto second = board.trail(first.epoch, 20, 100);
    EXPECT_EQ(second.epoch, first.epoch);
    EXPECT_EQ(second.points.size(), 30U);
    EXPECT_FLOAT_EQ(second.points.front().x, 2.0F);
    EXPECT_TRUE(board.trail(first.epoch, 50, 100).points.empty());
}

TEST(Board, AVeryLongTrailIsThinnedAndKeepsItsWholeLength)
{
    Board board;
    drive(board, 0, 60000, 0.1F);
    const auto whole = board.trail(0, 0, 1000000);
    EXPECT_LT(whole.points.size(), 20000U);
    EXPECT_GT(whole.points.size(), 5000U);
    EXPECT_FLOAT_EQ(whole.points.front().x, 0);
    EXPECT_NEAR(whole.points.back().x, 5999.9F, 2.0F);
    EXPECT_TRUE(whole.points.front().first);
}

TEST(Board, AJumpStaysAJumpWhenTheTrailIsThinned)
{
    Board board;
    drive(board, 0, 1001, 0.1F);
    board.extend_trail({500, 500, true}); // an odd index: the point itself is dropped by thinning
    drive(board, 5000, 30000, 0.1F);
    int jumps = 0;
    for (const auto &point : board.trail(0, 0, 1000000).points) {
        jumps += point.first ? 1 : 0;
    }
    EXPECT_EQ(jumps, 2);
}

TEST(Board, AReaderOfAFormerEpochGetsTheTrailFromItsStart)
{
    Board board;
    drive(board, 0, 10, 0.1F);
    const auto before = board.trail(0, 0, 100);
    board.clear();
    board.extend_trail({7, 7, true});
    const auto after = board.trail(before.epoch, before.points.size(), 100);
    EXPECT_NE(after.epoch, before.epoch);
    EXPECT_EQ(after.first, 0U);
    ASSERT_EQ(after.points.size(), 1U);
    EXPECT_FLOAT_EQ(after.points[0].x, 7);
}

TEST(Board, AfterARestartNothingOfTheFormerLifeIsLeft)
{
    Board board;
    board.pin(Topic::map, "old");
    board.note_pose(Board::Clock::now(), 3, 2);
    const uint64_t life = board.life();
    board.clear();
    EXPECT_NE(board.life(), life);
    EXPECT_FALSE(board.newest(Topic::map).text);
    EXPECT_EQ(board.link(Board::Clock::now()).pose_age_ms, -1);
    EXPECT_EQ(board.link(Board::Clock::now()).lost_poses, 0U);
}

TEST(Board, TheLinksRateAndAgeAreThoseOfTheArrivals)
{
    Board board;
    const auto start = Board::Clock::now();
    for (int k = 0; k < 50; k++) {
        board.note_pose(start + milliseconds(100 * k), k == 10 ? 2 : 0, k < 49 ? 2 : 1);
    }
    const auto link = board.link(start + milliseconds(4900 + 345));
    EXPECT_EQ(link.pose_age_ms, 345);
    EXPECT_NEAR(link.pose_rate_hz, 10, 1e-6);
    EXPECT_EQ(link.poses, 50U);
    EXPECT_EQ(link.lost_poses, 2U);
    EXPECT_EQ(link.state, 1) << "of the last pose";
}

TEST(Board, OneThreadPinsWhileAnotherReads)
{
    Board board;
    std::thread writer([&] {
        for (int k = 0; k < 2000; k++) {
            board.pin(Topic::pose, std::to_string(k));
            board.extend_trail({static_cast<float>(k), 0, false});
        }
    });
    uint64_t seen = 0;
    for (int k = 0; k < 2000; k++) {
        const auto pinned = board.newest(Topic::pose);
        EXPECT_GE(pinned.number, seen);
        seen = pinned.number;
        if (pinned.text) {
            EXPECT_EQ(std::stoull(*pinned.text) + 1, pinned.number);
        }
        board.trail(0, 0, 10);
    }
    writer.join();
    EXPECT_EQ(board.newest(Topic::pose).number, 2000U);
}
