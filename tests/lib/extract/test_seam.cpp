// A whole turn: wherever the scanner begins, whichever way it turns, the same lines; points of their own
// bearings; a robot that turns while it scans.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "lib/extract/scene.h"

extern "C" {
#include "base/trig.h"
#include "base/turn.h"
#include "extract/workspace.h"
}

namespace
{

using scene::pi;
using scene::wall;

// A room with what stands in it: round number 0 is empty, so that nothing hides anything and the seam has no
// place of its own.
std::vector<wall> room(unsigned round)
{
    std::mt19937 random(round);
    std::uniform_real_distribution<double> part(0, 1);
    std::vector<wall> walls =
        scene::box(-2 - part(random), -1.2 - part(random), 1.5 + part(random), 1 + part(random));
    for (unsigned k = 0; k < round % 4; k++) {
        const double at = 2 * pi * part(random);
        const double x = (0.7 + part(random)) * std::cos(at);
        const double y = (0.7 + part(random)) * std::sin(at);
        const auto box = scene::box(x, y, x + 0.1 + 0.4 * part(random), y + 0.05 + 0.4 * part(random));
        walls.insert(walls.end(), box.begin(), box.end());
    }
    return walls;
}

// A whole turn from beam `seam` of the same turn on, clockwise or not.
scene::scan_ptr turned(const ale_scan_t &scan, int seam, bool clockwise)
{
    const int beams = scan.beams;
    auto out = scene::empty_scan(beams);
    out->step_bam = clockwise ? -scan.step_bam : scan.step_bam;
    out->first_bearing_bam = ale_scan_bearing(&scan, seam);
    for (int k = 0; k < beams; k++) {
        const int from = (seam + (clockwise ? beams - k : k)) % beams;
        out->range_um[k] = scan.range_um[from];
        out->flag[k] = scan.flag[from];
    }
    return out;
}

double apart(uint32_t a, uint32_t b)
{
    return std::fabs(ale_bam_diff(a, b)) * pi / 0x1p31;
}

struct Found {
    std::vector<ale_line_t> lines;
    std::vector<ale_corner_t> corners;
};

Found extract(const ale_scan_t &scan, const uint32_t *bearing_bam = nullptr,
              const ale_noise_t *noise = nullptr)
{
    static ale_extractor_t *e = static_cast<ale_extractor_t *>(std::malloc(ale_extractor_size()));
    static ale_features_t out;
    ale_extract_config_t config = ale_extract_default_config();
    config.noise = noise ? *noise : config.noise;
    EXPECT_EQ(ale_extractor_init(e, &config), 0);
    ale_extract_scan(e, &scan, bearing_bam, &out);
    const ale_points_t &points = e->runs.scan.points;
    for (int i = 0; i + 1 < points.count; i++) {
        EXPECT_LT(points.beam[i], points.beam[i + 1]); // the proofs rest on it
    }
    for (int k = 0; k + 1 < out.line_count; k++) {
        EXPECT_LT(out.line[k].first, out.line[k + 1].first);
        EXPECT_LE(out.line[k].first, out.line[k].last) << "only the last line goes over the seam";
    }
    return {{out.line, out.line + out.line_count}, {out.corner, out.corner + out.corner_count}};
}

// The lines of a turn that begins at `seam` are those of the turn that begins at 0.
void expect_same(const Found &a, const Found &b, int beams, int seam, bool clockwise)
{
    ASSERT_EQ(a.lines.size(), b.lines.size());
    ASSERT_EQ(a.corners.size(), b.corners.size());
    for (const ale_line_t &line : b.lines) {
        const int first = (clockwise ? seam - line.last + 2 * beams : seam + line.first) % beams;
        const int last = (clockwise ? seam - line.first + 2 * beams : seam + line.last) % beams;
        const auto same = std::find_if(a.lines.begin(), a.lines.end(), [&](const ale_line_t &other) {
            return other.first == first && other.last == last;
        });
        ASSERT_NE(same, a.lines.end()) << "beams " << first << " to " << last;
        EXPECT_LT(apart(same->alpha_bam, line.alpha_bam), 5e-5);
        const double tolerance_um = 0.1 * std::sqrt(static_cast<double>(line.var_rho_um2)) + 10;
        EXPECT_NEAR(same->rho_um, line.rho_um, tolerance_um);
        EXPECT_EQ(clockwise ? same->last_end : same->first_end, line.first_end);
        EXPECT_NEAR(static_cast<double>(clockwise ? same->start.x_um : same->end.x_um), line.end.x_um,
                    2 * tolerance_um + 100);
    }
}

class Seam : public testing::TestWithParam<int>
{
};

TEST_P(Seam, ATurnThatBeginsElsewhereGivesTheSameFeatures)
{
    const int beams = GetParam();
    for (unsigned round = 0; round < 24; round++) {
        auto scan = scene::empty_scan(beams, 0, 2 * pi / beams);
        scene::see(*scan, room(round), 4, round);
        const Found whole = extract(*scan);
        ASSERT_GE(whole.lines.size(), 2u) << round;
        for (int seam = 7; seam < beams; seam += beams / 9) {
            SCOPED_TRACE("round " + std::to_string(round) + " seam " + std::to_string(seam));
            expect_same(whole, extract(*turned(*scan, seam, false)), beams, seam, false);
            expect_same(whole, extract(*turned(*scan, seam, true)), beams, seam, true);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Beams, Seam, testing::Values(90, 360, 450, 512, 1024));

TEST(SeamOfATurn, AWallAcrossItIsOneLineWithBothItsCorners)
{
    auto scan = scene::empty_scan(450, -pi, 2 * pi / 450);
    scene::see(*scan, scene::box(-1.5, -1.95, 2, 1.15), 5, 3);
    const Found found = extract(*scan);
    ASSERT_EQ(found.lines.size(), 4u);
    EXPECT_EQ(found.corners.size(), 4u);
    const ale_line_t &wall = found.lines[3];
    EXPECT_GT(wall.first, wall.last);
    EXPECT_NEAR(std::hypot(wall.end.x_um - wall.start.x_um, wall.end.y_um - wall.start.y_um), 3.1e6, 1e5);
    EXPECT_EQ(wall.points, 450 - wall.first + wall.last + 1);
}

TEST(SeamOfATurn, AScanOfTwoEndsHasNone)
{
    for (const int missing : {9, 30}) {
        auto scan = scene::empty_scan(450 - missing, -pi, 2 * pi / 450);
        scene::see(*scan, scene::box(-1.5, -1.95, 2, 1.15), 5, 3);
        const Found found = extract(*scan);
        EXPECT_EQ(found.lines.size(), 5u);
    }
    auto scan = scene::empty_scan(446, -pi, 2 * pi / 450); // four beams are missing: the wall goes on
    scene::see(*scan, scene::box(-1.5, -1.95, 2, 1.15), 5, 3);
    EXPECT_EQ(extract(*scan).lines.size(), 4u);
}

// Bearings that stray by a third of a step: on a grid the walls would be as rough as 20 mm.
TEST(SeamOfATurn, PointsAtTheirOwnBearingsMakeTheLinesOfAGrid)
{
    std::mt19937 random(7);
    std::uniform_real_distribution<double> stray(-0.33, 0.33);
    std::normal_distribution<double> gauss(0, 4000);
    int missed = 0;
    int all = 0;
    for (unsigned round = 0; round < 24; round++) {
        for (const int count : {400, 505, 1440, 3200}) {
            auto turn = std::make_unique<ale_turn_t>();
            ale_turn_begin(turn.get());
            auto grid = scene::empty_scan(std::min(count, 1080), 0, 2 * pi / std::min(count, 1080));
            scene::see(*grid, room(round), 4, round);
            const auto walls = room(round);
            for (int k = 0; k < count; k++) {
                const double bearing = -2 * pi * (k + stray(random)) / count;
                const double range = scene::cast(walls, bearing) * 1e6 + gauss(random);
                ale_turn_add(turn.get(), static_cast<uint32_t>(static_cast<int64_t>(bearing / pi * 0x1p31)),
                             static_cast<int32_t>(range), ALE_BEAM_VALID);
            }
            auto scan = scene::empty_scan();
            ASSERT_EQ(ale_turn_to_scan(turn.get(), scan.get()), ALE_TURN_FINE);
            const Found found = extract(*scan);
            const Found even = extract(*grid);
            SCOPED_TRACE(std::to_string(round) + " of " + std::to_string(count));
            for (const ale_line_t &line : even.lines) {
                const double length =
                    std::hypot(line.end.x_um - line.start.x_um, line.end.y_um - line.start.y_um);
                const bool is_there =
                    std::any_of(found.lines.begin(), found.lines.end(), [&](const ale_line_t &l) {
                        return apart(l.alpha_bam, line.alpha_bam) < 0.03 &&
                               std::abs(l.rho_um - line.rho_um) < 12000 &&
                               std::hypot(l.end.x_um - l.start.x_um, l.end.y_um - l.start.y_um) >
                                   0.8 * length;
                    });
                missed += length > 4e5 && !is_there;
                all += length > 4e5;
            }
            EXPECT_LE(found.lines.size(), even.lines.size() + 1);
        }
    }
    EXPECT_LE(missed * 100, all) << missed << " of " << all;
}

} // namespace
