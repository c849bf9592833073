#include <cerrno>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include "files.hpp"

extern "C" {
#include "file/whole_file.h"
}

namespace
{

namespace fs = std::filesystem;

TEST(WholeFile, ThePathHoldsTheOldContentUntilTheNewOneIsWhole)
{
    const files::TemporaryFolder folder;
    const std::string path = folder / "map";
    std::ofstream(path) << "old";
    ale_whole_file_t file;
    ASSERT_EQ(ale_whole_file_begin(&file, path.c_str(), 0640), 0);
    std::fputs("new", file.out);
    std::fflush(file.out);
    EXPECT_EQ(files::content(path), "old");
    EXPECT_EQ(ale_whole_file_commit(&file), 0);
    EXPECT_EQ(files::content(path), "new");
    EXPECT_FALSE(fs::exists(path + ".new"));
}

TEST(WholeFile, AFolderThatIsNotThereIsToldByErrno)
{
    ale_whole_file_t file;
    EXPECT_EQ(ale_whole_file_begin(&file, "/no/such/folder/map", 0640), -1);
    EXPECT_EQ(errno, ENOENT);
}

TEST(WholeFile, AFailedRenameLeavesNothingBehind)
{
    const files::TemporaryFolder folder;
    const std::string path = folder / "map";
    ale_whole_file_t file;
    ASSERT_EQ(ale_whole_file_begin(&file, path.c_str(), 0640), 0);
    fs::create_directories(path + "/in_the_way");
    EXPECT_EQ(ale_whole_file_commit(&file), -1);
    EXPECT_EQ(errno, EISDIR);
    EXPECT_FALSE(fs::exists(path + ".new"));
}

/* A disk that takes no more than this. */
class SmallDisk
{
  public:
    explicit SmallDisk(rlim_t bytes)
    {
        std::signal(SIGXFSZ, SIG_IGN);
        getrlimit(RLIMIT_FSIZE, &before_);
        const rlimit small = {bytes, before_.rlim_max};
        setrlimit(RLIMIT_FSIZE, &small);
    }
    ~SmallDisk()
    {
        setrlimit(RLIMIT_FSIZE, &before_);
    }

  private:
    rlimit before_{};
};

TEST(WholeFile, TheReasonOfAFailedWriteIsToldHoweverMuchIsWrittenAtOnce)
{
    const files::TemporaryFolder folder;
    const std::string path = folder / "map";
    std::ofstream(path) << "old";
    const SmallDisk disk(10000);
    for (const size_t at_once : {7U, 4096U, 100000U}) {
        const std::string bytes(at_once, 'x');
        ale_whole_file_t file;
        ASSERT_EQ(ale_whole_file_begin(&file, path.c_str(), 0640), 0);
        for (size_t written = 0; written < 200000; written += at_once) {
            std::fwrite(bytes.data(), 1, bytes.size(), file.out);
        }
        EXPECT_EQ(ale_whole_file_commit(&file), -1);
        EXPECT_EQ(errno, EFBIG) << at_once;
        EXPECT_EQ(files::content(path), "old");
        EXPECT_FALSE(fs::exists(path + ".new"));
    }
}

TEST(WholeFile, IsForItsOwnerAndHisGroup)
{
    const files::TemporaryFolder folder;
    const std::string path = folder / "map";
    ale_whole_file_t file;
    ASSERT_EQ(ale_whole_file_begin(&file, path.c_str(), 0640), 0);
    EXPECT_EQ(ale_whole_file_commit(&file), 0);
    EXPECT_EQ(fs::status(path).permissions() & fs::perms::others_all, fs::perms::none);
}

TEST(WholeFile, WhatIsNoRegularFileIsRefusedAndStaysAsItIs)
{
    const files::TemporaryFolder folder;
    const std::string other = folder / "other";
    const std::string link = folder / "link";
    const std::string pipe = folder / "pipe";
    std::ofstream(other) << "another's";
    fs::create_symlink(other, link);
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    ale_whole_file_t file;
    EXPECT_EQ(ale_whole_file_begin(&file, link.c_str(), 0640), -1);
    EXPECT_STREQ(ale_whole_file_words(errno), "a symbolic link, which is not followed");
    EXPECT_EQ(ale_whole_file_begin(&file, pipe.c_str(), 0640), -1); /* and does not wait for a reader */
    EXPECT_STREQ(ale_whole_file_words(errno), "no regular file");
    EXPECT_TRUE(fs::is_symlink(link));
    EXPECT_TRUE(fs::is_fifo(pipe));
    EXPECT_EQ(files::content(other), "another's");
}

TEST(WholeFile, ALinkThatLiesWhereItIsWrittenIsNotFollowed)
{
    const files::TemporaryFolder folder;
    const std::string path = folder / "map";
    const std::string other = folder / "other";
    std::ofstream(other) << "another's";
    fs::create_symlink(other, path + ".new");
    ale_whole_file_t file;
    ASSERT_EQ(ale_whole_file_begin(&file, path.c_str(), 0640), 0);
    std::fputs("new", file.out);
    EXPECT_EQ(ale_whole_file_commit(&file), 0);
    EXPECT_EQ(files::content(path), "new");
    EXPECT_EQ(files::content(other), "another's");
}

} // namespace
