// Which of two robots on the same channels is shown, and what is told of the other.
#include "operator/console/speaker_choice.h"

#include <cstring>

#include <gtest/gtest.h>

using console::SpeakerChoice;
using namespace std::chrono_literals;

namespace
{

ale::speaker_t speaker_of(int64_t boot, const char *robot)
{
    ale::speaker_t speaker{};
    speaker.boot = boot;
    speaker.process = 12;
    std::memcpy(speaker.host, "lab", 3);
    std::memcpy(speaker.robot, robot, std::strlen(robot));
    return speaker;
}

const SpeakerChoice::Clock::time_point start = SpeakerChoice::Clock::now();

} // namespace

TEST(SpeakerChoice, TheFirstOneIsShownForAsLongAsItSpeaks)
{
    SpeakerChoice choice;
    for (int k = 0; k < 100; k++) {
        EXPECT_TRUE(choice.shows(1, start + k * 100ms));
        EXPECT_FALSE(choice.shows(2, start + k * 100ms));
        EXPECT_TRUE(choice.shows(0, start + k * 100ms)) << "nobody knows whose that is";
    }
    EXPECT_FALSE(choice.shows(2, start + 11s));
    EXPECT_TRUE(choice.shows(2, start + 11500ms)) << "1.5 s of silence";
    EXPECT_FALSE(choice.shows(1, start + 12s));
}

TEST(SpeakerChoice, TheOneThatIsAskedForGoesBeforeTheFirst)
{
    SpeakerChoice choice;
    EXPECT_TRUE(choice.shows(1, start));
    EXPECT_TRUE(choice.choose(2, start));
    EXPECT_TRUE(choice.shows(2, start));
    EXPECT_FALSE(choice.choose(2, start + 1s)) << "it is shown already";
    EXPECT_FALSE(choice.choose(3, start + 2s)) << "two of that name do not take turns";
    EXPECT_TRUE(choice.shows(2, start + 2s));
    EXPECT_TRUE(choice.choose(3, start + 4s));
}

TEST(SpeakerChoice, AnotherOneIsToldOfWhileItSpeaks)
{
    SpeakerChoice choice;
    choice.heard(speaker_of(7, "first"), start);
    EXPECT_FALSE(choice.warning(7, start));
    EXPECT_FALSE(choice.warning(std::nullopt, start)) << "none is shown yet";
    choice.heard(speaker_of(8, "second\n"), start);
    EXPECT_EQ(
        choice.warning(7, start),
        "Another robot speaks on the same channels, and is not shown: second? on lab, process 12. End one of "
        "the two, or give it channels of its own ([lcm] prefix).");
    EXPECT_FALSE(choice.warning(7, start + 3s));
    for (int64_t boot = 100; boot < 10000; boot++) {
        choice.heard(speaker_of(boot, "many"), start + 4s);
    }
    EXPECT_TRUE(choice.warning(7, start + 4s));
}
