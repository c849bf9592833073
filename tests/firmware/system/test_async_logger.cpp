// firmware/system/async_logger: lines for people, whatever they are written on.
#include <gtest/gtest.h>

#include <fcntl.h>
#include <unistd.h>

#include <ctime>
#include <string>

#include "firmware/surroundings.hpp"

extern "C" {
#include "system/async_logger.h"
}

namespace
{

class AsyncLogger : public surroundings::WithPort
{
  protected:
    void SetUp() override
    {
        int ends[2];
        ASSERT_EQ(pipe(ends), 0);
        reading = ends[0];
        out = fdopen(ends[1], "w");
        ASSERT_NE(out, nullptr);
        logger = ale_logger_start(out, false);
        ASSERT_NE(logger, nullptr);
    }
    void TearDown() override
    {
        close(reading);
    }

    // Until a write to the pipe would have to wait for its reader. How many bytes that are.
    size_t fill_the_pipe() const
    {
        const int writing = fileno(out);
        EXPECT_GT(fcntl(writing, F_SETPIPE_SZ, 4096), 0);
        const int flags = fcntl(writing, F_GETFL);
        EXPECT_EQ(fcntl(writing, F_SETFL, flags | O_NONBLOCK), 0);
        size_t count = 0;
        while (write(writing, "x", 1) == 1) {
            count++;
        }
        EXPECT_EQ(fcntl(writing, F_SETFL, flags), 0);
        return count;
    }
    std::string read_line() const
    {
        std::string line;
        for (char c = 0; read(reading, &c, 1) == 1 && c != '\n';) {
            line += c;
        }
        return line;
    }

    int reading = -1;
    FILE *out = nullptr;
    ale_logger_t *logger = nullptr;
};

TEST_F(AsyncLogger, WhatKeepsNoTimeIsToldWhenALineWasLogged)
{
    ale_logger_stop(logger);
    logger = ale_logger_start(out, true);
    ASSERT_NE(logger, nullptr);
    const time_t before = time(nullptr);
    ale_logger_log(logger, "one");
    const std::string line = read_line();
    struct tm moment = {};
    const char *end = strptime(line.c_str(), "ale-slamd: %Y-%m-%d %H:%M:%S ", &moment);
    ASSERT_NE(end, nullptr) << line;
    EXPECT_STREQ(end, "one");
    // The time zone is libc's, behind a lock that the thread sanitizer does not see: the logger's thread has
    // ended first.
    ale_logger_stop(logger);
    moment.tm_isdst = -1;
    const time_t logged = mktime(&moment);
    EXPECT_GE(logged, before);
    EXPECT_LE(logged, time(nullptr));
    fclose(out);
}

TEST_F(AsyncLogger, MessagesComeOutLineByLineAfterTheProgramsName)
{
    ale_logger_log(logger, "one");
    ale_logger_log(logger, "two");
    EXPECT_EQ(read_line(), "ale-slamd: one");
    EXPECT_EQ(read_line(), "ale-slamd: two");
    ale_logger_stop(logger);
    fclose(out);
}

TEST_F(AsyncLogger, AReaderThatHoldsUpTheWriterDoesNotHoldUpWhoLogs)
{
    const size_t before = fill_the_pipe();
    for (int k = 0; k < 100; k++) {
        ale_logger_log(logger, "said while nobody reads"); // returns, or this test never ends
    }
    for (size_t k = 0; k < before; k++) {
        char c = 0;
        ASSERT_EQ(read(reading, &c, 1), 1);
    }
    EXPECT_EQ(read_line(), "ale-slamd: said while nobody reads");
    ale_logger_stop(logger);
    fclose(out);
}

TEST_F(AsyncLogger, DroppedLinesAreCountedAndToldOnceThereIsRoomAgain)
{
    const size_t before = fill_the_pipe();
    EXPECT_EQ(ale_logger_dropped(logger), 0U);
    for (int k = 0; k < 100; k++) {
        ale_logger_log(logger, "held up");
    }
    const uint32_t dropped = ale_logger_dropped(logger);
    EXPECT_EQ(dropped, 100U - 16U); /* the one that is being written waits, too */
    for (size_t k = 0; k < before; k++) {
        char c = 0;
        ASSERT_EQ(read(reading, &c, 1), 1);
    }
    for (uint32_t k = dropped; k < 100; k++) {
        EXPECT_EQ(read_line(), "ale-slamd: held up");
    }
    EXPECT_EQ(read_line(), "ale-slamd: 84 lines left out here: nobody took them in time");
    ale_logger_log(logger, "free again");
    EXPECT_EQ(read_line(), "ale-slamd: free again");
    ale_logger_stop(logger);
    fclose(out);
}

TEST_F(AsyncLogger, AStopWritesWhatWasLogged)
{
    ale_logger_log(logger, std::string(1000, 'a').c_str());
    ale_logger_stop(logger);
    EXPECT_EQ(read_line(), "ale-slamd: " + std::string(ALE_LOGGER_LINE - 1, 'a'));
    fclose(out);
}

} // namespace
