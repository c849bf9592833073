/* The operator's end against the robot's: what the one makes the other takes. */
#include <gtest/gtest.h>

#include <cstdint>
#include <cstdio>
#include <cstring>

#include "drivers/command/signed_command.hpp"

extern "C" {
#include "command/operator.h"
}

using signed_command::boot;
using signed_command::now_utime;
using signed_command::Operator;

namespace
{

class OperatorEnd : public testing::Test
{
  protected:
    void SetUp() override
    {
        const ale_keys_t keys = signed_command::keys_of({alice});
        ale_verifier_init(&verifier, &keys, "rover", boot);
        end.key = alice.secret;
    }
    ale_verdict_t send(int64_t host_us, int64_t robot_utime)
    {
        const char *const words[] = {"save_map", "kitchen"};
        ale_command_t command;
        uint8_t bytes[ALE_COMMAND_BYTES];
        EXPECT_EQ(ale_command_from_words(words, 2, &command), 0);
        const size_t count = ale_operator_command(&end, host_us, 1000000, &command, bytes);
        return ale_verify(&verifier, bytes, count, robot_utime, &taken);
    }
    void make(const char *verb, int64_t host_us)
    {
        ale_command_t command{};
        uint8_t bytes[ALE_COMMAND_BYTES];
        std::snprintf(command.verb, sizeof command.verb, "%s", verb);
        EXPECT_GT(ale_operator_command(&end, host_us, 1000000, &command, bytes), 0U);
    }
    /* How many of the stops for other starts the robot takes. */
    int stop_others(int64_t host_us, int64_t robot_utime)
    {
        int genuine = 0;
        for (int k = 0; k < ALE_OPERATOR_OTHERS; k++) {
            ale_command_t stop{};
            uint8_t bytes[ALE_COMMAND_BYTES];
            std::snprintf(stop.verb, sizeof stop.verb, "stop");
            const size_t count = ale_operator_command_other(&end, k, host_us, 1000000, &stop, bytes);
            genuine += count > 0 && ale_verify(&verifier, bytes, count, robot_utime, &taken) == ALE_GENUINE;
        }
        return genuine;
    }

