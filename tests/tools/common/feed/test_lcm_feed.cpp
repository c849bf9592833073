#include <gtest/gtest.h>
#include <sys/resource.h>

#include "ale/features_t.hpp"
#include "ale/status_t.hpp"
#include "common/feed/lcm_feed.h"
#include "drivers/lcm/datagrams.hpp"
#include "drivers/lcm/own_port.hpp"

namespace
{

constexpr int kLong = 60000;

long resident_kib()
{
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return usage.ru_maxrss;
}

template <class Message> std::string encoded(const Message &message)
{
    std::string bytes(static_cast<size_t>(message.getEncodedSize()), '\0');
    message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
    return bytes;
}

/* Message with its only count, a zero, replaced. */
std::string claiming(const std::string &bytes, size_t at, uint32_t count)
{
    std::string changed = bytes;
    for (size_t k = 0; k < 4; k++) {
        changed[at + k] = static_cast<char>(count >> (24 - 8 * k));
    }
    return changed;
}

/* Counts ALE_FEATURES on a port of its own. */
class LcmFeed : public testing::Test
{
  protected:
    void SetUp() override
    {
        try {
            feed = std::make_unique<feed::LcmFeed>(url);
        } catch (const std::runtime_error &error) {
            GTEST_SKIP() << error.what();
        }
        feed->on<ale::features_t>("ALE_FEATURES", [this](const ale::features_t &) { heard++; });
        sender = std::make_unique<datagrams::Sender>(url);
    }
    void send(const std::string &channel, const std::string &bytes) const
    {
        sender->send(datagrams::whole(channel, bytes));
    }

    const std::string url = own_lcm_url();
    const std::string honest = encoded(ale::features_t{});
    std::unique_ptr<feed::LcmFeed> feed;
    std::unique_ptr<datagrams::Sender> sender;
    int heard = 0;
};

TEST_F(LcmFeed, WhatWaitsIsDrainedAlsoBehindMessagesOfOtherChannels)
{
    send("ALE_OTHER", honest);
    for (int k = 0; k < 3; k++) {
        send("ALE_FEATURES", honest);
        send("ALE_OTHER", honest);
    }
    feed->drain();
    EXPECT_EQ(heard, 3);
    feed->drain();
    EXPECT_EQ(heard, 3);
}

TEST_F(LcmFeed, AMessageThatClaimsMoreThanItHasIsCountedAndTakesNoMemory)
{
    send("ALE_FEATURES", honest);
    while (heard == 0) {
        feed->wait(kLong);
    }
    const long before = resident_kib();
    /* The last two counts are those of lines and corners, both zero. */
    const size_t lines = honest.size() - 8;
    for (const uint32_t count : {1U, 50000000U, 0x7fffffffU, 0x80000000U, 0xffffffffU}) {
        send("ALE_FEATURES", claiming(honest, lines, count));
        send("ALE_FEATURES", claiming(honest, lines + 4, count));
    }
    send("ALE_FEATURES", honest);
    while (heard < 2) {
        feed->wait(kLong);
    }
    EXPECT_EQ(feed->malformed(), 10U);
    EXPECT_LT(resident_kib() - before, 20000);
}

} // namespace
