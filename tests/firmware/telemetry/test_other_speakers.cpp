#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <string>

extern "C" {
#include "telemetry/other_speakers.h"
}

namespace
{

constexpr int64_t kSecond = 1000000000;

ale_speaker_t speaker(int64_t boot, const char *robot = "second")
{
    ale_speaker_t told{};
    told.boot = boot;
    told.process = 4711;
    std::snprintf(told.host, sizeof told.host, "lab");
    std::snprintf(told.robot, sizeof told.robot, "%s", robot);
    return told;
}

class OtherSpeakers : public testing::Test
{
  protected:
    OtherSpeakers()
    {
        ale_other_speakers_init(&others, 5, "first");
    }
    std::string word(int64_t now_ns)
    {
        char line[ALE_SPEAKERS_LINE] = "";
        return ale_other_speakers_word(&others, now_ns, line) ? line : "";
    }
    ale_other_speakers_t others{};
    int64_t now = 100 * kSecond;
};

TEST_F(OtherSpeakers, ItKnowsWhoItIs)
{
    EXPECT_EQ(others.self.boot, 5);
    EXPECT_EQ(others.self.process, getpid());
    EXPECT_STREQ(others.self.robot, "first");
    char host[64] = "";
    ASSERT_EQ(gethostname(host, sizeof host - 1), 0);
    EXPECT_STREQ(others.self.host, host);
}

TEST_F(OtherSpeakers, WhatItSaysItselfIsNobodyElse)
{
    ale_other_speakers_take(&others, &others.self, now);
    EXPECT_EQ(ale_other_speakers_count(&others, now), 0U);
    EXPECT_EQ(word(now), "");
}

TEST_F(OtherSpeakers, AnotherOneIsSaidOnceAndCountedWhileItSpeaks)
{
    for (int k = 0; k < 60; k++, now += kSecond) {
        const ale_speaker_t other = speaker(7);
        ale_other_speakers_take(&others, &other, now);
        EXPECT_EQ(ale_other_speakers_count(&others, now), 1U);
        EXPECT_EQ(word(now),
                  k > 0 ? ""
                        : "another ale-slamd speaks on the same channels: robot second on lab, process "
                          "4711, boot nonce 7; end one of the two, or give it channels of its own ([lcm] "
                          "prefix)");
    }
    EXPECT_EQ(ale_other_speakers_count(&others, now + 3 * kSecond), 0U);
}

TEST_F(OtherSpeakers, AFloodOfThemMakesAWordInTenSeconds)
{
    int words = 0;
    for (int64_t boot = 10; boot < 1010; boot++, now += kSecond / 10) {
        const ale_speaker_t other = speaker(boot);
        ale_other_speakers_take(&others, &other, now);
        words += !word(now).empty();
    }
    EXPECT_LE(words, 11);
    EXPECT_EQ(ale_other_speakers_count(&others, now), static_cast<uint32_t>(ALE_OTHER_SPEAKERS));
}

} // namespace
