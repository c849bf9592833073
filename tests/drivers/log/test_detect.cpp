#include <fstream>
#include <random>

#include <gtest/gtest.h>

#include "files.hpp"
#include "log_text.hpp"

using ale_test::bzip2;
using ale_test::error_of;
using ale_test::gzip;
using ale_test::read_bytes;
using ale_test::read_file;

namespace
{

const std::string scan_line = "FLASER 3 1 2 3 0 0 0 0 0 0 1 h 1\n";

class LogFile : public testing::Test
{
  protected:
    std::string path(const std::string &name) const
    {
        return folder_ / name;
    }
    std::string write(const std::string &name, const std::string &bytes) const
    {
        std::ofstream(path(name), std::ios::binary) << bytes;
        return path(name);
    }

    const files::TemporaryFolder folder_;
};

TEST_F(LogFile, PlainAndGzipGiveTheSame)
{
    std::string text;
    for (int k = 0; k < 3000; k++) {
        text += "FLASER 3 1 2 3 0 0 0 0 0 0 " + std::to_string(k) + " h 1\n";
    }
    const auto plain = read_file(write("a.log", text));
    const auto packed = read_file(write("a.log.gz", gzip(text)));
    EXPECT_EQ(plain.scans().size(), 3000U);
    ASSERT_EQ(packed.scans().size(), 3000U);
    EXPECT_EQ(packed.scans().back().stamp_us, plain.scans().back().stamp_us);
    EXPECT_EQ(packed.statistics.bytes_read, text.size());
    EXPECT_EQ(packed.statistics.bytes_total, text.size());
    EXPECT_FALSE(packed.statistics.cut_short);
}

TEST_F(LogFile, TheNameDoesNotDecide)
{
    EXPECT_EQ(read_file(write("packed.txt", gzip(scan_line))).scans().size(), 1U);
    EXPECT_EQ(read_file(write("plain.gz", scan_line)).scans().size(), 1U);
}

TEST_F(LogFile, MembersOfAGzipFileFollowOneAnother)
{
    EXPECT_EQ(read_bytes(gzip(scan_line) + gzip(scan_line)).scans().size(), 2U);
}

TEST_F(LogFile, AGzipFileThatWasCutYieldsWhatCameBefore)
{
    std::mt19937 random(3);
    std::string text;
    for (int k = 0; k < 2000; k++) {
        text += "FLASER 3 1 2 3 0 0 0 0 0 " + std::to_string(random() % 1000) + " " + std::to_string(k) +
                " h 1\n";
    }
    const std::string packed = gzip(text);
    const auto log = read_bytes(packed.substr(0, packed.size() / 2));
    EXPECT_GT(log.scans().size(), 500U);
    EXPECT_LT(log.scans().size(), 1500U);
    EXPECT_TRUE(log.statistics.cut_short);
}

TEST_F(LogFile, Bzip2IsUnpackedStreamAfterStream)
{
    std::mt19937 random(5);
    std::string text;
    for (int k = 0; k < 30000; k++) {
        text += "FLASER 3 1 2 3 0 0 0 0 0 " + std::to_string(random() % 1000) + " " + std::to_string(k) +
                " h 1\n";
    }
    const auto plain = read_bytes(text);
    const auto packed = read_file(write("a.clf.bz2", bzip2(text)));
    EXPECT_EQ(packed.scans().size(), 30000U);
    EXPECT_EQ(packed.scans().back().stamp_us, plain.scans().back().stamp_us);
    EXPECT_EQ(packed.statistics.bytes_total, text.size());
    EXPECT_FALSE(packed.statistics.cut_short);
    EXPECT_EQ(read_bytes(bzip2(scan_line) + bzip2(scan_line)).scans().size(), 2U);
}

TEST_F(LogFile, ABzip2FileThatWasCutOrDamagedYieldsWhatCameBefore)
{
    std::mt19937 random(3);
    std::string text;
    for (int k = 0; k < 20000; k++) {
        text += "FLASER 3 1 2 3 0 0 0 0 0 " + std::to_string(random() % 1000) + " " + std::to_string(k) +
                " h 1\n";
    }
    const std::string packed = bzip2(text);
    const auto cut = read_bytes(packed.substr(0, packed.size() / 2));
    EXPECT_GT(cut.scans().size(), 1000U);
    EXPECT_LT(cut.scans().size(), 20000U);
    EXPECT_TRUE(cut.statistics.cut_short);
    std::string damaged = packed;
    damaged[packed.size() / 2] = static_cast<char>(damaged[packed.size() / 2] ^ 0x55);
    const auto read = read_bytes(damaged);
    EXPECT_GT(read.scans().size(), 1000U);
    EXPECT_TRUE(read.statistics.cut_short);
}

TEST_F(LogFile, WhatIsNoLogIsRefusedWithTheReason)
{
    EXPECT_THROW(read_file(path("absent")), std::runtime_error);
    EXPECT_NE(error_of("").find("is empty"), std::string::npos);
    EXPECT_NE(error_of("hello\nworld\n").find("no line of a known format"), std::string::npos);
    EXPECT_NE(error_of("FLASER is a word of this text\n").find("no line of a known format"),
              std::string::npos);
    EXPECT_NE(error_of(std::string("\x7f"
                                   "ELF\0\0\0",
                                   7))
                  .find("binary data"),
              std::string::npos);
    EXPECT_NE(error_of("\x1f\x8b nonsense").find("is empty"), std::string::npos);
    try {
        read_file(folder_.path());
        FAIL() << "a directory was opened";
    } catch (const std::runtime_error &error) {
        EXPECT_NE(std::string(error.what()).find("is a directory"), std::string::npos) << error.what();
    }
}

TEST_F(LogFile, MessagesNameTheFileAndAreOneLine)
{
    const std::string name = write("bad.log", "nothing\n");
    try {
        read_file(name);
        FAIL() << "opened";
    } catch (const std::runtime_error &error) {
        EXPECT_EQ(std::string(error.what()).find(name), 0U);
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    }
}

TEST_F(LogFile, AnyCutOfALogIsReadWithoutHarm)
{
    const std::string text =
        "# beam_time_us 97.656 stamp_beam 340\n" + scan_line + "ODOM 1 2 3 4 5 6 7 h 1\n" + scan_line;
    for (size_t length = 0; length <= text.size(); length++) {
        const std::string part = text.substr(0, length);
        if (error_of(part).empty()) {
            EXPECT_LE(read_bytes(part).scans().size(), 2U);
        }
    }
}

} // namespace
