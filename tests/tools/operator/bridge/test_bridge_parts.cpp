#include <gtest/gtest.h>

#include <memory>
#include <random>

#include "common/command_line/wrong_use.h"
#include "operator/bridge/arrivals.h"
#include "operator/bridge/frame.h"
#include "operator/bridge/selection.h"

using bridge::Arrivals;
using bridge::decode;
using bridge::encode;
using bridge::Frame;
using bridge::Selection;

namespace
{

TEST(Frame, ComesBackAsItWentOut)
{
    const std::vector<uint8_t> payload(60000, 0xa5);
    Frame frame;
    frame.channel = "ALE_POSE";
    frame.message = payload.data();
    frame.size = payload.size();
    const std::vector<uint8_t> bytes = encode(frame);
    const auto again = decode(bytes.data(), bytes.size());
    ASSERT_TRUE(again);
    EXPECT_EQ(again->channel, "ALE_POSE");
    EXPECT_EQ(std::vector<uint8_t>(again->message, again->message + again->size), payload);
    const std::vector<uint8_t> nothing = encode(Frame{});
    ASSERT_TRUE(decode(nothing.data(), nothing.size()));
    EXPECT_EQ(decode(nothing.data(), nothing.size())->channel, "");
}

TEST(Frame, WhatIsTooLongIsNotSent)
{
    const std::vector<uint8_t> payload(bridge::most_message + 1);
    Frame frame;
    frame.channel = "A";
    frame.message = payload.data();
    frame.size = payload.size();
    EXPECT_TRUE(encode(frame).empty());
    frame.channel.assign(64, 'x');
    frame.size = 0;
    EXPECT_TRUE(encode(frame).empty());
}

TEST(Frame, ForeignBytesAreNoFrame)
{
    for (const std::vector<uint8_t> &bytes :
         std::vector<std::vector<uint8_t>>{{}, {0, 1}, {2, 'A'}, {64}, {3, 'A', ' ', 'B'}, {255, 'A'}}) {
        EXPECT_FALSE(decode(bytes.data(), bytes.size()));
    }
    std::mt19937 random(3);
    for (int k = 0; k < 20000; k++) {
        std::vector<uint8_t> bytes(random() % 40);
        for (uint8_t &byte : bytes) {
            byte = static_cast<uint8_t>(random());
        }
        const auto frame = decode(bytes.data(), bytes.size());
        EXPECT_TRUE(!frame || frame->size <= bytes.size());
    }
}

TEST(Selection, TakesWhatIsNamedAndThinsItEvenly)
{
    Selection selection({"ALE_POSE", "ALE_SCAN:2", "ALE_FEATURES:5"});
    int poses = 0, scans = 0, features = 0, others = 0;
    std::mt19937 random(1);
    for (int k = 0; k < 100; k++) { /* ten seconds, ten times a second, not exactly */
        const int64_t now = 1000000 + 100000 * k + static_cast<int64_t>(random() % 8000);
        poses += selection.take("ALE_POSE", now);
        scans += selection.take("ALE_SCAN", now);
        features += selection.take("ALE_FEATURES", now);
        others += selection.take("ALE_MAP", now);
    }
    EXPECT_EQ(poses, 100);
    EXPECT_NEAR(scans, 20, 1);
    EXPECT_NEAR(features, 50, 1);
    EXPECT_EQ(others, 0);
}

TEST(Selection, WordsThatMeanNothingAreRefused)
{
    for (const char *word : {"", ":5", "A:", "A:0", "A:-1", "A:fast", "A:2x", "A:1e9", "A:nan"}) {
        EXPECT_THROW(Selection({word}), cli::WrongUse) << word;
    }
}

TEST(Arrivals, OnlyWhatIsNewerOnItsChannelIsTaken)
{
    Arrivals arrivals;
    EXPECT_TRUE(arrivals.take("A", 1));
    EXPECT_TRUE(arrivals.take("A", 4));
    EXPECT_TRUE(arrivals.take("B", 3)) << "of another channel: not late there";
    EXPECT_FALSE(arrivals.take("A", 2));
    EXPECT_EQ(arrivals.late(), 1U);
    EXPECT_EQ(arrivals.lost(), 1U);
}

TEST(Arrivals, ACommandThatWasOvertakenMayBeAStop)
{
    Arrivals arrivals;
    EXPECT_TRUE(arrivals.take("ALE_COMMAND", 2));
    EXPECT_TRUE(arrivals.take("ALE_COMMAND", 1));
    EXPECT_EQ(arrivals.late(), 0U);
}

} // namespace
