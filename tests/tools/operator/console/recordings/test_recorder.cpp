/* What is heard becomes a file, or is counted. */
#include "operator/console/recordings/recorder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <map>
#include <stdexcept>
#include <thread>

#include <sys/resource.h>

#include "ale/map_t.hpp"
#include "files.hpp"

using console::Descriptor;
using console::EventPlace;
using console::EventReader;
using console::Recorder;
using console::RecorderState;
using console::Shelf;

namespace
{

class Recorded : public testing::Test
{
  protected:
    void say(Recorder &recorder, const char *channel, size_t bytes = 8)
    {
        const std::vector<uint8_t> message(bytes, 'x');
        recorder.take(channel, message.data(), message.size());
    }

    std::map<std::string, int> events_of(const std::string &name)
    {
        const Descriptor file = shelf_.open(name);
        EventReader reader(file);
        EventPlace place;
        std::map<std::string, int> count;
        while (reader.next(place)) {
            count[place.channel]++;
        }
        return count;
    }

    const files::TemporaryFolder root_;
    const std::string folder_ = (root_ / "recorded").string();
    const Shelf shelf_{folder_, ".lcm"};
};

void say_map(Recorder &recorder, int32_t version, int16_t part, int16_t parts)
{
    ale::map_t map{};
    map.version = version;
    map.part = part;
    map.parts = parts;
    std::vector<uint8_t> bytes(static_cast<size_t>(map.getEncodedSize()));
    map.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
    recorder.take("ALE_MAP", bytes.data(), bytes.size());
}

} // namespace

TEST_F(Recorded, WhatComesBetweenStartAndStopIsInTheFile)
{
    Recorder recorder(shelf_, 0);
    say(recorder, "BEFORE");
    recorder.start();
    const std::string name = recorder.state().name;
    for (int k = 0; k < 100; k++) {
        say(recorder, k % 2 == 0 ? "ALE_POSE" : "ALE_SCAN", 2000);
    }
    recorder.stop();
    say(recorder, "AFTER");
    EXPECT_EQ(events_of(name), (std::map<std::string, int>{{"ALE_POSE", 50}, {"ALE_SCAN", 50}}));
    const RecorderState state = recorder.state();
    EXPECT_EQ(state.messages, 100U);
    EXPECT_EQ(state.dropped, 0U);
    EXPECT_EQ(state.bytes, std::filesystem::file_size(folder_ + "/" + name));
    EXPECT_TRUE(state.name.empty());
    EXPECT_TRUE(state.trouble.empty());
}

TEST_F(Recorded, TwoInOneSecondAreTwoFilesAndStartingTwiceIsOne)
{
    Recorder recorder(shelf_, 0);
    for (int k = 0; k < 3; k++) {
        recorder.start();
        recorder.start();
        recorder.stop();
    }
    EXPECT_EQ(shelf_.list().size(), 3U);
}

TEST_F(Recorded, BeginsWithTheNewestMapThatWasWhole)
{
    Recorder recorder(shelf_, 0);
    say_map(recorder, 1, 0, 1);
    say_map(recorder, 2, 0, 3);
    say_map(recorder, 2, 1, 3);
    say_map(recorder, 2, 2, 3);
    say_map(recorder, 3, 0, 2);
    say(recorder, "ALE_MAP", 5);
    recorder.start();
    const std::string name = recorder.state().name;
    recorder.stop();
    EXPECT_EQ(events_of(name), (std::map<std::string, int>{{"ALE_MAP", 3}}));
}

/* Whoever floods it fills the queue, not the memory, and holds up nobody; each message is written or counted.
 */
TEST_F(Recorded, AFloodIsDroppedAndCountedAndHoldsUpNobody)
{
    Recorder recorder(shelf_, 0);
    recorder.start();
    const std::string name = recorder.state().name;
    constexpr int messages = 1000;
    for (int k = 0; k < messages; k++) {
        say(recorder, "ALE_SCAN", 60000);
    }
    recorder.stop();
    const RecorderState state = recorder.state();
    EXPECT_EQ(state.messages + state.dropped, 1000U);
    EXPECT_GT(state.messages, 100U);
    EXPECT_EQ(static_cast<uint64_t>(events_of(name)["ALE_SCAN"]), state.messages);
}

TEST_F(Recorded, WhyNothingCanBeRecordedIsSaidInWords)
{
    const Shelf none("", ".lcm");
    const Shelf full(folder_, ".lcm");
    const Shelf nowhere("/proc/no/such", ".lcm");
    std::filesystem::create_directory(folder_);
    const std::vector<std::pair<const Shelf *, std::string>> cases = {
        {&none, "--recordings DIR"},
        {&full, "is full"},
        {&nowhere, "/proc/no/such: No such file or directory"}};
    for (const auto &[shelf, words] : cases) {
        Recorder recorder(*shelf, shelf == &full ? UINT64_MAX - 1 : 0);
        try {
            recorder.start();
            FAIL() << words;
        } catch (const std::runtime_error &error) {
            EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
        }
        EXPECT_TRUE(recorder.state().name.empty());
    }
}

/* Files of this process may not be larger: what a disk says that takes no more. */
TEST_F(Recorded, ADiskThatTakesNoMoreEndsItWithWordsAndWhatCameBeforeIsThere)
{
    std::signal(SIGXFSZ, SIG_IGN);
    rlimit before;
    getrlimit(RLIMIT_FSIZE, &before);
    Recorder recorder(shelf_, 0);
    recorder.start();
    const std::string name = recorder.state().name;
    const rlimit limit = {20000, before.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
    uint64_t said = 0;
    for (; recorder.state().trouble.empty() && said < 10000; said++) {
        say(recorder, "ALE_SCAN", 3000);
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    setrlimit(RLIMIT_FSIZE, &before);
    recorder.stop();
    const RecorderState state = recorder.state();
    EXPECT_EQ(state.trouble, "the recording " + name + " has ended: " + folder_ +
                                 ": File too large; what came before is in it");
    EXPECT_TRUE(state.name.empty());
    EXPECT_EQ(state.messages, 6U);
    EXPECT_EQ(state.messages + state.dropped, said);
    EXPECT_EQ(events_of(name)["ALE_SCAN"], 6);
    recorder.start();
    EXPECT_TRUE(recorder.state().trouble.empty()) << "the next one begins anew";
}
