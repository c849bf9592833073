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
using bridge::Kind;
using bridge::Selection;

namespace
{

Frame message(const char *channel, uint32_t sequence, uint32_t session = 7)
{
    Frame frame;
    frame.kind = Kind::message;
    frame.session = session;
    frame.sequence = sequence;
    frame.channel = channel;
    return frame;
}

TEST(Frame, ComesBackAsItWentOut)
{
    const std::vector<uint8_t> payload(60000, 0xa5);
    Frame frame = message("ALE_POSE", 0x01020304, 0xfffefdfc);
    frame.message = payload.data();
    frame.size = payload.size();
    const std::vector<uint8_t> bytes = encode(frame);
    const auto again = decode(bytes.data(), bytes.size());
    ASSERT_TRUE(again);
    EXPECT_EQ(again->channel, "ALE_POSE");
    EXPECT_EQ(again->session, 0xfffefdfcU);
    EXPECT_EQ(again->sequence, 0x01020304U);
    EXPECT_EQ(std::vector<uint8_t>(again->message, again->message + again->size), payload);
    const std::vector<uint8_t> hello = encode(Frame{});
    ASSERT_TRUE(decode(hello.data(), hello.size()));
    EXPECT_EQ(decode(hello.data(), hello.size())->kind, Kind::hello);
}

TEST(Frame, WhatIsTooLongIsNotSent)
{
    const std::vector<uint8_t> payload(bridge::most_message + 1);
    Frame frame = message("A", 1);
    frame.message = payload.data();
    frame.size = payload.size();
    EXPECT_TRUE(encode(frame).empty());
    EXPECT_TRUE(encode(message(std::string(64, 'x').c_str(), 1)).empty());
}

TEST(Frame, CutAndForeignBytesAreNoDatagram)
{
    const std::vector<uint8_t> good = encode(message("ALE_POSE", 1));
    for (size_t length = 0; length < good.size(); length++) {
        const std::unique_ptr<uint8_t[]> exact(new uint8_t[length]);
        std::copy(good.begin(), good.begin() + static_cast<long>(length), exact.get());
        EXPECT_FALSE(decode(exact.get(), length)) << length;
    }
    for (const size_t at : {0U, 3U, 4U, 5U}) {
        std::vector<uint8_t> other = good;
        other[at] ^= 0x40;
        EXPECT_FALSE(decode(other.data(), other.size())) << at;
    }
    const std::vector<uint8_t> odd = encode(message("A B", 1));
    EXPECT_FALSE(decode(odd.data(), odd.size())) << "a channel is a word";
    std::mt19937 random(3);
    for (int k = 0; k < 20000; k++) {
        std::vector<uint8_t> bytes = good;
        bytes.resize(random() % 40);
        for (uint8_t &byte : bytes) {
            byte = random() % 3 ? byte : static_cast<uint8_t>(random());
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
    EXPECT_TRUE(arrivals.take(message("A", 1)));
    EXPECT_TRUE(arrivals.take(message("A", 4)));
    EXPECT_TRUE(arrivals.take(message("B", 3))) << "of another channel: not late there";
    EXPECT_FALSE(arrivals.take(message("A", 2)));
    EXPECT_FALSE(arrivals.take(message("A", 4)));
    EXPECT_EQ(arrivals.late(), 2U);
    EXPECT_EQ(arrivals.lost(), 1U);
}

TEST(Arrivals, ANewSessionStartsAnew)
{
    Arrivals arrivals;
    EXPECT_TRUE(arrivals.take(message("A", 900)));
    EXPECT_TRUE(arrivals.take(message("A", 1, 8)));
    EXPECT_EQ(arrivals.lost(), 0U);
}

TEST(Arrivals, NumbersThatWrapGoOn)
{
    Arrivals arrivals;
    EXPECT_TRUE(arrivals.take(message("A", 0xffffffff)));
    EXPECT_TRUE(arrivals.take(message("A", 0)));
    EXPECT_TRUE(arrivals.take(message("A", 2)));
    EXPECT_EQ(arrivals.lost(), 1U);
}

} // namespace
