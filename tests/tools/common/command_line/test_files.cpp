// tools/common/command_line/files: what cannot be written, or must not, is told before the work.
#include <fstream>
#include <stdexcept>

#include <gtest/gtest.h>

#include "common/command_line/files.h"
#include "common/command_line/wrong_use.h"
#include "files.hpp"

namespace
{

class Files : public testing::Test
{
  protected:
    void SetUp() override
    {
        std::ofstream(at("drive.log")) << "scans";
        std::filesystem::create_directory(at("maps"));
        named.reads("LOG", at("drive.log"));
    }
    std::string at(const std::string &name) const
    {
        return (folder.path() / name).string();
    }
    std::string refused(const std::string &path)
    {
        try {
            named.writes("--map", path);
        } catch (const std::exception &error) {
            return error.what();
        }
        return "";
    }

    files::TemporaryFolder folder;
    cli::Files named;
};

TEST_F(Files, ResultsInFoldersThatAreThereMayBeWrittenOrReplaced)
{
    std::ofstream(at("old.svg")) << "<svg/>";
    for (const std::string &path : {at("old.svg"), at("new.svg"), at("maps/new.svg"), std::string("-"),
                                    std::string(), std::string("/dev/null"), std::string("/dev/null")}) {
        EXPECT_EQ(refused(path), "") << path;
    }
    EXPECT_FALSE(std::filesystem::exists(at("new.svg")));
}

TEST_F(Files, WhatCannotBeWrittenIsNamed)
{
    EXPECT_EQ(refused(at("nowhere/map.svg")), at("nowhere/map.svg") + ": No such file or directory");
    EXPECT_EQ(refused(at("maps")), at("maps") + ": Is a directory");
    EXPECT_EQ(refused(at("drive.log/map.svg")), at("drive.log/map.svg") + ": Not a directory");
}

TEST_F(Files, NoResultTakesThePlaceOfItsSourceByWhateverName)
{
    std::filesystem::create_symlink("drive.log", at("link.log"));
    std::filesystem::create_hard_link(at("drive.log"), at("hard.log"));
    for (const std::string &path :
         {at("drive.log"), at("maps/../drive.log"), at("link.log"), at("hard.log")}) {
        EXPECT_THROW(named.writes("--map", path), cli::WrongUse) << path;
    }
    EXPECT_EQ(refused(at("drive.log")), "--map " + at("drive.log") + ": is the file of LOG");
}

TEST_F(Files, TwoResultsGoNotIntoOneFile)
{
    EXPECT_EQ(refused(at("both.tum")), "");
    EXPECT_EQ(refused(at("maps/../both.tum")), "--map " + at("maps/../both.tum") + ": is the file of --map");
}

} // namespace
