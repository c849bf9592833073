#include <gtest/gtest.h>
#include <lcm/lcm.h>
#include <sys/resource.h>

#include <string>
#include <vector>

#include "drivers/lcm/datagrams.hpp"
#include "drivers/lcm/own_port.hpp"

extern "C" {
#include "lcm/wire.h"
}

namespace
{

constexpr int kLong = 60000;
constexpr int kMost = 256;

/* One end of ours on a port of this process; what it hears on CHANNEL. Skipped without a multicast route. */
class OnAPort : public testing::Test
{
  protected:
    void SetUp() override
    {
        char error[ALE_LCM_URL_ERROR] = "";
        wire = ale_wire_open(url.c_str(), error);
        if (!wire) {
            GTEST_SKIP() << error;
        }
        ASSERT_EQ(ale_wire_subscribe(wire, "CHANNEL", take, this), 0);
    }
    void TearDown() override
    {
        ale_wire_close(wire);
    }
    static void take(void *user, const char *channel, const uint8_t *bytes, size_t count)
    {
        EXPECT_STREQ(channel, "CHANNEL");
        static_cast<OnAPort *>(user)->heard.emplace_back(reinterpret_cast<const char *>(bytes), count);
    }
    void send(const std::string &message)
    {
        ASSERT_EQ(
            ale_wire_send(wire, "CHANNEL", reinterpret_cast<const uint8_t *>(message.data()), message.size()),
            0);
    }
    /* All that was sent before is then handled. */
    void receive_to_the_end()
    {
        send("the end");
        while (heard.empty() || heard.back() != "the end") {
            ASSERT_GT(ale_wire_receive(wire, kLong, kMost), 0);
        }
        heard.pop_back();
    }
    const std::string url = own_lcm_url();
    ale_wire_t *wire = nullptr;
    std::vector<std::string> heard;
};

TEST_F(OnAPort, WhatIsSentIsHeardOnItsChannelOnly)
{
    send("one");
    send("");
    const uint8_t other[] = "other";
    EXPECT_EQ(ale_wire_send(wire, "CHANNEL2", other, 5), 0);
    EXPECT_EQ(ale_wire_send(wire, "CHANNE", other, 5), 0);
    EXPECT_EQ(ale_wire_send(wire, "", other, 5), -1);
    EXPECT_EQ(ale_wire_send(wire, std::string(64, 'A').c_str(), other, 5), -1);
    receive_to_the_end();
    EXPECT_EQ(heard, (std::vector<std::string>{"one", ""}));
    EXPECT_EQ(ale_wire_receive(wire, 0, kMost), 0);
    EXPECT_TRUE(ale_wire_hears_itself(wire, kLong));
}

TEST_F(OnAPort, ADatagramHoldsWhatUdpCarries)
{
    const std::string most(65507 - 8 - 8, 'm');
    send(most);
    const std::string more = most + "m";
    EXPECT_EQ(ale_wire_send(wire, "CHANNEL", reinterpret_cast<const uint8_t *>(more.data()), more.size()),
              -1);
    receive_to_the_end();
    EXPECT_EQ(heard, std::vector<std::string>{most});
}

TEST_F(OnAPort, StockLcmIsHeardWholeAndInParts)
{
    lcm_t *lcm = lcm_create(url.c_str());
    ASSERT_NE(lcm, nullptr);
    const std::vector<std::string> messages = {"short", std::string(65499, 'a'), std::string(65536, 'b')};
    for (const std::string &message : messages) {
        ASSERT_EQ(lcm_publish(lcm, "CHANNEL", message.data(), static_cast<unsigned>(message.size())), 0);
    }
    receive_to_the_end();
    EXPECT_EQ(heard, messages);
    const std::string longer(65537, 'c');
    ASSERT_EQ(lcm_publish(lcm, "CHANNEL", longer.data(), static_cast<unsigned>(longer.size())), 0);
    heard.clear();
    receive_to_the_end();
    EXPECT_TRUE(heard.empty());
    EXPECT_GT(ale_wire_dropped(wire).malformed, 0U);
    lcm_destroy(lcm);
}

TEST_F(OnAPort, TenThousandHostileDatagramsChangeNothing)
{
    const datagrams::Sender attacker(url);
    std::mt19937 random(3);
    for (int k = 0; k < 100; k++) {
        attacker.send(datagrams::part({1, 1000, 0xfffffff0, 0, 2},
                                      std::string("CHANNEL") + '\0' + std::string(32, 'x')));
        attacker.send(datagrams::part({1, 1000, 0xfffffff0, 1, 2}, std::string(32, 'x')));
        attacker.send(datagrams::part({1, 1U << 28, 0, 0, 2}, std::string("CHANNEL") + '\0'));
        for (int n = 0; n < 100; n++) {
            attacker.send(datagrams::hostile(random, "CHANNEL"));
        }
        heard.clear();
        send("good");
        receive_to_the_end();
        ASSERT_FALSE(heard.empty());
        EXPECT_EQ(heard.back(), "good");
    }
    EXPECT_GT(ale_wire_dropped(wire).malformed, 3000U);
}

TEST_F(OnAPort, AMessageThatAnnounces256MiBTakesNoMemory)
{
    const datagrams::Sender attacker(url);
    receive_to_the_end();
    rusage before{};
    getrusage(RUSAGE_SELF, &before);
    for (uint32_t k = 0; k < 50; k++) {
        attacker.send(datagrams::part({k, 1U << 28, 0, 0, 4000}, std::string("CHANNEL") + '\0' + "x"));
    }
    receive_to_the_end();
    rusage after{};
    getrusage(RUSAGE_SELF, &after);
    EXPECT_LT(after.ru_maxrss - before.ru_maxrss, 8192) << "KiB";
    EXPECT_EQ(ale_wire_dropped(wire).malformed, 50U);
}

TEST_F(OnAPort, AFloodDoesNotKeepItsReader)
{
    const datagrams::Sender attacker(url);
    for (int k = 0; k < 100; k++) {
        attacker.send(datagrams::whole("OTHER", "x"));
    }
    send("behind the flood");
    EXPECT_EQ(ale_wire_receive(wire, 0, 50), 0);
    EXPECT_EQ(ale_wire_receive(wire, 0, 60), 1);
}

TEST_F(OnAPort, DatagramsToAnAddressOfThisMachineAreNotHeard)
{
    const auto colon = url.rfind(':');
    const datagrams::Sender unicast("udpm://127.0.0.1" + url.substr(colon));
    unicast.send(datagrams::whole("CHANNEL", "not to the group"));
    receive_to_the_end();
    EXPECT_TRUE(heard.empty());
}

/* What happens to a network is in tests/system/test_network.py. */
TEST_F(OnAPort, LookingAfterABusThatIsJoinedChangesNothing)
{
    const int descriptor = ale_wire_descriptor(wire);
    send("before");
    EXPECT_TRUE(ale_wire_tend(wire));
    receive_to_the_end();
    EXPECT_EQ(heard, std::vector<std::string>{"before"});
    EXPECT_EQ(ale_wire_descriptor(wire), descriptor);
}

TEST_F(OnAPort, SubscriptionsAreBounded)
{
    for (int k = 1; k < 64; k++) {
        ASSERT_EQ(ale_wire_subscribe(wire, "CHANNEL2", take, this), 0);
    }
    EXPECT_EQ(ale_wire_subscribe(wire, "CHANNEL2", take, this), -1);
}

/* Two robots on one port: each with those who watch it. */
TEST_F(OnAPort, APrefixIsOnTheBusOnly)
{
    char error[ALE_LCM_URL_ERROR] = "";
    ale_wire_t *first = ale_wire_open((url + "&prefix=rover1.").c_str(), error);
    ASSERT_NE(first, nullptr) << error;
    ale_wire_t *second = ale_wire_open(url.c_str(), error);
    ASSERT_NE(second, nullptr) << error;
    EXPECT_EQ(ale_wire_set_prefix(second, "two words"), -1);
    ASSERT_EQ(ale_wire_set_prefix(second, "rover2."), 0);
    std::vector<std::string> of_first;
    const auto hear = [](void *user, const char *channel, const uint8_t *bytes, size_t count) {
        static_cast<std::vector<std::string> *>(user)->push_back(
            std::string(channel) + " " + std::string(reinterpret_cast<const char *>(bytes), count));
    };
    ASSERT_EQ(ale_wire_subscribe(first, "CHANNEL", hear, &of_first), 0);
    std::vector<std::string> raw;
    ASSERT_EQ(ale_wire_subscribe(wire, "rover1.CHANNEL", hear, &raw), 0);
    const uint8_t words[] = "words";
    for (ale_wire_t *sender : {first, second, wire}) {
        ASSERT_EQ(ale_wire_send(sender, "CHANNEL", words, 5), 0);
    }
    EXPECT_TRUE(ale_wire_hears_itself(first, kLong)) << "by LCM's own channel";
    EXPECT_EQ(of_first, std::vector<std::string>{"CHANNEL words"});
    receive_to_the_end();
    EXPECT_EQ(raw, std::vector<std::string>{"rover1.CHANNEL words"});
    EXPECT_EQ(heard, std::vector<std::string>{"words"}) << "the one without a prefix";
    EXPECT_EQ(ale_wire_send(first, std::string(57, 'A').c_str(), words, 5), -1);
    EXPECT_EQ(ale_wire_send(first, "", words, 5), -1);
    ale_wire_close(first);
    ale_wire_close(second);
}

TEST(WireOpening, TheOptionsOfAUrlAreChecked)
{
    char error[ALE_LCM_URL_ERROR] = "";
    for (const char *option : {"ttl=256", "ttl=-1", "ttl=", "ttl", "tl=0", "recv_buf_size=0",
                               "recv_buf_size=1x", "prefix=a b", "prefix=12345678901234567"}) {
        EXPECT_EQ(ale_wire_open((std::string("udpm://239.255.76.67:7667?") + option).c_str(), error),
                  nullptr);
        EXPECT_EQ(std::string(error), std::string("LCM: \"") + option +
                                          "\": udpm takes ttl=0 to 255, recv_buf_size=BYTES and prefix=TEXT "
                                          "(16 letters, digits and . _ - / at most)");
    }
    EXPECT_EQ(ale_wire_open("mpudpm://", error), nullptr);
    EXPECT_EQ(ale_wire_open_early("mpudpm://", error), nullptr) << "is no matter of a route";
    ale_lcm_group_t group;
    ASSERT_EQ(ale_lcm_group("udpm://", &group, error), 0);
    EXPECT_EQ(group.address, 0xefff4c43U);
    EXPECT_EQ(group.port, 7667);
    EXPECT_EQ(group.ttl, 0);
    ASSERT_EQ(ale_lcm_group("udpm://224.1.2.3:99?recv_buf_size=100&ttl=1&transmit_only=true", &group, error),
              0);
    EXPECT_EQ(group.address, 0xe0010203U);
    EXPECT_EQ(group.port, 99);
    EXPECT_EQ(group.ttl, 1);
    EXPECT_EQ(group.receive_bytes, 100);
}

} // namespace
