// What a scan looks like must not depend on how it is read: the mirrored ranges give the mirrored lines, the
// turned scanner the turned ones, and a wider array the same ones. Over the suites of the line benchmark and
// the recording of a resting scanner, as far as they are at hand ($ALE_SHARED), and over the benchmark's own
// worlds.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "drivers/log/log_text.hpp"
#include "lib/extract/scene.h"
#include "lib/extract/simulated_scans.h"

namespace
{

constexpr uint32_t half_turn = 1U << 31;

// Where a feature of the first scan is to be found in the second: beams b as beam_sign * b + first_beam,
// angles a as sign * a + turn.
struct Change {
    int beam_sign;
    int first_beam;
    int sign;
    uint32_t turn;
};

int beam_of(const Change &c, int beam)
{
    return c.beam_sign * beam + c.first_beam;
}

uint32_t angle_of(const Change &c, uint32_t angle)
{
    return (c.sign > 0 ? angle : 0U - angle) + c.turn;
}

double apart(uint32_t a, uint32_t b)
{
    return std::fabs(static_cast<double>(static_cast<int32_t>(a - b))) * scene::pi / half_turn;
}

void expect_point(const Change &c, ale_point_t a, ale_point_t b, double tolerance_um)
{
    const double turn = static_cast<double>(c.turn) * scene::pi / half_turn;
    const double x = a.x_um;
    const double y = c.sign * static_cast<double>(a.y_um);
    EXPECT_NEAR(x * std::cos(turn) - y * std::sin(turn), b.x_um, tolerance_um);
    EXPECT_NEAR(x * std::sin(turn) + y * std::cos(turn), b.y_um, tolerance_um);
}

void expect_line(const Change &c, const ale_line_t &a, const ale_line_t &b)
{
    const bool swapped = c.beam_sign < 0;
    EXPECT_EQ(beam_of(c, swapped ? a.last : a.first), b.first);
    EXPECT_EQ(beam_of(c, swapped ? a.first : a.last), b.last);
    EXPECT_EQ(swapped ? a.last_end : a.first_end, b.first_end);
    EXPECT_EQ(swapped ? a.first_end : a.last_end, b.last_end);
    const double sigma_alpha = std::sqrt(static_cast<double>(a.var_alpha_nrad2)) * 1e-9;
    const double sigma_rho_um = std::sqrt(static_cast<double>(a.var_rho_um2));
    EXPECT_LE(apart(angle_of(c, a.alpha_bam), b.alpha_bam), 0.1 * sigma_alpha);
    EXPECT_NEAR(a.rho_um, b.rho_um, 0.1 * sigma_rho_um);
    expect_point(c, swapped ? a.end : a.start, b.start, 0.1 * sigma_rho_um + 10);
    expect_point(c, swapped ? a.start : a.end, b.end, 0.1 * sigma_rho_um + 10);
}

void expect_corner(const Change &c, const ale_corner_t &a, const ale_corner_t &b)
{
    EXPECT_EQ(a.kind, b.kind);
    const double sigma_um = std::sqrt(static_cast<double>(a.cov_um2[0] + a.cov_um2[2]));
    expect_point(c, a.p, b.p, 0.1 * sigma_um + 10);
    EXPECT_LE(apart(a.angle_bam, b.angle_bam), 1e-4);
}

void expect_changed(const Change &c, const ale_features_t &a, const ale_features_t &b)
{
    ASSERT_EQ(a.line_count, b.line_count);
    ASSERT_EQ(a.corner_count, b.corner_count);
    ASSERT_EQ(a.curve_count, b.curve_count);
    const bool swapped = c.beam_sign < 0;
    for (int k = 0; k < a.line_count; k++) {
        expect_line(c, a.line[k], b.line[swapped ? a.line_count - 1 - k : k]);
    }
    for (int k = 0; k < a.corner_count; k++) {
        expect_corner(c, a.corner[k], b.corner[swapped ? a.corner_count - 1 - k : k]);
    }
    for (int k = 0; k < a.curve_count; k++) {
        const ale_curve_t &there = b.curve[swapped ? a.curve_count - 1 - k : k];
        EXPECT_EQ(beam_of(c, swapped ? a.curve[k].last : a.curve[k].first), there.first);
        EXPECT_EQ(beam_of(c, swapped ? a.curve[k].first : a.curve[k].last), there.last);
    }
    for (int k = 0; k < ALE_REFUSALS; k++) {
        EXPECT_EQ(a.refused[k], b.refused[k]) << k;
    }
}

// The scan of other beams: beam k of it shows what beam source(k) of the first did, none where that is
// outside.
template <typename Source>
std::unique_ptr<ale_scan_t> read_as(const ale_scan_t &scan, int beams, const Source &source)
{
    auto other = std::make_unique<ale_scan_t>(scan);
    other->beams = static_cast<uint16_t>(beams);
    for (int k = 0; k < beams; k++) {
        const int from = source(k);
        const bool inside = from >= 0 && from < scan.beams;
        other->range_um[k] = inside ? scan.range_um[from] : 0;
        other->flag[k] = inside ? scan.flag[from] : static_cast<uint8_t>(ALE_BEAM_NO_RETURN);
    }
    return other;
}

void expect_symmetric(scene::extractor &extract, const ale_scan_t &scan)
{
    const int last = scan.beams - 1;
    const auto step = static_cast<uint32_t>(scan.step_bam);
    const ale_features_t as_it_is = extract(scan);

    const auto mirrored = read_as(scan, scan.beams, [&](int k) { return last - k; });
    mirrored->first_bearing_bam = 0U - (scan.first_bearing_bam + step * static_cast<uint32_t>(last));
    expect_changed({-1, last, -1, 0}, as_it_is, extract(*mirrored));

    const auto reversed = read_as(scan, scan.beams, [](int k) { return k; });
    reversed->first_bearing_bam = 0U - scan.first_bearing_bam;
    reversed->step_bam = -scan.step_bam;
    expect_changed({1, 0, -1, 0}, as_it_is, extract(*reversed));

    for (const int beams : {1, 37, 256}) {
        const auto turned = read_as(scan, scan.beams, [](int k) { return k; });
        turned->first_bearing_bam += step * static_cast<uint32_t>(beams);
        expect_changed({1, 0, 1, step * static_cast<uint32_t>(beams)}, as_it_is, extract(*turned));

        const auto wider = read_as(scan, scan.beams + beams, [&](int k) { return k - beams; });
        expect_changed({1, beams, 1, step * static_cast<uint32_t>(beams)}, as_it_is, extract(*wider));
    }
}

class Suite : public testing::TestWithParam<const char *>
{
};

TEST_P(Suite, AMirroredAndATurnedScanGiveTheMirroredAndTheTurnedLines)
{
    const char *shared = std::getenv("ALE_SHARED");
    if (!shared || !*shared) {
        GTEST_SKIP() << "no recordings at hand";
    }
    const auto log = ale_test::read_file(std::string(shared) + "/" + GetParam());
    scene::extractor extract;
    for (const ale_scan_t &scan : log.scans()) {
        SCOPED_TRACE(testing::Message() << "scan at " << scan.stamp_us << " us");
        expect_symmetric(extract, scan);
        if (HasFailure()) {
            return;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Shared, Suite,
                         testing::Values("bench/lines/dev-urg/scans.log.gz",
                                         "bench/lines/dev-dirty/scans.log.gz",
                                         "bench/lines/dev-3/scans.log.gz", "bench/lines/dev-20/scans.log.gz",
                                         "bench/lines/dev-real/scans.log.gz",
                                         "data/urg04lx/obstacle_demo_front.scan.gz"));

TEST(Symmetry, HoldsInTheWorldsOfTheBenchmark)
{
    scene::extractor extract;
    for (unsigned k = 0; k < 240; k++) {
        SCOPED_TRACE(testing::Message() << "scan " << k);
        expect_symmetric(extract, *scene::simulated_scan(k, 21));
    }
}

// A scanner that sees all around may begin anywhere between two walls.
TEST(Symmetry, AFullTurnMayBeginBetweenAnyTwoWalls)
{
    constexpr int beams = 1024;
    scene::extractor extract;
    const auto scan = scene::empty_scan(beams, 0);
    for (int side = 0; side < 4; side++) {
        for (int k = 20; k < 236; k++) {
            const double across = (k - 128) * scene::urg_step;
            ale_scan_set_range(scan.get(), static_cast<uint16_t>(256 * side + k),
                               static_cast<int32_t>(std::lround(1500000 / std::cos(across))));
        }
    }
    const ale_features_t first = extract(*scan);
    ASSERT_EQ(first.line_count, 4);
    for (int side = 1; side < 4; side++) {
        const auto later = read_as(*scan, beams, [&](int k) { return (k + 256 * side) % beams; });
        const ale_features_t &f = extract(*later);
        ASSERT_EQ(f.line_count, 4);
        for (int k = 0; k < 4; k++) {
            EXPECT_EQ(f.line[k].first, first.line[k].first);
            EXPECT_EQ(f.line[k].last, first.line[k].last);
        }
    }
}

} // namespace
