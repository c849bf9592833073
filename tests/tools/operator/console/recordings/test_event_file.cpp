/* LCM event logs: written as liblcm reads them, read whatever has happened to them. */
#include "operator/console/recordings/event_file.h"

#include <gtest/gtest.h>

#include <csignal>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <lcm/eventlog.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include "files.hpp"

using console::Descriptor;
using console::EventPlace;
using console::EventReader;
using console::EventWriter;

namespace
{

constexpr int events = 5;

std::vector<uint8_t> message(int k)
{
    return std::vector<uint8_t>(static_cast<size_t>(100 * k), static_cast<uint8_t>('a' + k));
}

Descriptor opened(const std::string &path, int how)
{
    return Descriptor(open(path.c_str(), how | O_CLOEXEC, 0600));
}

void write_five(const std::string &path)
{
    EventWriter writer(opened(path, O_WRONLY | O_CREAT | O_TRUNC));
    for (int k = 0; k < events; k++) {
        const std::vector<uint8_t> bytes = message(k);
        writer.put(1000 + k, "CHANNEL_" + std::to_string(k), bytes.data(), bytes.size());
    }
    ASSERT_EQ(writer.flush(), 0);
    EXPECT_EQ(writer.events(), 5U);
}

/* Numbers of those that are read, in their order; each must be as it was written. */
std::vector<int> numbers_read(const std::string &path, uint64_t from = 0)
{
    const Descriptor file = opened(path, O_RDONLY);
    EventReader reader(file, from);
    EventPlace place;
    std::vector<int> numbers;
    while (reader.next(place)) {
        const auto k = static_cast<int>(place.received_us - 1000);
        EXPECT_EQ(place.channel, "CHANNEL_" + std::to_string(k));
        EXPECT_EQ(data_of(file, place), message(k));
        numbers.push_back(k);
    }
    return numbers;
}

} // namespace

TEST(EventFile, IsReadByLiblcmAndByItself)
{
    const files::TemporaryFolder folder;
    const std::string path = (folder / "events.lcm").string();
    write_five(path);
    lcm_eventlog_t *log = lcm_eventlog_create(path.c_str(), "r");
    for (int k = 0; k < events; k++) {
        lcm_eventlog_event_t *event = lcm_eventlog_read_next_event(log);
        ASSERT_NE(event, nullptr);
        EXPECT_EQ(event->eventnum, k);
        EXPECT_EQ(event->timestamp, 1000 + k);
        EXPECT_EQ(std::string(event->channel), "CHANNEL_" + std::to_string(k));
        ASSERT_EQ(event->datalen, 100 * k);
        EXPECT_EQ(std::memcmp(event->data, message(k).data(), message(k).size()), 0);
        lcm_eventlog_free_event(event);
    }
    EXPECT_EQ(lcm_eventlog_read_next_event(log), nullptr);
    lcm_eventlog_destroy(log);
    EXPECT_EQ(numbers_read(path), (std::vector<int>{0, 1, 2, 3, 4}));
}

TEST(EventFile, BeginsAtTheNextEventFromAnywhere)
{
    const files::TemporaryFolder folder;
    const std::string path = (folder / "middle.lcm").string();
    write_five(path);
    EXPECT_EQ(numbers_read(path, 1), (std::vector<int>{1, 2, 3, 4}));
    EXPECT_EQ(numbers_read(path, 37), (std::vector<int>{1, 2, 3, 4})) << "where the second one begins";
    EXPECT_TRUE(numbers_read(path, 1 << 30).empty());
}

TEST(EventFile, WhateverByteOfAHeadIsDamagedTheRestIsRead)
{
    const files::TemporaryFolder folder;
    const std::string path = (folder / "damaged.lcm").string();
    write_five(path);
    const std::string whole = files::content(path);
    for (size_t at = 37; at < 37U + 37U; at++) {
        std::string damaged = whole;
        damaged[at] = static_cast<char>(damaged[at] ^ 0x80);
        files::write(path, damaged);
        const Descriptor file = opened(path, O_RDONLY);
        EventReader reader(file);
        EventPlace place;
        size_t read = 0;
        while (reader.next(place)) {
            read++;
        }
        EXPECT_GE(read, 4U) << at;
    }
    for (size_t size = 0; size < whole.size(); size += 29) {
        files::write(path, whole.substr(0, size));
        EXPECT_LE(numbers_read(path).size(), 4U) << "cut at " << size;
    }
}

TEST(EventFile, WhatIsSkippedIsCounted)
{
    const files::TemporaryFolder folder;
    const std::string path = (folder / "damaged.lcm").string();
    write_five(path);
    const auto damage_of = [&](const std::string &bytes) {
        files::write(path, bytes);
        const Descriptor file = opened(path, O_RDONLY);
        EventReader reader(file);
        EventPlace place;
        while (reader.next(place)) {
        }
        return std::make_pair(reader.damage().places, reader.damage().bytes);
    };
    using Counts = std::pair<uint64_t, uint64_t>;
    const std::string whole = files::content(path);
    EXPECT_EQ(damage_of(whole), Counts(0, 0));
    constexpr size_t head = 28 + 9; /* and the channel */
    const size_t second = head;
    const size_t fourth = 3 * head + 100 + 200;
    std::string damaged = whole;
    damaged[second] = damaged[fourth] = 0;
    EXPECT_EQ(damage_of(damaged), Counts(2, 2 * head + 100 + 300));
    damaged[second + head + 100] = 0; /* what lies between them, too: one place */
    EXPECT_EQ(damage_of(damaged), Counts(1, 3 * head + 100 + 200 + 300));
    EXPECT_EQ(damage_of(whole + "abc"), Counts(1, 3));
}

TEST(EventFile, LengthsThatCannotBeTakeNoMemory)
{
    const files::TemporaryFolder folder;
    const std::string path = (folder / "forged.lcm").string();
    write_five(path);
    std::string forged = files::content(path);
    for (size_t k = 24; k < 28; k++) {
        forged[k] = '\x7f';
    }
    files::write(path, forged);
    EXPECT_EQ(numbers_read(path), (std::vector<int>{1, 2, 3, 4}));
}

/* In a process of its own, whose files may not be larger than this. */
TEST(EventFile, ADiskThatTakesNoMoreLeavesWholeEventsAndIsTold)
{
    const files::TemporaryFolder folder;
    const std::string path = (folder / "full.lcm").string();
    const pid_t child = fork();
    if (child == 0) {
        constexpr rlim_t most = 300;
        const rlimit limit = {most, most};
        std::signal(SIGXFSZ, SIG_IGN);
        setrlimit(RLIMIT_FSIZE, &limit);
        EventWriter writer(opened(path, O_WRONLY | O_CREAT | O_TRUNC));
        for (int k = 0; k < events; k++) {
            writer.put(1000 + k, "CHANNEL_" + std::to_string(k), message(k).data(), message(k).size());
        }
        _exit(writer.flush() == EFBIG && writer.events() == 2 ? 0 : 1);
    }
    int status = 1;
    waitpid(child, &status, 0);
    EXPECT_EQ(status, 0);
    EXPECT_EQ(numbers_read(path), (std::vector<int>{0, 1}));
    EXPECT_EQ(files::content(path).size(), 37U + 137U) << "nothing behind them";
}
