// lib/extract/run_noise.c against its twin in double.
#include <random>

#include "lib/extract/agreement.h"
#include "lib/extract/as_reference.h"
#include "lib/extract/stages.h"
#include "reference/scan_noise.h"

namespace
{

constexpr unsigned scans = 240;

// In how many of 1000 scans of three walls, two of them far, an error shared by neighbours is recognised.
int recognised(double shared_mm, double own_mm)
{
    scene::extractor extractor;
    ale_extractor_t *e = extractor.get();
    int count = 0;
    for (unsigned seed = 0; seed < 1000; seed++) {
        std::mt19937 engine(seed);
        std::normal_distribution<double> gauss;
        const double kept = std::exp(-1.0 / 12);
        const auto scan = scene::empty_scan(240, -120 * scene::urg_step);
        double shared = gauss(engine);
        scene::set_ranges(scan.get(), 0, scan->beams, [&](int k) {
            const double wall_mm = (k / 80 == 1 ? 1500 : 3000) / std::cos((k % 80 - 40) * scene::urg_step);
            const double range_mm = wall_mm + shared_mm * shared + own_mm * gauss(engine);
            shared = kept * shared + std::sqrt(1 - kept * kept) * gauss(engine);
            return range_mm;
        });
        scene::prepare_points(e, *scan);
        ale_runs_search(&e->runs);
        count += ale_run_noise_measure_shared(&e->runs, scan->step_bam) ? 1 : 0;
    }
    return count;
}

TEST(RunNoise, AnErrorThatNeighboursShareIsToldFromNoneInAScanOfFewWalls)
{
    EXPECT_LE(recognised(0, 10), 10);
    EXPECT_GE(recognised(5, 3), 955);
}

// Bound: the factor on the own variance within one part in a hundred; on the shared one within six, for a
// value that one of them counts in the next bin moves a quantile of few; but for near misses of a limit.
TEST(RunNoise, SharedNoiseAndTheCorrectionByResidualsAreThoseOfTheTwin)
{
    scene::extractor extractor;
    ale_extractor_t *e = extractor.get();
    scene::agreement agreement;
    int shared = 0;
    for (unsigned k = 0; k < scans; k++) {
        const auto scan = scene::simulated_scan(k, 6);
        scene::prepare_points(e, *scan);
        ale_runs_search(&e->runs);
        const auto points = scene::points_of(*e);
        const reference::NoiseOfScan before = scene::noise_of(*e);
        const auto runs = scene::runs_of(e->runs);
        reference::Decisions decisions;
        const reference::SharedNoise twin =
            reference::shared_noise(points, before, runs, scene::step_of(*scan), decisions);
        ale_run_noise_measure_shared(&e->runs, scan->step_bam);
        const double scale = static_cast<double>(e->runs.scan.noise.shared_scale_q8) / 256;
        const double stated = static_cast<double>(e->runs.scan.noise.shared_stated_q8) / 256;
        agreement.compare(std::fabs(scale - twin.scale) < 0.06 * std::max(twin.scale, 1.0) &&
                              std::fabs(stated - twin.stated) < 0.06 * twin.stated &&
                              e->runs.scan.noise.shared_absent == twin.absent,
                          decisions, k);
        shared += twin.scale > 1 ? 1 : 0;
        reference::Decisions accepted;
        const double own = e->runs.scan.noise.shared_scale_q8 > 256
                               ? 1
                               : reference::own_scale(points, scene::noise_of(*e), runs, accepted);
        ale_run_noise_refine_own(&e->runs);
        agreement.compare(std::fabs(scene::noise_of(*e).own_scale - own) < 0.01 * own, accepted, k);
    }
    agreement.expect_differences_below(0.02);
    EXPECT_GT(shared, 20);
}

} // namespace
