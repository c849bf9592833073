/* Which files of a folder can be asked for, by which names. */
#include "operator/console/recordings/shelf.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <stdexcept>

#include <fcntl.h>
#include <sys/stat.h>

#include "files.hpp"

using console::Shelf;

namespace
{

class ShelfOfRecordings : public testing::Test
{
  protected:
    ShelfOfRecordings()
    {
        std::filesystem::create_directory(folder_);
        files::write(folder_ + "/a.lcm", "a");
    }

    bool opens(const std::string &name) const
    {
        return shelf_.open(name).number() >= 0;
    }

    const files::TemporaryFolder root_;
    const std::string folder_ = (root_ / "shelf").string();
    const std::string outside_ = (root_ / "outside.lcm").string();
    const Shelf shelf_{folder_, ".lcm"};
};

} // namespace

TEST_F(ShelfOfRecordings, OpensWhatLiesInItByAPlainName)
{
    EXPECT_TRUE(opens("a.lcm"));
    EXPECT_FALSE(opens("b.lcm"));
    EXPECT_TRUE(shelf_.may_be_called("2026-11-25_23.lcm"));
}

TEST_F(ShelfOfRecordings, NoNameLeadsElsewhere)
{
    files::write(outside_, "x");
    files::write(folder_ + "/.hidden.lcm", "x");
    files::write(folder_ + "/key.secret", "x");
    std::filesystem::create_directory(folder_ + "/folder.lcm");
    std::filesystem::create_symlink(outside_, folder_ + "/link.lcm");
    ASSERT_EQ(mkfifo((folder_ + "/pipe.lcm").c_str(), 0600), 0);
    for (const char *name : {"", ".lcm", "..", "../outside.lcm", "/etc/passwd", ".hidden.lcm", "key.secret",
                             "link.lcm", "folder.lcm", "pipe.lcm", "a.lcm/", "./a.lcm", "a.lcm\n",
                             "..%2foutside.lcm", "a\\b.lcm", "\xc3\xa4.lcm"}) {
        EXPECT_FALSE(opens(name)) << name;
    }
    EXPECT_FALSE(opens(std::string("a.lcm\0.lcm", 10)));
    EXPECT_FALSE(opens(std::string(200, 'a') + ".lcm"));
    ASSERT_EQ(shelf_.list().size(), 1U);
    EXPECT_EQ(shelf_.list()[0].name, "a.lcm");
}

TEST_F(ShelfOfRecordings, ListsTheNewestFirst)
{
    files::write(folder_ + "/b.lcm", "bb");
    const timespec old[] = {{1000, 0}, {1000, 500000000}};
    utimensat(AT_FDCWD, (folder_ + "/b.lcm").c_str(), old, 0);
    const auto list = shelf_.list();
    ASSERT_EQ(list.size(), 2U);
    EXPECT_EQ(list[0].name, "a.lcm");
    EXPECT_EQ(list[1].changed_ms, 1000500);
    EXPECT_EQ(list[1].bytes, 2U);
}

TEST_F(ShelfOfRecordings, MakesItsFolderAndNeverWritesOverAFile)
{
    std::filesystem::remove_all(folder_);
    EXPECT_TRUE(shelf_.list().empty());
    EXPECT_FALSE(opens("a.lcm"));
    EXPECT_GE(shelf_.make("a.lcm").number(), 0);
    try {
        shelf_.make("a.lcm");
        FAIL() << "it is there already";
    } catch (const std::runtime_error &error) {
        EXPECT_EQ(std::string(error.what()), folder_ + "/a.lcm: File exists");
    }
}

TEST(Shelf, WhatCannotBeReadIsNamed)
{
    const files::TemporaryFolder root;
    const std::string file = (root / "file").string();
    files::write(file, "");
    const Shelf shelf(file, ".lcm");
    for (const auto &act : {std::function<void()>([&] { shelf.list(); }), {[&] { shelf.make("a.lcm"); }}}) {
        try {
            act();
            FAIL();
        } catch (const std::runtime_error &error) {
            EXPECT_EQ(std::string(error.what()), file + ": Not a directory");
        }
    }
    EXPECT_FALSE(Shelf("", ".lcm").is_there());
    EXPECT_LT(Shelf("", ".lcm").open("a.lcm").number(), 0);
}
