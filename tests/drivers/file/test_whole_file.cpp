#include <cerrno>
#include <filesystem>

#include <gtest/gtest.h>

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
    ASSERT_EQ(ale_whole_file_begin(&file, path.c_str()), 0);
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
    EXPECT_EQ(ale_whole_file_begin(&file, "/no/such/folder/map"), -1);
    EXPECT_EQ(errno, ENOENT);
}

TEST(WholeFile, AFailedRenameLeavesNothingBehind)
{
    const files::TemporaryFolder folder;
    const std::string path = folder / "map";
    ale_whole_file_t file;
    ASSERT_EQ(ale_whole_file_begin(&file, path.c_str()), 0);
    fs::create_directories(path + "/in_the_way");
    EXPECT_EQ(ale_whole_file_commit(&file), -1);
    EXPECT_EQ(errno, EISDIR);
    EXPECT_FALSE(fs::exists(path + ".new"));
}

TEST(WholeFile, AFullDeviceIsToldByErrno)
{
    ale_whole_file_t file;
    ASSERT_EQ(ale_whole_file_begin(&file, "/dev/full"), 0);
    std::fputs("new", file.out);
    EXPECT_EQ(ale_whole_file_commit(&file), -1);
    EXPECT_EQ(errno, ENOSPC);
}

} // namespace
