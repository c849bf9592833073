/* A flight becomes a log by a program of its own, of which nothing is left behind. The real one is in
 * tests/tools/test_console_flights.py. */
#include "operator/console/recordings/replayed.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <stdexcept>
#include <thread>

#include <fcntl.h>
#include <unistd.h>

#include "files.hpp"

using console::Descriptor;
using console::Replay;
using console::replayed;

namespace
{

class Replayed : public testing::Test
{
  protected:
    Replayed()
    {
        std::filesystem::create_directory(temporary_);
        setenv("TMPDIR", temporary_.c_str(), 1);
        setenv("PATH", (root_.path().string() + ":" + path_).c_str(), 1);
        files::write(flight_, "bytes");
    }
    ~Replayed() override
    {
        setenv("PATH", path_.c_str(), 1);
        unsetenv("TMPDIR");
    }

    /* What stands in for ale-replay: is given FLIGHT --lcm LOG. */
    void replay_by(const std::string &script)
    {
        files::write(program_, "#!/bin/sh\n" + script + "\n");
        std::filesystem::permissions(program_, std::filesystem::perms::owner_all);
    }

    Replay replay()
    {
        return replayed(Descriptor(open(flight_.c_str(), O_RDONLY | O_CLOEXEC)), "a.scip", stopping_);
    }

    std::string complaint()
    {
        try {
            replay();
        } catch (const std::runtime_error &error) {
            return error.what();
        }
        return "";
    }

    const files::TemporaryFolder root_;
    const std::string path_ = getenv("PATH");
    const std::string temporary_ = (root_ / "tmp").string();
    const std::string program_ = (root_ / "ale-replay").string();
    const std::string flight_ = (root_ / "a.scip").string();
    std::atomic<bool> stopping_{false};
};

} // namespace

TEST_F(Replayed, TheLogIsAFileWithoutANameAndOthersComeFirst)
{
    replay_by("test $2 = --lcm && (cat \"$1\"; nice) > \"$3\"");
    const Replay made = replay();
    EXPECT_EQ(made.damage, "");
    char text[16] = "";
    EXPECT_GT(pread(made.log.number(), text, sizeof text - 1, 0), 0);
    EXPECT_STREQ(text, "bytes19\n");
    EXPECT_TRUE(std::filesystem::is_empty(temporary_));
}

TEST_F(Replayed, WhatItComplainsOfIsToldWithTheRecordingsOwnName)
{
    replay_by(
        "echo ale-replay: warned >&2; echo \"ale-replay: $1: log without a scan; $1: cut\" >&2; exit 1");
    EXPECT_EQ(complaint(), "it cannot be replayed: a.scip: log without a scan; a.scip: cut");
    replay_by("kill -11 $$");
    EXPECT_EQ(complaint(), "a.scip: ale-replay was ended by signal 11");
    replay_by("kill -25 $$");
    EXPECT_EQ(complaint(), "there is no room in " + temporary_ + " to replay a.scip");
    EXPECT_TRUE(std::filesystem::is_empty(temporary_));
}

TEST_F(Replayed, WhatWasLeftOutIsTold)
{
    replay_by("echo $1: 5 scans >&2; echo 'ale-replay: skipped 2 bad lines or chunks and 0 scans of too many "
              "beams; last: x' >&2");
    EXPECT_EQ(replay().damage, "2 damaged places left out");
    replay_by("echo 'ale-replay: skipped 1 bad lines or chunks and 3 scans of too many beams; last: x' >&2");
    EXPECT_EQ(replay().damage, "1 damaged place left out, 3 scans of too many beams left out");
}

TEST_F(Replayed, WithoutTheProgramOrAFolderItSaysSo)
{
    EXPECT_EQ(complaint(), "ale-replay, which replays it, is not there");
    std::filesystem::remove(temporary_);
    EXPECT_NE(complaint(), "") << "no folder for it";
}

TEST_F(Replayed, ItEndsWhenAllIsToStop)
{
    replay_by("echo $$ > \"$3\"; exec sleep 1000");
    std::thread stopper([this] { stopping_ = true; });
    EXPECT_EQ(complaint(), "a.scip: ale-replay was ended by signal 9");
    stopper.join();
}
