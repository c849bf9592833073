// Rooms seen by a scanner of a whole turn: the suite itself, and that the lines found in it do not depend on
// where the scanner begins nor on the way it turns.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <map>
#include <memory>
#include <set>

#include "lab/bench/lines/score.hpp"
#include "lab/bench/suite.hpp"

extern "C" {
#include "base/trig.h"
#include "extract/extract.h"
}

namespace
{

using namespace bench;

constexpr int beams = 512;

std::unique_ptr<ale_features_t> extract(const ale_scan_t &scan)
{
    static auto *extractor = static_cast<ale_extractor_t *>(std::calloc(1, ale_extractor_size()));
    const ale_extract_config_t config = ale_extract_default_config();
    EXPECT_EQ(ale_extractor_init(extractor, &config), 0);
    auto features = std::make_unique<ale_features_t>();
    ale_extract_scan(extractor, &scan, nullptr, features.get());
    return features;
}

TEST(TurnSuite, ATurnBeginsWhereASurfaceEndsAndLosesNone)
{
    for_each_case(
        noise_kind("3mm"), 2, 5,
        [](const Case &c) {
            const SimulatedScan &s = c.simulated;
            ASSERT_EQ(s.scan->beams, beams);
            EXPECT_EQ(ale_scan_turn_beams(s.scan.get()), beams);
            std::set<int> surfaces;
            for (const Hit &hit : s.hits) {
                surfaces.insert(hit.range < urg_reach ? hit.surface : -1);
            }
            if (surfaces.size() > 1) {
                const auto seen = [&](const Hit &hit) { return hit.range < urg_reach ? hit.surface : -1; };
                EXPECT_NE(seen(s.hits.front()), seen(s.hits.back())) << c.number;
            }
        },
        beams);
}

TEST(TurnSuite, ATurnThatBeginsElsewhereHasTheSameRangesInTheSameDirections)
{
    for_each_case(
        noise_kind("real"), 1, 6,
        [](const Case &c) {
            const ale_scan_t &scan = *c.simulated.scan;
            std::map<int32_t, int32_t> range;
            for (int k = 0; k < beams; k++) {
                range[ale_bam_diff(ale_scan_bearing(&scan, k), 0)] = scan.range_um[k];
            }
            for (const bool clockwise : {false, true}) {
                const auto other = turned(scan, 100, clockwise);
                for (int k = 0; k < beams; k++) {
                    ASSERT_EQ(range.at(ale_bam_diff(ale_scan_bearing(other.get(), k), 0)),
                              other->range_um[k]);
                }
            }
        },
        beams);
}

// Beams of the lines, by the numbers of the turn that begins at 0.
std::set<std::pair<int, int>> lines_of(const ale_features_t &features, int seam, bool clockwise)
{
    std::set<std::pair<int, int>> lines;
    for (int k = 0; k < features.line_count; k++) {
        const ale_line_t &line = features.line[k];
        const int first = clockwise ? seam - line.last : seam + line.first;
        const int last = clockwise ? seam - line.first : seam + line.last;
        lines.insert({(first + 2 * beams) % beams, (last + 2 * beams) % beams});
    }
    return lines;
}

class AnyTurn : public testing::TestWithParam<const char *>
{
};

TEST_P(AnyTurn, MirroredAndTurnedByAnyAngleItHasTheSameLines)
{
    int turns = 0;
    for_each_case(
        noise_kind(GetParam()), 3, 8,
        [&](const Case &c) {
            const auto whole = lines_of(*extract(*c.simulated.scan), 0, false);
            for (int seam = 5; seam < beams; seam += beams / 7) {
                for (const bool clockwise : {false, true}) {
                    const auto found =
                        lines_of(*extract(*turned(*c.simulated.scan, seam, clockwise)), seam, clockwise);
                    EXPECT_EQ(found, whole)
                        << c.truth.kind << " " << c.number << " seam " << seam << " " << clockwise;
                    turns++;
                }
            }
        },
        beams);
    EXPECT_GE(turns, 400);
}

INSTANTIATE_TEST_SUITE_P(Noises, AnyTurn, testing::Values("urg", "dirty", "10mm", "real"));

} // namespace
