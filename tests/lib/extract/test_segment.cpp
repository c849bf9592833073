// lib/extract/outlier.c and segment.c against their twins in double.
#include <random>

#include "lib/extract/agreement.h"
#include "lib/extract/as_reference.h"
#include "lib/extract/stages.h"
#include "reference/stray_points.h"
#include "reference/surface_segments.h"

namespace
{

constexpr unsigned scans = 240;

std::vector<int> beams_of(const reference::ScanPoints &points)
{
    std::vector<int> beams;
    for (const reference::ScanPoint &p : points) {
        beams.push_back(p.beam);
    }
    return beams;
}

TEST(Outlier, SpikesAreThoseOfTheTwin)
{
    scene::extractor extractor;
    ale_extractor_t *e = extractor.get();
    scene::agreement agreement;
    int spikes = 0;
    for (unsigned k = 0; k < scans; k++) {
        const auto scan = scene::simulated_scan(k, 2);
        scene::list_points(e, *scan);
        reference::Decisions decisions;
        const auto before = scene::points_of(*e);
        const auto twin =
            reference::without_spikes(before, scene::noise_of(*e), scene::step_of(*scan), decisions);
        scene::remove_spikes(e);
        agreement.compare(beams_of(scene::points_of(*e)) == beams_of(twin), decisions, k);
        spikes += static_cast<int>(before.size() - twin.size());
    }
    agreement.expect_differences_below(0.01);
    EXPECT_GT(spikes, 100);
}

// A wall at 2 m with 3 mm of noise that steps back by 30 mm after beam 360, where it is seen from the side:
// 1000 times. The last point before the step lies nearer than the line from its second neighbours says.
TEST(Outlier, APointBesideAStepIsKept)
{
    scene::extractor extractor;
    ale_extractor_t *e = extractor.get();
    int removed = 0;
    for (unsigned seed = 0; seed < 1000; seed++) {
        std::mt19937 engine(seed);
        std::normal_distribution<double> gauss;
        const auto scan = scene::empty_scan();
        scene::set_ranges(scan.get(), 240, 440, [&](int k) {
            return (k > 360 ? 2030 : 2000) / std::cos((k - 340) * scene::urg_step) + 3 * gauss(engine);
        });
        scene::list_points(e, *scan);
        scene::remove_spikes(e);
        removed += 200 - e->runs.scan.points.count;
    }
    EXPECT_LT(removed, 170);
}

TEST(Segment, JumpsAreThoseOfTheTwin)
{
    scene::extractor extractor;
    ale_extractor_t *e = extractor.get();
    scene::agreement agreement;
    int jumps = 0;
    for (unsigned k = 0; k < scans; k++) {
        const auto scan = scene::simulated_scan(k, 3);
        scene::list_points(e, *scan);
        scene::remove_spikes(e);
        scene::cut_segments(e);
        const auto points = scene::points_of(*e);
        for (int i = 0; i + 1 < e->runs.scan.points.count; i++) {
            reference::Decisions decisions;
            const bool twin =
                reference::is_jump(points, scene::noise_of(*e), scene::step_of(*scan), i, decisions);
            agreement.compare(e->runs.scan.segments.jump_after[i] == twin, decisions, k);
            jumps += twin ? 1 : 0;
        }
    }
    agreement.expect_differences_below(0.0001);
    EXPECT_GT(jumps, 500);
}

TEST(Segment, PiecesTooSmallForASurfaceAreThoseOfTheTwin)
{
    scene::extractor extractor;
    ale_extractor_t *e = extractor.get();
    int removed = 0;
    for (unsigned k = 0; k < scans; k++) {
        const auto scan = scene::simulated_scan(k, 4);
        scene::list_points(e, *scan);
        scene::cut_segments(e);
        const auto twin = reference::without_strays(scene::points_of(*e), scene::segments_of(*e));
        removed += scene::remove_strays(e) > 0 ? 1 : 0;
        EXPECT_EQ(beams_of(scene::points_of(*e)), beams_of(twin)) << "scan " << k;
    }
    EXPECT_GT(removed, 20);
}

TEST(Segment, TheCutsOfAnEmptyScanAndOfOnePointAreThoseOfTheTwin)
{
    scene::extractor extractor;
    ale_extractor_t *e = extractor.get();
    for (const int points : {0, 1, 2}) {
        const auto scan = scene::empty_scan(4);
        for (int k = 0; k < points; k++) {
            ale_scan_set_range(scan.get(), static_cast<uint16_t>(k), 1000000);
        }
        scene::list_points(e, *scan);
        scene::cut_segments(e);
        reference::Decisions decisions;
        EXPECT_EQ(scene::segments_of(*e),
                  reference::surface_segments(scene::points_of(*e), scene::noise_of(*e),
                                              scene::step_of(*scan), decisions))
            << points;
    }
}

} // namespace
