// drivers/command/verb: which commands there are.
#include <gtest/gtest.h>

#include <string>
#include <vector>

extern "C" {
#include "command/operator.h"
#include "command/verb.h"
}

namespace
{

struct Answer {
    int verb;
    std::string error;
};

Answer read(const std::vector<const char *> &words)
{
    ale_command_t command;
    EXPECT_EQ(ale_command_from_words(words.data(), static_cast<uint32_t>(words.size()), &command), 0);
    char error[ALE_VERB_ERROR] = "";
    const int verb = ale_verb_of(&command, error);
    return {verb, error};
}

TEST(Verb, EachIsKnownWithAsManyArgumentsAsItTakes)
{
    EXPECT_EQ(read({"drive", "0.2", "0"}).verb, ALE_VERB_DRIVE);
    EXPECT_EQ(read({"stop"}).verb, ALE_VERB_STOP);
    EXPECT_EQ(read({"explore", "on"}).verb, ALE_VERB_EXPLORE);
    EXPECT_EQ(read({"reset"}).verb, ALE_VERB_RESET);
    EXPECT_EQ(read({"relocate", "1", "2", "3"}).verb, ALE_VERB_RELOCATE);
    EXPECT_EQ(read({"save_map", "home"}).verb, ALE_VERB_SAVE_MAP);
    EXPECT_EQ(read({"load_map", "home"}).verb, ALE_VERB_LOAD_MAP);
    EXPECT_EQ(read({"load_map", "home", "1", "2", "3"}).verb, ALE_VERB_LOAD_MAP);
    EXPECT_EQ(read({"record"}).verb, ALE_VERB_RECORD);
    for (const char *setting : {"drive_speed", "drive_turn", "publish_scan", "freeze_map"}) {
        EXPECT_EQ(read({"set", setting, "1"}).verb, ALE_VERB_SET) << setting;
    }
}

TEST(Verb, WhatNoRobotCouldObeyIsToldInWords)
{
    const struct {
        std::vector<const char *> words;
        const char *error;
    } cases[] = {
        {{"fly"}, "no verb fly"},
        {{""}, "no verb "},
        {{"Drive", "1", "0"}, "no verb Drive"},
        {{"drive", "1"}, "drive takes 2 arguments, not 1"},
        {{"stop", "now"}, "stop takes 0 arguments, not 1"},
        {{"explore"}, "explore takes 1 argument, not 0"},
        {{"load_map"}, "load_map takes 1 to 4 arguments, not 0"},
        {{"load_map", "a", "1", "2", "3", "4"}, "load_map takes 1 to 4 arguments, not 5"},
        {{"set", "drive_speed"}, "set takes 2 arguments, not 1"},
        {{"set", "colour", "blue"}, "no setting colour"},
    };
    for (const auto &c : cases) {
        const Answer answer = read(c.words);
        EXPECT_EQ(answer.verb, -1) << c.error;
        EXPECT_EQ(answer.error, c.error);
    }
}

} // namespace
