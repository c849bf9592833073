// lib/extract as a whole against the chain of its twins in double: noise, outliers, segments, ALE, merging,
// curves, lines, corners. Both get the same ranges; the chain shares no number with the integer code on its
// way.
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <set>
#include <utility>

#include "lib/extract/as_reference.h"
#include "lib/extract/scene.h"
#include "lib/extract/simulated_scans.h"
#include "reference/extraction.h"

namespace
{

using Beams = std::set<std::pair<int, int>>;

const unsigned scans = std::getenv("ALE_LONG_TESTS") ? 3000 : 960;

reference::Extraction twin_of(const ale_scan_t &scan)
{
    const ale_extract_config_t config = ale_extract_default_config();
    return reference::extract(scene::points_of(scan),
                              {scene::noise_of(config.noise), config.min_points,
                               config.min_length_um / 1000.0, scene::radians(scan.first_bearing_bam),
                               scene::step_of(scan)});
}

// How much of two sets is common to both.
struct Common {
    size_t equal = 0;
    size_t all = 0;

    void add(const Beams &a, const Beams &b)
    {
        size_t here = 0;
        for (const auto &line : a) {
            here += b.count(line);
        }
        equal += here;
        all += std::max(a.size(), b.size());
    }
    double share(const char *of_what) const
    {
        const double part = static_cast<double>(equal) / static_cast<double>(all);
        std::printf("%.2f %% of %zu %s in %u scans\n", 100 * part, all, of_what, scans);
        return part;
    }
};

TEST(Twins, NearlyAllLinesCurvesAndCornersHaveTheSameBeamsInIntegersAndInDouble)
{
    scene::extractor extract;
    Common lines;
    Common curves;
    Common corners;
    for (unsigned k = 0; k < scans; k++) {
        const auto scan = scene::simulated_scan(k, 1);
        const ale_features_t &f = extract(*scan);
        const reference::Extraction twin = twin_of(*scan);
        Beams here[3];
        Beams there[3];
        for (int i = 0; i < f.line_count; i++) {
            here[0].insert({f.line[i].first, f.line[i].last});
        }
        for (int i = 0; i < f.curve_count; i++) {
            here[1].insert({f.curve[i].first, f.curve[i].last});
        }
        for (int i = 0; i < f.corner_count; i++) {
            here[2].insert({f.line[f.corner[i].first_line].last, f.line[f.corner[i].second_line].first});
        }
        for (const auto &line : twin.lines) {
            there[0].insert({line.first, line.last});
        }
        for (const auto &curve : twin.curves) {
            there[1].insert({curve.first, curve.last});
        }
        for (const int i : twin.corners) {
            const auto first = static_cast<size_t>(i);
            there[2].insert({twin.lines[first].last, twin.lines[first + 1].first});
        }
        lines.add(here[0], there[0]);
        curves.add(here[1], there[1]);
        corners.add(here[2], there[2]);
    }
    EXPECT_GT(lines.all, 2500U);
    EXPECT_GT(curves.all, 40U);
    EXPECT_GT(corners.all, 800U);
    EXPECT_GE(lines.share("lines"), 0.995) << lines.equal << " of " << lines.all;
    EXPECT_GE(curves.share("curves"), 0.95) << curves.equal << " of " << curves.all;
    EXPECT_GE(corners.share("corners"), 0.99) << corners.equal << " of " << corners.all;
}

// Where both have the same beams: 0.02 deviations, and the rounding of points to 1/16 mm.
TEST(Twins, EqualLinesHaveEqualAngleAndDistance)
{
    scene::extractor extract;
    int compared = 0;
    for (unsigned k = 0; k < scans / 4; k++) {
        const auto scan = scene::simulated_scan(k, 2);
        const ale_features_t &f = extract(*scan);
        for (const auto &twin : twin_of(*scan).lines) {
            for (int i = 0; i < f.line_count; i++) {
                const ale_line_t &line = f.line[i];
                if (line.first != twin.first || line.last != twin.last) {
                    continue;
                }
                const double sigma_alpha = std::sqrt(static_cast<double>(line.var_alpha_nrad2)) * 1e-9;
                const double sigma_rho = std::sqrt(static_cast<double>(line.var_rho_um2)) * 1e-3;
                EXPECT_NEAR(std::remainder(scene::radians(line.alpha_bam) - twin.alpha, 2 * scene::pi), 0,
                            0.02 * sigma_alpha + 1e-7);
                EXPECT_NEAR(line.rho_um / 1000.0, twin.rho, 0.02 * sigma_rho + 0.01);
                compared++;
            }
        }
    }
    EXPECT_GT(compared, 500);
}

TEST(Twins, AnEmptyScanAndScansOfVeryFewBeamsGiveTheSame)
{
    scene::extractor extract;
    for (const int beams : {0, 1, 2, 5, 9, 12}) {
        const auto scan = scene::empty_scan(std::max(beams, 1));
        for (int k = 0; k < beams; k++) {
            ale_scan_set_range(scan.get(), static_cast<uint16_t>(k), 3000000);
        }
        EXPECT_EQ(extract(*scan).line_count, twin_of(*scan).lines.size()) << beams;
    }
}

} // namespace
