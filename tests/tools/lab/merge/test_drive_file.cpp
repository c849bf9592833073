#include <cmath>
#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "files.hpp"
#include "lab/merge/drive_file.h"
#include "lab/merge/number_file.h"
#include "lab/merge/whole_text.h"

namespace
{

using namespace merge;

ale::RecordedScan recorded_scan()
{
    ale::RecordedScan scan{1, 0, {1, 2, 3}, {4, 5, 6}, {{}}, {{}}, std::make_unique<ale_seen_copy_t>()};
    scan.lines[0].var_angle_urad2 = -7;
    scan.lines[0].kind = ALE_OBSERVATION_POINT;
    scan.corners[0].cov_um2[2] = INT64_C(1) << 40;
    scan.beams->scan.beams = 2;
    scan.beams->scan.range_um[1] = 123456;
    scan.beams->bearing_bam[1] = 0xfedcba98;
    scan.beams->straightened = true;
    return scan;
}

Drive drive_of(uint32_t checksum, double x_m)
{
    Drive drive{};
    drive.name = "monday.log";
    drive.date_s = 1700000000;
    drive.checksum = checksum;
    drive.scans = {{-5, {x_m, 0.1, -0.0}, 0, false, {{{1, 2}, {0.6, 0.8}}}}, {6, {x_m, 0, 0}, 1, true, {}}};
    ale::Node node{};
    node.scan = 1;
    node.map_id = 1;
    node.points = {{{x_m, 1}, {0, 1}}, {{x_m, 2}, {1, 0}}};
    node.coarse_normal = {false, true};
    node.later_walls = {{0.25, 3}};
    drive.nodes = {node};
    std::vector<ale::RecordedScan> scans;
    scans.push_back(recorded_scan());
    drive.record = ale::ObservationRecord(9, {7, 8, 9}, std::move(scans));
    return drive;
}

DriveGroup two_drives()
{
    DriveGroup group;
    group.drives.push_back(drive_of(1, std::nextafter(0.1, 1)));
    group.drives.push_back(drive_of(2, -4));
    ale::Loop loop{0, 1, {1, 2, 3}, Eigen::Matrix3d::Identity(), 0.5};
    loop.information(0, 2) = 4;
    group.joins = {{{1, 0, {0.5, 0.25, -1}}, {loop}}};
    return group;
}

class DriveFile : public testing::Test
{
  protected:
    /* What is written of it comes back, or does not. */
    void expect_refused(const DriveGroup &group) const
    {
        write_drive_file(path_, group);
        EXPECT_THROW(read_drive_file(path_), std::runtime_error);
    }

    const files::TemporaryFolder folder_;
    const std::string path_ = folder_ / "two.drives";
};

TEST_F(DriveFile, DrivesComeBackToTheBit)
{
    write_drive_file(path_, two_drives());
    ASSERT_TRUE(is_drive_file(path_));
    const DriveGroup back = read_drive_file(path_);
    ASSERT_EQ(back.drives.size(), 2U);
    const Drive &drive = back.drives[0];
    EXPECT_EQ(drive.name, "monday.log");
    EXPECT_EQ(drive.scans[0].stamp_us, -5);
    EXPECT_EQ(drive.scans[0].pose.x, std::nextafter(0.1, 1));
    EXPECT_TRUE(std::signbit(drive.scans[0].pose.theta));
    EXPECT_EQ(drive.scans[0].points[0].normal.y(), 0.8);
    EXPECT_EQ(drive.nodes[0].coarse_normal, std::vector<bool>({false, true}));
    EXPECT_EQ(drive.nodes[0].later_walls[0].length_m, 3);
    const ale::RecordedScan &scan = drive.record.scans()[0];
    EXPECT_EQ(drive.record.epoch(), 9U);
    EXPECT_EQ(drive.record.sensor(scan).theta_bam, 9U);
    EXPECT_EQ(scan.tracked.y_um, 5);
    EXPECT_EQ(scan.lines[0].var_angle_urad2, -7);
    EXPECT_EQ(scan.corners[0].cov_um2[2], INT64_C(1) << 40);
    EXPECT_EQ(scan.beams->scan.range_um[1], 123456);
    EXPECT_EQ(scan.beams->bearing_bam[1], 0xfedcba98);
    EXPECT_TRUE(scan.beams->straightened);
    EXPECT_EQ(back.joins[0].join.shift.theta, -1);
    EXPECT_EQ(back.joins[0].loops[0].information(0, 2), 4);
    const std::string bytes = files::content(path_);
    write_drive_file(path_, back);
    EXPECT_EQ(files::content(path_), bytes);
}

TEST_F(DriveFile, AFileIsReadWholeOrRefused)
{
    write_drive_file(path_, two_drives());
    const std::string whole = files::content(path_);
    for (size_t at = 0; at < whole.size(); at++) {
        std::ofstream(path_) << whole.substr(0, at);
        EXPECT_THROW(read_drive_file(path_), std::runtime_error) << at;
        std::string damaged = whole;
        damaged[at] ^= 1;
        std::ofstream(path_) << damaged;
        EXPECT_THROW(read_drive_file(path_), std::runtime_error) << at;
    }
}

/* Whatever the bytes say, with a checksum that is right. */
TEST_F(DriveFile, NoDamageLeadsBeyondWhatIsThere)
{
    write_drive_file(path_, two_drives());
    const std::string whole = files::content(path_);
    const size_t head = whole.find('\n') + 1;
    for (size_t at = head; at < whole.size() - 4; at++) {
        std::string damaged = whole.substr(0, whole.size() - 4);
        damaged[at] = '\xff';
        NumberWriter end;
        end.numbers(checksum_of(damaged));
        std::ofstream(path_) << damaged << end.bytes();
        try {
            read_drive_file(path_);
        } catch (const std::runtime_error &) {
        }
    }
}

TEST_F(DriveFile, WhatRefersToNothingIsRefused)
{
    const auto spoilt = [](const auto &spoil) {
        DriveGroup group = two_drives();
        spoil(group);
        return group;
    };
    expect_refused({});
    expect_refused(spoilt([](DriveGroup &group) { group.drives[1].nodes[0].scan = 2; }));
    expect_refused(spoilt([](DriveGroup &group) { group.drives[1].nodes[0].map_id = 0; }));
    expect_refused(spoilt([](DriveGroup &group) { group.drives[0].nodes.clear(); }));
    expect_refused(spoilt([](DriveGroup &group) { group.drives[0].nodes[0].coarse_normal.pop_back(); }));
    expect_refused(spoilt([](DriveGroup &group) { group.drives[0].scans[0].frame = UINT32_MAX; }));
    expect_refused(spoilt([](DriveGroup &group) { group.drives[0].scans[0].pose.x = NAN; }));
    expect_refused(spoilt([](DriveGroup &group) { group.joins[0].join.map_id = 2; }));
    expect_refused(spoilt([](DriveGroup &group) { group.joins[0].loops[0].to = 2; }));
    expect_refused(spoilt([](DriveGroup &group) { group.joins[0].loops[0].from = -1; }));
}

TEST_F(DriveFile, ALogIsNone)
{
    std::ofstream(path_) << "FLASER 3 1 1 1\n";
    EXPECT_FALSE(is_drive_file(path_));
    EXPECT_FALSE(is_drive_file(folder_ / "absent"));
}

} // namespace
