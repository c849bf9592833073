/* The recordings that the formats were made for, as far as they are at hand ($ALE_SHARED). */
#include <cstdlib>

#include <gtest/gtest.h>

#include "log_text.hpp"

using ale_test::read_file;

namespace
{

struct Expected {
    const char *file;
    const char *format;
    size_t scans;
    uint64_t bad_lines;
    int beams;
    int64_t first_us;
    int64_t last_us;
    bool odometry;
};

class RecordedData : public testing::TestWithParam<Expected>
{
};

TEST_P(RecordedData, IsReadWhole)
{
    const char *shared = std::getenv("ALE_SHARED");
    if (!shared || !*shared) {
        GTEST_SKIP() << "no recordings at hand";
    }
    const Expected &expected = GetParam();
    const auto log = read_file(std::string(shared) + "/data/" + expected.file);
    const auto scans = log.scans();
    EXPECT_STREQ(log.info.format, expected.format);
    EXPECT_EQ(log.statistics.bad_lines, expected.bad_lines);
    EXPECT_EQ(log.info.has_odometry, expected.odometry);
    ASSERT_EQ(scans.size(), expected.scans);
    EXPECT_EQ(scans.front().beams, expected.beams);
    EXPECT_EQ(scans.front().stamp_us, expected.first_us);
    EXPECT_EQ(scans.back().stamp_us, expected.last_us);
}

INSTANTIATE_TEST_SUITE_P(
    Shared, RecordedData,
    testing::Values(
        Expected{"urg04lx/exp1.dat", "rover", 756, 0, 682, 212387282, 287007421, true},
        Expected{"urg04lx/exp3.dat", "rover", 525, 0, 682, 589923412, 641640773, true},
        Expected{"urg04lx/test_lab.dat", "rover", 590, 1, 682, 225820438, 283912227, true},
        Expected{"urg04lx/obstacle_demo_front.scan.gz", ".scan lines", 331, 0, 726, 1483992048552206,
                 1483992081465175, false},
        Expected{"intel/intel_every5th.clf.gz", "CARMEN", 2726, 0, 180, 976052857337530, 976055546947284,
                 true},
        Expected{"corrected/orebro-corrected.log.gz", "CARMEN", 237, 0, 181, 0, 23600000, true},
        Expected{"killian/infinite-corridor-corrected.log.gz", "CARMEN", 1941, 0, 180, 0, 194000000, true},
        Expected{"killian/killian.g2o.gz", "CARMEN", 3873, 0, 180, 1031745824658000, 1031753497348000, true},
        Expected{"other/loop5.log.gz", "Odometry/Laser pairs", 551, 0, 181, 0, 55000000, true},
        Expected{"other/malaga-one-loop.clf.gz", "CARMEN", 225, 0, 361, 1137834225713000, 1137834284788000,
                 true}));

} // namespace
