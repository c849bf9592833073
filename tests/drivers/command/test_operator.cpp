/* The operator's end against the robot's: what the one makes the other takes. */
#include <gtest/gtest.h>

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
