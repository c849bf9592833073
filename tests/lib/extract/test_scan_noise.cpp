// lib/extract/scan_noise.c against its twin in double.
#include <algorithm>
#include <random>

#include "lib/extract/agreement.h"
#include "lib/extract/as_reference.h"
#include "lib/extract/stages.h"
#include "reference/scan_noise.h"
#include "reference/stray_points.h"

namespace
{

constexpr unsigned scans = 240;

// Bound: the deviation of a range from 0.5 to 4 m within 2.5 %, where two octaves of the range hardly tell
// the constant part from the proportional one; within 0.2 % and 2 um in 19 of 20 scans.
TEST(ScanNoise, OwnNoiseIsThatOfTheTwin)
{
    scene::extractor extractor;
    ale_extractor_t *e = extractor.get();
    const reference::NoiseOfScan prior = scene::noise_of(ale_extract_default_config().noise);
    unsigned close = 0;
    for (unsigned k = 0; k < scans; k++) {
        const auto scan = scene::simulated_scan(k, 5);
        scene::list_points(e, *scan);
        const reference::NoiseOfScan twin =
            reference::own_noise(scene::points_of(*e), prior, scene::step_of(*scan));
        bool all_close = true;
        for (const double range : {500.0, 1000.0, 2000.0, 4000.0}) {
            const double sigma = std::sqrt(twin.own(range));
            const double error = std::fabs(std::sqrt(scene::noise_of(*e).own(range)) - sigma);
            EXPECT_LE(error, 0.025 * sigma) << "scan " << k << ", " << range << " mm";
            all_close = all_close && error <= 0.002 * sigma + 0.002;
        }
        close += all_close ? 1 : 0;
    }
    EXPECT_GE(close, scans * 19 / 20);
}

// A scanner that triangulates: 1 mm, and 2 mm at one metre that grow with the square of the range.
TEST(ScanNoise, NoiseThatGrowsWithTheSquareOfTheRangeIsMeasured)
{
    ale_extract_config_t config = ale_extract_default_config();
    config.noise.own_ppm_per_m = 1000; // half of what it is
    std::vector<double> square;
    scene::extractor extractor;
    ale_extractor_t *e = extractor.get();
    ASSERT_EQ(ale_extractor_init(e, &config), 0);
    ale_features_t features;
    for (unsigned k = 0; k < 60; k++) {
        std::mt19937 engine(k);
        std::normal_distribution<double> gauss;
        const auto walls = scene::box(-1 - 0.05 * k, -0.8, 2 + 0.1 * k, 1.5);
        const auto scan = scene::empty_scan(450, -scene::pi, 2 * scene::pi / 450);
        for (uint16_t beam = 0; beam < scan->beams; beam++) {
            const double range = scene::cast(walls, scene::bearing_of(*scan, beam));
            const double sigma = std::hypot(0.001, 0.002 * range * range);
            ale_scan_set_range(scan.get(), beam, static_cast<int32_t>(1e6 * (range + sigma * gauss(engine))));
        }
        ale_extract_scan(e, scan.get(), nullptr, &features);
        const ale_noise_t measured = ale_extractor_noise(e);
        EXPECT_EQ(measured.own_ppm, 0);
        square.push_back(measured.own_ppm_per_m);
        EXPECT_GE(features.line_count, k <= 50 ? 4 : 3) << k; // of a wall 7 m off the direction is too vague
        EXPECT_LE(features.line_count, 5) << k;
    }
    std::sort(square.begin(), square.end());
    EXPECT_NEAR(square[30], 2000, 200);
}

// Every other beam, or half of them at random, without an echo. Bound: as above.
TEST(ScanNoise, TheOwnNoiseOfASparseScanIsThatOfTheTwin)
{
    scene::extractor extractor;
    ale_extractor_t *e = extractor.get();
    const reference::NoiseOfScan prior = scene::noise_of(ale_extract_default_config().noise);
    for (unsigned k = 0; k < scans; k++) {
        const auto scan = scene::simulated_scan(k, 6);
        std::mt19937 engine(k);
        for (uint16_t beam = 0; beam < scan->beams; beam++) {
            if (k % 2 == 0 ? beam % 2 == 0 : engine() % 2 == 0) {
                ale_scan_set_range(scan.get(), beam, 0);
            }
        }
        scene::list_points(e, *scan);
        const auto points = scene::points_of(*e);
        const reference::NoiseOfScan twin = reference::own_noise(points, prior, scene::step_of(*scan));
        for (const double range : {500.0, 1000.0, 2000.0, 4000.0}) {
            const double sigma = std::sqrt(twin.own(range));
            EXPECT_NEAR(std::sqrt(scene::noise_of(*e).own(range)), sigma, 0.025 * sigma)
                << "scan " << k << ", " << range << " mm";
        }
        EXPECT_EQ(e->runs.scan.segments.unruly, reference::is_unruly(points, scene::noise_of(*e))) << k;
    }
}

// What a missing echo leaves of the noise: rooms of straight walls with 8 mm on every range give it back.
TEST(ScanNoise, EveryOtherBeamHasTheNoiseOfAllOfThem)
{
    scene::extractor extractor;
    ale_extractor_t *e = extractor.get();
    double sum = 0;
    for (unsigned seed = 0; seed < 100; seed++) {
        std::mt19937 engine(seed);
        std::normal_distribution<double> gauss;
        const auto scan = scene::empty_scan();
        scene::set_ranges(scan.get(), 100, 580, [&](int k) {
            return k % 2 ? 0 : 1000 / std::cos((k - 340) * scene::urg_step) + 8 * gauss(engine);
        });
        scene::list_points(e, *scan);
        sum += std::sqrt(scene::noise_of(*e).own(1500));
    }
    EXPECT_NEAR(sum / 100, 8, 0.5);
}

// Chance makes the variance of few points a quarter of the true one, while those of the others are right. In
// the misfit's own units those few would count most: 1000 rooms of one wall at 1 to 2 m that few beams see,
// others farther, noise of 0.7 % of the range.
TEST(ScanNoise, FewPointsThatAreNearEachOtherByChanceDoNotMakeTheNoiseOfAllOthersSmall)
{
    scene::extractor extractor;
    ale_extractor_t *e = extractor.get();
    int too_small = 0;
    for (unsigned seed = 0; seed < 1000; seed++) {
        std::mt19937 engine(seed);
        std::normal_distribution<double> gauss;
        const auto scan = scene::empty_scan();
        scene::set_ranges(scan.get(), 0, scan->beams,
                          [&](int k) { return (k < 60 ? 1400 : 3400) * (1 + 0.007 * gauss(engine)); });
        scene::list_points(e, *scan);
        too_small += std::sqrt(scene::noise_of(*e).own(3400)) < 0.8 * 0.007 * 3400 ? 1 : 0;
    }
    EXPECT_EQ(too_small, 0);
}

// Clutter of 70 beams beside 500 of a wall, whose ranges have 3 mm of noise.
void expect_the_walls_noise(double clutter_mm, double jumps_mm, double wall_mm)
{
    scene::extractor extractor;
    ale_extractor_t *e = extractor.get();
    for (unsigned seed = 0; seed < 100; seed++) {
        std::mt19937 engine(seed);
        std::normal_distribution<double> gauss;
        const auto scan = scene::empty_scan();
        scene::set_ranges(scan.get(), 0, 570, [&](int k) {
            return k < 70 ? clutter_mm + jumps_mm * gauss(engine) : wall_mm + 3 * gauss(engine);
        });
        scene::list_points(e, *scan);
        EXPECT_LT(std::sqrt(scene::noise_of(*e).own(wall_mm)), 4) << "seed " << seed;
    }
}

TEST(ScanNoise, NearClutterDoesNotMakeTheNoiseOfFarWallsLarge)
{
    expect_the_walls_noise(1500, 40, 3000);
}

TEST(ScanNoise, FarClutterDoesNotMakeTheNoiseOfNearWallsLarge)
{
    expect_the_walls_noise(3000, 80, 1500);
}

} // namespace
