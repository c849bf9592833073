#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "files.hpp"
#include "lab/merge/scan_places.h"
#include "lab/merge/versions.h"
#include "lab/merge/whole_text.h"

namespace
{

using namespace merge;

History two_versions()
{
    return {
        {{1, 1764130000, 0x12345678, 61210, 61210, 0, 0}, {2, 1764130205, 0x9f3c01aa, 61300, 90, 2180, 410}},
        {{0x1c0d77e2, 1700086400, 1, true, true, false, "monday, the long way.log"},
         {0xffffffff, 1700172800, 2, false, false, true, "tuesday.log"}}};
}

class KeptFiles : public testing::Test
{
  protected:
    const files::TemporaryFolder folder_;
    const std::string path_ = folder_ / "versions";
};

TEST_F(KeptFiles, AHistoryComesBackAsItWas)
{
    const History history = two_versions();
    write_history(path_, history);
    const History back = read_history(path_);
    ASSERT_EQ(back.versions.size(), 2U);
    EXPECT_EQ(back.versions[1].map_checksum, 0x9f3c01aaU);
    EXPECT_EQ(back.versions[1].made_s, 1764130205);
    EXPECT_EQ(back.versions[1].moved_mm, 2180);
    ASSERT_NE(back.find(0xffffffff), nullptr);
    EXPECT_TRUE(back.find(0xffffffff)->has_config);
    EXPECT_FALSE(back.find(0xffffffff)->is_kept);
    EXPECT_EQ(back.find(0x1c0d77e2)->name, "monday, the long way.log");
    EXPECT_EQ(back.find(1), nullptr);
    EXPECT_EQ(table_of(back), table_of(history));
}

TEST_F(KeptFiles, NoHistoryIsOneWithoutVersions)
{
    EXPECT_TRUE(read_history(folder_ / "absent").versions.empty());
}

TEST_F(KeptFiles, AHistoryIsReadWholeOrRefused)
{
    write_history(path_, two_versions());
    const std::string whole = files::content(path_);
    for (size_t count = 0; count < whole.size(); count++) {
        std::ofstream(path_) << whole.substr(0, count);
        EXPECT_THROW(read_history(path_), std::runtime_error) << count;
    }
    for (size_t at = 0; at < whole.size(); at++) {
        std::string damaged = whole;
        damaged[at] ^= 1;
        std::ofstream(path_) << damaged;
        EXPECT_THROW(read_history(path_), std::runtime_error) << at;
    }
}

TEST_F(KeptFiles, ALineFeedInANameIsNoLineFeedInTheFile)
{
    History history = two_versions();
    history.drives[0].name = "a\nversion 3";
    write_history(path_, history);
    EXPECT_EQ(read_history(path_).drives[0].name, "a?version 3");
}

TEST_F(KeptFiles, TheOldestVersionsAreForgottenAndOfTheirDrivesThoseThatAreNotKept)
{
    History history = two_versions();
    history.drives[0].is_kept = false;
    history.drives.push_back({3, 0, 1, true, true, false, "kept.log"});
    for (uint32_t number = 3; number <= most_versions + 1; number++) {
        history.versions.push_back({number, 0, 0, 0, 0, 0, 0});
    }
    forget_old_versions(&history);
    EXPECT_EQ(history.versions.size(), most_versions);
    EXPECT_EQ(history.versions.front().number, 2U);
    EXPECT_EQ(history.find(0x1c0d77e2), nullptr);
    EXPECT_NE(history.find(3), nullptr);
}

TEST_F(KeptFiles, WhatIsPackedComesBackWhateverItsLength)
{
    std::string content;
    for (const size_t count : {0U, 1U, 65535U, 65536U, 65537U, 700000U}) {
        while (content.size() < count) {
            content += static_cast<char>((content.size() * 2654435761U) >> 13U);
        }
        write_whole(path_, packed(content));
        EXPECT_EQ(read_whole(path_), content);
    }
    std::filesystem::resize_file(path_, std::filesystem::file_size(path_) - 3);
    EXPECT_THROW(read_whole(path_), std::runtime_error);
}

/* Drives are moved, not copied. */
template <class... Of> std::vector<Drive> list_of(Of... drives)
{
    std::vector<Drive> list;
    (list.push_back(std::move(drives)), ...);
    return list;
}

Drive drive_of(uint32_t checksum, const std::vector<std::pair<ale::Pose, uint32_t>> &poses)
{
    Drive drive{};
    drive.checksum = checksum;
    for (const auto &[pose, frame] : poses) {
        drive.scans.push_back({0, pose, frame, true, {}});
    }
    return drive;
}

TEST(ScanPlacesText, ComeBackWithFramesWithoutGaps)
{
    const auto drives = list_of(drive_of(7, {{{9, 9, 0}, 0}}),
                                drive_of(8, {{{1.5, -2, 0.5}, 0}, {{3, 4, -1}, 5}, {{0, 0, 0}, 3}}));
    const ScanPlaces places = places_from(text_of(places_of(drives, 1)));
    ASSERT_EQ(places.size(), 1U);
    const std::vector<ScanPlace> &scans = places.at(8);
    ASSERT_EQ(scans.size(), 3U);
    EXPECT_EQ(scans[0].pose.x_um, 1500000);
    EXPECT_EQ(scans[0].frame, 0U);
    EXPECT_EQ(scans[1].frame, 1U);
    EXPECT_EQ(scans[2].frame, 2U);
    EXPECT_EQ(scans[1].pose.theta_bam, ale::to_core({3, 4, -1}).theta_bam);
}

TEST(ScanPlacesText, WhatIsNoneIsRefused)
{
    for (const char *text :
         {"", "ALE-SLAM places 2\n", "ALE-SLAM places 1\ndrive 1\n",
          "ALE-SLAM places 1\ndrive 1 2\n0 0 0 0\n", "ALE-SLAM places 1\ndrive 1 1\n0 0 3000000000 0\n",
          "ALE-SLAM places 1\n0 0 0 0\n"}) {
        EXPECT_THROW(places_from(text), std::runtime_error) << text;
    }
}

/* All of the building has been turned and moved; a new drive with it. What is in another frame stays. */
TEST(HoldFrame, PutsAllBackWhereTheBuildingWas)
{
    const auto before = list_of(drive_of(7, {{{0, 0, 0}, 0}, {{4, 1, 1}, 0}, {{8, 8, 8}, 1}}));
    const ale::Pose off{0.3, -0.2, 0.1};
    const auto moved = [&off](const ale::Pose &pose) { return compose(off, pose); };
    auto now = list_of(drive_of(7, {{moved({0, 0, 0}), 0}, {moved({4, 1, 1}), 0}, {{8, 8, 8}, 1}}),
                       drive_of(9, {{moved({2, 2, 2}), 0}}));
    hold_frame(places_of(before, 0), &now);
    EXPECT_NEAR(now[0].scans[1].pose.x, 4, 1e-5);
    EXPECT_NEAR(now[0].scans[1].pose.theta, 1, 1e-5);
    EXPECT_NEAR(now[1].scans[0].pose.y, 2, 1e-5);
    EXPECT_EQ(now[0].scans[2].pose.x, 8);
}

} // namespace
