// firmware/system/log_line: what threads that may wait log, in the form of all lines.
#include <gtest/gtest.h>

#include <cstdlib>
#include <regex>
#include <string>

extern "C" {
#include "system/log_line.h"
}

namespace
{

std::string logged(const char *words)
{
    testing::internal::CaptureStderr();
    ale_log_line("%s: %d times", words, 3);
    return testing::internal::GetCapturedStderr();
}

TEST(LogLine, TheTimeIsInTheLineWhereNoJournalKeepsIt)
{
    unsetenv("JOURNAL_STREAM");
    const std::regex form(R"(ale-slamd: \d{4}-\d\d-\d\d \d\d:\d\d:\d\d gone: 3 times\n)");
    EXPECT_TRUE(std::regex_match(logged("gone"), form)) << logged("gone");
    setenv("JOURNAL_STREAM", "8:12345", 1);
    EXPECT_EQ(logged("gone"), "ale-slamd: gone: 3 times\n");
    unsetenv("JOURNAL_STREAM");
}

TEST(LogLine, ItIsOneLineHoweverLong)
{
    const std::string line = logged(std::string(5000, 'a').c_str());
    EXPECT_LT(line.size(), 1100u);
    EXPECT_EQ(line.find('\n'), line.size() - 1);
}

} // namespace