    const Operator alice{"alice"};
    ale_operator_t end{};
    ale_verifier_t verifier{};
    ale_command_t taken{};
};

TEST_F(OperatorEnd, BeforeARobotIsHeardNothingIsMade)
{
    ale_command_t command{};
    uint8_t bytes[ALE_COMMAND_BYTES];
    EXPECT_EQ(ale_operator_command(&end, 0, 1000000, &command, bytes), 0U);
}

TEST_F(OperatorEnd, FollowsTheRobotsClockWhateverItsOwnSays)
{
    ale_operator_saw(&end, "rover", boot, now_utime, 55);
    EXPECT_EQ(send(55 + 700000, now_utime + 700000), ALE_GENUINE);
    EXPECT_STREQ(taken.verb, "save_map");
    EXPECT_STREQ(taken.arg[0], "kitchen");
    EXPECT_EQ(taken.utime, now_utime + 700000);
}

TEST_F(OperatorEnd, FollowsAClockThatRunsFaster)
{
    ale_operator_saw(&end, "rover", boot, now_utime, 0);
    ale_operator_saw(&end, "rover", boot, now_utime + 20000000, 1000000);
    EXPECT_EQ(send(1900000, now_utime + 38000000), ALE_GENUINE);
    EXPECT_EQ(taken.utime, now_utime + 38000000);
}

TEST_F(OperatorEnd, EveryCommandIsNewerThanTheLastEvenInOneInstant)
{
    ale_operator_saw(&end, "rover", boot, now_utime, 0);
    for (int k = 0; k < 5; k++) {
        EXPECT_EQ(send(1000, now_utime + 1000), ALE_GENUINE);
    }
}

TEST_F(OperatorEnd, FollowsARobotThatHasStartedAgain)
{
    ale_operator_saw(&end, "rover", boot - 1, now_utime, 0);
    EXPECT_EQ(send(1000, now_utime + 1000), ALE_REFUSED_REPLAYED);
    ale_operator_saw(&end, "rover", boot, now_utime + 5000, 5000);
    EXPECT_EQ(send(6000, now_utime + 6000), ALE_GENUINE);
}

/* Nobody vouches for these: what goes on is followed, what contradicts it is not. */
TEST_F(OperatorEnd, AForgedClockIsNotFollowedWhileTheOtherOneGoesOn)
{
    constexpr int64_t second = 1000000;
    for (int64_t k = 0; k < 5; k++) {
        EXPECT_TRUE(ale_operator_saw(&end, "rover", boot, now_utime + k * second, k * second));
        if (k > 0) {
            EXPECT_FALSE(
                ale_operator_saw(&end, "rover", boot, now_utime + (k + 60) * second, k * second + 200000));
            EXPECT_FALSE(ale_operator_saw(&end, "rover", boot, INT64_MAX, k * second + 400000));
        }
        EXPECT_EQ(send(k * second + 500000, now_utime + k * second + 500000), ALE_GENUINE);
    }
}

TEST_F(OperatorEnd, ACounterThatAWrongClockMadeDoesNotStay)
{
    ale_operator_saw(&end, "rover", boot, now_utime + 3600000000, 0);
    EXPECT_EQ(send(1000, now_utime), ALE_REFUSED_LASTING);
    ale_operator_saw(&end, "rover", boot, now_utime + 5000000, 5000000);
    EXPECT_EQ(send(5000000, now_utime + 5000000), ALE_GENUINE) << "silent since: the other clock is taken";
    EXPECT_EQ(taken.counter, now_utime + 5000000);
}

TEST_F(OperatorEnd, CommandsAreForTheFirstRobotAndTheOtherOneIsTold)
{
    ale_operator_saw(&end, "rover", boot, now_utime, 0);
    EXPECT_EQ(ale_operator_rival(&end, 0), nullptr);
    EXPECT_FALSE(ale_operator_saw(&end, "scout", 5, now_utime, 1000));
    EXPECT_STREQ(ale_operator_rival(&end, 2000), "scout");
    EXPECT_EQ(send(2000, now_utime + 2000), ALE_GENUINE);
    EXPECT_FALSE(ale_operator_saw(&end, "scout", 5, now_utime, 9000000))
        << "silence makes no other robot his";
    EXPECT_EQ(ale_operator_rival(&end, 20000000), nullptr) << "gone again";
}

TEST_F(OperatorEnd, AStopIsForEveryRobotThatIsHeard)
{
    ale_operator_saw(&end, "ghost", 4, now_utime - 7, 0);
    ale_operator_saw(&end, "rover", boot, now_utime, 0);
    EXPECT_EQ(send(1000, now_utime + 1000), ALE_REFUSED_ADDRESS) << "for the first one";
    EXPECT_EQ(stop_others(1000, now_utime + 1000), 1) << "and for the other one beside it";
    EXPECT_EQ(stop_others(ALE_OPERATOR_SILENCE_US + 1, now_utime), 0) << "which is silent since";
}

TEST_F(OperatorEnd, AStopIsForNoOtherOneThanTheOneThatIsWanted)
{
    std::snprintf(end.wanted, sizeof end.wanted, "scout");
    ale_operator_saw(&end, "scout", 4, now_utime, 0);
    ale_operator_saw(&end, "rover", boot, now_utime, 0);
    EXPECT_EQ(stop_others(1000, now_utime + 1000), 0);
}

TEST_F(OperatorEnd, AStopIsMadeAgainWhenAStartIsHeardThatItWasNotSentTo)
{
    ale_operator_saw(&end, "ghost", 4, now_utime, 0);
    make("stop", 0);
    EXPECT_FALSE(ale_operator_was_misled(&end, &end.made, 1000000));
    ale_operator_saw(&end, "rover", boot, now_utime, 1000);
    EXPECT_FALSE(ale_operator_was_misled(&end, &end.made, 50000)) << "not at once: others may follow";
    EXPECT_TRUE(ale_operator_was_misled(&end, &end.made, 100000));
    make("stop", 100000);
    ale_operator_saw(&end, "rover", boot, now_utime + 900000, 900000);
    EXPECT_FALSE(ale_operator_was_misled(&end, &end.made, 1000000)) << "it is known by now";
    make("save_map", 1000000);
    ale_operator_saw(&end, "scout", 8, now_utime, 1000000);
    EXPECT_FALSE(ale_operator_was_misled(&end, &end.made, 2000000)) << "for the first one alone";
}

TEST_F(OperatorEnd, TwoRobotsOfOneNameAreFoundAndBothHearAStop)
{
    constexpr int64_t step = 300000;
    int64_t host = 0;
    for (int k = 0; k < 6; k++, host += step) {
        ale_operator_saw(&end, "rover", k % 2 ? boot : boot + 1, now_utime + host, host);
    }
    EXPECT_STREQ(ale_operator_rival(&end, host), "rover");
    const bool first = send(host, now_utime + host) == ALE_GENUINE;
    EXPECT_TRUE(first || stop_others(host, now_utime + host) > 0);
}

/* As a robot that he believes says it. */
class Believing : public OperatorEnd
{
  protected:
    void SetUp() override
    {
        OperatorEnd::SetUp();
        end.robots.operator_key[end.robots.count++] = Operator("rover").known;
    }
    bool hear(int64_t start_boot, int64_t counter, int64_t utime, int64_t host_us)
    {
        ale_start_t start{};
        std::snprintf(start.robot, sizeof start.robot, "rover");
        start.key = 77;
        start.boot = start_boot;
        start.counter = counter;
        start.utime = utime;
        start.rate_ppm = 1000000;
        return ale_operator_saw_vouched(&end, &start, host_us);
    }
};

TEST_F(Believing, WhatNobodyVouchesForIsNothing)
{
    EXPECT_FALSE(ale_operator_saw(&end, "rover", boot, now_utime, 0));
    EXPECT_EQ(send(0, now_utime), ALE_REFUSED_MALFORMED) << "nothing was made";
    EXPECT_TRUE(hear(boot, 1, now_utime, 0));
    EXPECT_FALSE(ale_operator_saw(&end, "rover", boot + 1, now_utime + 1000, 1000));
    EXPECT_EQ(send(2000, now_utime + 2000), ALE_GENUINE);
}

TEST_F(Believing, WordsThatWereHeardAndEarlierOnesAreNotHeardAgain)
{
    EXPECT_TRUE(hear(boot, 10, now_utime, 0));
    for (const int64_t counter : {10, 9, 1}) {
        EXPECT_FALSE(hear(boot, counter, now_utime + 5000000, 1000));
    }
    EXPECT_FALSE(hear(boot - 1, 400, now_utime - 60000000, 1000)) << "an earlier start, recorded then";
    EXPECT_FALSE(hear(boot - 1, 401, now_utime - 59000000, 2000));
    EXPECT_EQ(ale_operator_rival(&end, 2000), nullptr);
    EXPECT_EQ(send(2000, now_utime + 2000), ALE_GENUINE);
}

TEST_F(Believing, WhatWasMadeByHeldBackWordsIsMadeAgainByTheRobotsOwn)
{
    EXPECT_TRUE(hear(boot, 3, now_utime - 60000000, 0));
    make("stop", 0);
    EXPECT_TRUE(hear(boot, 70, now_utime, 1000));
    EXPECT_TRUE(ale_operator_was_misled(&end, &end.made, 100000)) << "of this start, a minute ago";
    make("stop", 100000);
    EXPECT_TRUE(hear(boot, 71, now_utime + 1000000, 1001000));
    EXPECT_FALSE(ale_operator_was_misled(&end, &end.made, 1100000));
    make("drive", 1100000);
    EXPECT_TRUE(hear(boot, 72, now_utime + 2700000, 2100000));
    EXPECT_FALSE(ale_operator_was_misled(&end, &end.made, 1300000)) << "0.6 s: the robot takes it still";
    EXPECT_TRUE(hear(boot + 1, 1, now_utime + 2900000, 2200000));
    EXPECT_TRUE(ale_operator_was_misled(&end, &end.made, 2300000)) << "for a start that is over";
}

TEST_F(Believing, ARobotThatStartsAgainIsFollowedAlsoWithAClockThatWasSetBack)
{
    EXPECT_TRUE(hear(boot - 1, 900, now_utime, 0));
    EXPECT_TRUE(hear(boot, 1, now_utime + 2000000, 2000000));
    EXPECT_EQ(send(2000000, now_utime + 2000000), ALE_GENUINE);
    EXPECT_FALSE(hear(boot + 1, 1, 1000000, 3000000)) << "1970: it might be a memory";
    EXPECT_TRUE(hear(boot + 1, 2, 4100000, 6100000)) << "the other one is silent since";
}

TEST_F(Believing, NumbersOutOfThisWorldAreRefused)
{
    EXPECT_FALSE(hear(boot, 1, -1, 0));
    EXPECT_FALSE(hear(boot, 1, INT64_MAX, 0));
}

TEST_F(OperatorEnd, WordsThatDoNotFitAreRefused)
{
    ale_command_t command;
    const std::string long_word(ALE_COMMAND_ARG_BYTES, 'x');
    const char *const words[] = {"set", long_word.c_str(), "1", "2", "3", "4", "5", "6", "7", "8"};
    EXPECT_LT(ale_command_from_words(words, 2, &command), 0);
    EXPECT_LT(ale_command_from_words(words, 0, &command), 0);
    EXPECT_LT(ale_command_from_words(words, 10, &command), 0);
}

} // namespace
