// Where a recorded robot stands, and the views of a scan.
#include <gtest/gtest.h>

#include <fstream>

#include "files.hpp"
#include "lab/bench/lines/standstill.hpp"

namespace
{

using namespace bench;

constexpr int beams = 181;

// A scan of ranges that grow by the beam, taken at a place along x.
void write_scan(std::ofstream &log, double x, double time_s = 1)
{
    log << "FLASER " << beams;
    for (int k = 0; k < beams; k++) {
        log << " " << 1 + 0.01 * k;
    }
    log << " " << x << " 0 0 " << x << " 0 0 " << time_s << " robot " << time_s << "\n";
}

TEST(Standstill, LastsWhileTheWheelsStand)
{
    const files::TemporaryFolder folder;
    const std::string path = folder / "drive.log";
    {
        std::ofstream log(path);
        for (const double x : {0.0, 0.0, 0.0, 0.1, 0.2, 0.3, 0.3, 0.3, 0.3, 0.4}) {
            write_scan(log, x);
        }
    }
    const std::vector<Standstill> found = standstills(path, 3);
    ASSERT_EQ(found.size(), 2u);
    EXPECT_EQ(found[0].first_scan, 0);
    EXPECT_EQ(found[0].scans.size(), 3u);
    EXPECT_EQ(found[1].first_scan, 6); // the one before was taken on the way
    EXPECT_EQ(found[1].scans.size(), 3u);
    EXPECT_TRUE(standstills(path, 4).empty());
}

TEST(Standstill, EndsWhereWheelsTurnAndStandAgainBetweenTwoScans)
{
    const files::TemporaryFolder folder;
    const std::string path = folder / "drive.log";
    {
        std::ofstream log(path);
        double time_s = 0;
        for (const double goes_to : {0.0, 0.0, 0.1, 0.0}) {
            for (const double x : {goes_to, 0.0, 0.0}) {
                time_s += 0.1;
                log << "ODOM " << x << " 0 0 0 0 0 " << time_s << " robot " << time_s << "\n";
            }
            time_s += 0.1;
            write_scan(log, 0, time_s);
        }
    }
    const std::vector<Standstill> found = standstills(path, 2);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].first_scan, 0);
    EXPECT_EQ(found[0].scans.size(), 2u); // before the third the robot moved, and only one is left after it
}

TEST(Standstill, WithoutOdometryIsTheWholeRecording)
{
    const files::TemporaryFolder folder;
    const std::string path = folder / "rest.log";
    {
        std::ofstream log(path);
        for (int k = 0; k < 5; k++) {
            log << "ROBOTLASER1 2 -1.5708 3.1416 0.0175 4 0.01 0 " << beams;
            for (int i = 0; i < beams; i++) {
                log << " 2";
            }
            log << " 0 0 0 0 0 0 0 0 0 0 0 0 " << k << " robot " << k << "\n";
        }
    }
    const std::vector<Standstill> found = standstills(path, 5);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].scans.size(), 5u);
}

TEST(Views, AMirroredScanHasEachRangeAtTheOtherSide)
{
    ale_scan_t scan{};
    scan.beams = 5;
    scan.step_bam = 1000;
    scan.first_bearing_bam = static_cast<std::uint32_t>(-1500);
    for (int k = 0; k < 5; k++) {
        scan.range_um[k] = 1000000 + k;
    }
    const auto image = mirrored(scan);
    for (int k = 0; k < 5; k++) {
        EXPECT_EQ(image->range_um[k], scan.range_um[4 - k]);
        EXPECT_EQ(ale_scan_bearing(image.get(), k), 0u - ale_scan_bearing(&scan, 4 - k));
    }
}

TEST(Views, AThinnedScanHasItsBeamsWhereTheyWere)
{
    ale_scan_t scan{};
    scan.beams = 5;
    scan.step_bam = 1000;
    scan.first_bearing_bam = 7;
    for (int k = 0; k < 5; k++) {
        scan.range_um[k] = 1000000 + k;
    }
    const auto few = thinned(scan, 2);
    ASSERT_EQ(few->beams, 3);
    for (int k = 0; k < 3; k++) {
        EXPECT_EQ(few->range_um[k], scan.range_um[2 * k]);
        EXPECT_EQ(ale_scan_bearing(few.get(), k), ale_scan_bearing(&scan, 2 * k));
    }
}

} // namespace
