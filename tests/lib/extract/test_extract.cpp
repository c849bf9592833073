// lib/extract as its users see it: lines, corners, curves and refusals of whole scans.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <random>
#include <vector>

#include "lib/extract/scene.h"

namespace
{

using scene::box;
using scene::empty_scan;
using scene::see;

constexpr double pi = scene::pi;

double alpha_of(const ale_line_t &line)
{
    return line.alpha_bam * (2 * pi / 4294967296.0);
}

void expect_line(const ale_line_t &line, double alpha, double rho_mm, double bound_deg, double bound_mm)
{
    EXPECT_NEAR(std::remainder(alpha_of(line) - alpha, 2 * pi) * 180 / pi, 0, bound_deg);
    EXPECT_NEAR(line.rho_um / 1000.0, rho_mm, bound_mm);
}

// What must hold of the result of any scan.
void expect_sane(const ale_scan_t &scan, const ale_features_t &f)
{
    EXPECT_LE(f.line_count, ALE_MAX_LINES);
    EXPECT_LE(f.corner_count, ALE_MAX_CORNERS);
    EXPECT_LE(f.curve_count, ALE_MAX_CURVES);
    for (int k = 0; k < f.line_count; k++) {
        const ale_line_t &l = f.line[k];
        EXPECT_LT(l.first, l.last);
        EXPECT_LT(l.last, scan.beams);
        EXPECT_LE(l.points, l.last - l.first + 1);
        EXPECT_GE(l.rho_um, 0);
        EXPECT_GT(l.var_alpha_nrad2, 0);
        EXPECT_GT(l.var_rho_um2, 0);
        EXPECT_LT(std::pow(static_cast<double>(l.cov_alpha_rho), 2),
                  static_cast<double>(l.var_alpha_nrad2) * static_cast<double>(l.var_rho_um2));
        EXPECT_GE(l.var_start_um2, 0);
        EXPECT_GE(l.var_end_um2, 0);
        if (k > 0) {
            EXPECT_GT(l.first, f.line[k - 1].last);
        }
    }
    for (int k = 0; k < f.corner_count; k++) {
        EXPECT_LT(f.corner[k].second_line, f.line_count);
        EXPECT_EQ(f.corner[k].first_line + 1, f.corner[k].second_line);
        EXPECT_LE(f.corner[k].angle_bam, 0x80000000u);
    }
}

TEST(Extract, AScanWithoutBeamsHasNothing)
{
    scene::extractor extract;
    const auto scan = empty_scan(0);
    const ale_features_t &f = extract(*scan);
    EXPECT_EQ(f.line_count + f.corner_count + f.curve_count + f.outliers, 0);
}

TEST(Extract, OneBeamIsNoLine)
{
    scene::extractor extract;
    const auto scan = empty_scan(1);
    ale_scan_set_range(scan.get(), 0, 1000000);
    EXPECT_EQ(extract(*scan).line_count, 0);
}

TEST(Extract, AScanWithoutAnyReturnHasNothing)
{
    scene::extractor extract;
    const auto scan = empty_scan();
    EXPECT_EQ(extract(*scan).line_count, 0);
    for (int k = 0; k < scan->beams; k++) {
        scan->range_um[k] = 1000000;
        scan->flag[k] = ALE_BEAM_UNKNOWN;
    }
    EXPECT_EQ(extract(*scan).line_count, 0);
}

TEST(Extract, OneWallIsOneLineWithItsEnds)
{
    scene::extractor extract;
    const auto scan = empty_scan();
    see(*scan, {{-1, 2, 1.5, 2}}, 3, 1);
    const ale_features_t &f = extract(*scan);
    ASSERT_EQ(f.line_count, 1);
    expect_line(f.line[0], pi / 2, 2000, 0.2, 2);
    EXPECT_NEAR(f.line[0].start.x_um, 1500000, 20000);
    EXPECT_NEAR(f.line[0].end.x_um, -1000000, 20000);
    EXPECT_EQ(f.line[0].first_end, ALE_END_LIMIT);
    EXPECT_EQ(f.corner_count, 0);
}

TEST(Extract, TwoWallsMeetInAConcaveCorner)
{
    scene::extractor extract;
    const auto scan = empty_scan();
    see(*scan, {{2, -1.5, 2, 1}, {2, 1, -0.5, 1}}, 3, 2);
    const ale_features_t &f = extract(*scan);
    ASSERT_EQ(f.line_count, 2);
    expect_line(f.line[0], 0, 2000, 0.3, 3);
    expect_line(f.line[1], pi / 2, 1000, 0.3, 3);
    ASSERT_EQ(f.corner_count, 1);
    EXPECT_NEAR(f.corner[0].p.x_um, 2000000, 4000);
    EXPECT_NEAR(f.corner[0].p.y_um, 1000000, 4000);
    EXPECT_EQ(f.corner[0].kind, ALE_CORNER_CONCAVE);
    EXPECT_NEAR(f.corner[0].angle_bam * (360 / 4294967296.0), 90, 0.5);
    EXPECT_NEAR(std::remainder(f.corner[0].bisector_bam * (360 / 4294967296.0) + 135, 360), 0, 0.5);
}

TEST(Extract, ABoxEdgeIsAConvexCornerAndHidesTheWallBehind)
{
    scene::extractor extract;
    const auto scan = empty_scan();
    auto walls = box(1.2, -0.2, 2.0, 0.9);
    walls.push_back({3, -2, 3, 2});
    see(*scan, walls, 3, 3);
    const ale_features_t &f = extract(*scan);
    const auto behind =
        std::find_if(f.line, f.line + f.line_count, [](const ale_line_t &l) { return l.rho_um > 2900000; });
    ASSERT_NE(behind, f.line + f.line_count);
    EXPECT_EQ(behind->last_end, ALE_END_OCCLUDED);
    EXPECT_EQ((behind + 1)->first_end, ALE_END_EDGE);
}

TEST(Extract, ConvexCornersPointTowardsTheSensor)
{
    scene::extractor extract;
    const auto scan = empty_scan();
    see(*scan, {{1.5, 0, 2.5, 1.2}, {1.5, 0, 2.5, -1.2}}, 3, 4);
    const ale_features_t &f = extract(*scan);
    ASSERT_EQ(f.corner_count, 1);
    EXPECT_EQ(f.corner[0].kind, ALE_CORNER_CONVEX);
    EXPECT_NEAR(std::remainder(f.corner[0].bisector_bam * (360 / 4294967296.0) - 180, 360), 0, 2);
}

TEST(Extract, ExactGridValuesGiveExactWalls)
{
    scene::extractor extract;
    const auto scan = empty_scan();
    see(*scan, box(-2, -1.5, 2, 1.5), 0, 0, 0.001);
    const ale_features_t &f = extract(*scan);
    ASSERT_EQ(f.line_count, 3); // the field of view ends before the wall behind
    for (int k = 0; k < f.line_count; k++) {
        EXPECT_LE(f.line[k].rmse_um, 200);
    }
    EXPECT_EQ(f.corner_count, 2);
}

TEST(Extract, TheLargestScanIsTakenWhole)
{
    scene::extractor extract;
    const auto scan = empty_scan(ALE_MAX_BEAMS, -135 * pi / 180, 0.25 * pi / 180);
    see(*scan, box(-20, -15, 60, 30), 10, 5);
    const ale_features_t &f = extract(*scan);
    expect_sane(*scan, f);
    ASSERT_GE(f.line_count, 4);
    for (int k = 0; k < f.line_count; k++) {
        const double nearest = std::min(std::fabs(std::remainder(alpha_of(f.line[k]), pi / 2)), 1.0);
        EXPECT_LT(nearest, 0.01);
    }
}

TEST(Extract, AFullTurnHasItsWallsWhereverItBegins)
{
    for (const double first : {0.0, 1.0, 2.5}) {
        scene::extractor extract;
        const auto scan = empty_scan(1024, first);
        see(*scan, box(-2, -1.5, 2, 1.5), 3, 6);
        const ale_features_t &f = extract(*scan);
        EXPECT_GE(f.line_count, 4);
        EXPECT_LE(f.line_count, 5); // one wall may be cut where the turn begins
    }
}

TEST(Extract, EveryNoiseLevelIsServedByOneSetting)
{
    scene::extractor extract;
    for (const double sigma : {1.0, 3.0, 10.0, 20.0}) {
        for (unsigned seed = 0; seed < 20; seed++) {
            const auto scan = empty_scan(1024, -pi);
            see(*scan, box(-2.2, -1.3, 2, 1.7), sigma, seed);
            const ale_features_t &f = extract(*scan);
            EXPECT_GE(f.line_count, 4) << sigma << " mm, seed " << seed;
            EXPECT_LE(f.line_count, 5) << sigma << " mm, seed " << seed;
        }
    }
}

TEST(Extract, AStepOfFourCentimetresIsTwoWalls)
{
    scene::extractor extract;
    for (unsigned seed = 0; seed < 20; seed++) {
        const auto scan = empty_scan();
        see(*scan, {{1.5, -1.5, 1.5, 0}, {1.54, 0, 1.54, 1.5}}, 5, seed);
        const ale_features_t &f = extract(*scan);
        ASSERT_EQ(f.line_count, 2) << seed;
        EXPECT_NEAR(f.line[0].last, 340, 2) << seed;
    }
}

// A wall two metres away bends by 18 degrees 14 beams before the scan ends: behind a break that the search
// missed the last of them lie on no line that it tried.
TEST(Extract, AShortWallBehindABendReachesTheEndOfTheScan)
{
    scene::extractor extract;
    const double y = 2 * std::tan(45.5 * scene::urg_step);
    const double turn = 18 * pi / 180;
    int found = 0;
    int whole = 0;
    for (unsigned k = 0; k < 5000; k++) {
        const auto scan = empty_scan(120, -60 * scene::urg_step);
        see(*scan, {{2, -2, 2, y}, {2, y, 2 - 2 * std::sin(turn), y + 2 * std::cos(turn)}}, 14, k);
        const ale_features_t &f = extract(*scan);
        found += f.line_count == 2 ? 1 : 0;
        whole += f.line_count == 2 && f.line[1].last == 119 ? 1 : 0;
    }
    EXPECT_GT(found, 3700);
    EXPECT_LT(found - whole, 35);
}

TEST(Extract, ARoundColumnIsACurveAndNoLine)
{
    scene::extractor extract;
    std::vector<scene::wall> column;
    for (int k = 0; k < 360; k++) {
        const double a = k * pi / 180;
        const double b = (k + 1) * pi / 180;
        column.push_back(
            {1.2 + 0.4 * std::cos(a), 0.4 * std::sin(a), 1.2 + 0.4 * std::cos(b), 0.4 * std::sin(b)});
    }
    const auto scan = empty_scan();
    see(*scan, column, 3, 7);
    const ale_features_t &f = extract(*scan);
    EXPECT_EQ(f.line_count, 0);
    ASSERT_GE(f.curve_count, 1);
    EXPECT_NEAR(f.curve[0].radius_um, 400000, 40000);
    EXPECT_NEAR(f.curve[0].centre.x_um, 1200000, 40000);
    EXPECT_GT(f.refused[ALE_REFUSED_CURVED], 0);
}

int all_refused(const ale_features_t &f)
{
    return std::accumulate(std::begin(f.refused), std::end(f.refused), 0);
}

TEST(Extract, WhatIsRefusedIsCountedOnceByTheTestThatItFailed)
{
    scene::extractor extract;
    const auto scan = empty_scan();
    see(*scan, {{1, -0.06, 1, 0.06}, {1, 0.40, 1, 0.44}}, 1, 3); /* 0.12 m; six beams */
    const ale_features_t &f = extract(*scan);
    EXPECT_EQ(f.line_count, 0);
    EXPECT_EQ(f.refused[ALE_REFUSED_SHORT], 1);
    EXPECT_EQ(f.refused[ALE_REFUSED_FEW_POINTS], 1);
    EXPECT_EQ(all_refused(f), 2);
}

// 0.15 m of a wall, where ranges are believed to be 20 mm off.
TEST(Extract, ALineOfNoSureDirectionIsRefusedAsThat)
{
    auto config = ale_extract_default_config();
    config.noise.own_um = 20000;
    scene::extractor extract(config);
    const auto scan = empty_scan();
    see(*scan, {{3, -0.075, 3, 0.075}}, 6, 3);
    const ale_features_t &f = extract(*scan);
    EXPECT_EQ(f.line_count, 0);
    EXPECT_EQ(f.refused[ALE_REFUSED_VAGUE], 1);
    EXPECT_EQ(all_refused(f), 1);
}

TEST(Extract, StrayPointsDoNotCutAWall)
{
    scene::extractor extract;
    const auto scan = empty_scan();
    see(*scan, {{2, -2, 2, 2}}, 3, 8);
    for (const int k : {250, 300, 301, 355, 400}) {
        ale_scan_set_range(scan.get(), static_cast<uint16_t>(k), 900000);
    }
    const ale_features_t &f = extract(*scan);
    ASSERT_EQ(f.line_count, 1);
    EXPECT_EQ(f.outliers, 5);
    expect_line(f.line[0], 0, 2000, 0.1, 1);
}

TEST(Extract, BearingsOfAStraightenedScanAreUsed)
{
    scene::extractor extract;
    const auto scan = empty_scan();
    see(*scan, {{2, -1.5, 2, 1.5}}, 3, 12);
    std::vector<uint32_t> bearing;
    for (int k = 0; k < scan->beams; k++) {
        bearing.push_back(ale_scan_bearing(scan.get(), k) + (30u << 22));
    }
    const ale_features_t a = extract(*scan);
    const ale_features_t &b = extract(*scan, bearing.data());
    ASSERT_EQ(a.line_count, 1);
    ASSERT_EQ(b.line_count, 1);
    EXPECT_NEAR(static_cast<int32_t>(b.line[0].alpha_bam - a.line[0].alpha_bam - (30u << 22)), 0, 20000);
}

TEST(Extract, SmoothingMayBeSwitchedOn)
{
    ale_extract_config_t config = ale_extract_default_config();
    config.smooth_span = 7;
    scene::extractor extract(config);
    const auto scan = empty_scan(1024, -pi);
    see(*scan, box(-2.2, -1.3, 2, 1.7), 5, 13);
    const ale_features_t &f = extract(*scan);
    EXPECT_GE(f.line_count, 4);
    EXPECT_LE(f.line_count, 5);
}

// Nothing is told apart where the range changes at every beam; near ends of such a surface the regression
// then says that 1/range is below 0.
TEST(Extract, SmoothsRangesThatChangeAtEveryBeam)
{
    ale_extract_config_t config = ale_extract_default_config();
    config.smooth_span = 15;
    config.robust_passes = 0;
    scene::extractor extract(config);
    const auto scan = empty_scan();
    scan->range_max_um = ALE_MAX_RANGE_UM;
    for (int k = 0; k < scan->beams; k++) {
        const bool inner = k >= 11 && k < scan->beams - 11;
        scan->flag[k] = ALE_BEAM_VALID;
        scan->range_um[k] = k % 2 == 0 ? 79000000 : inner ? 20000 : 20000000;
    }
    expect_sane(*scan, extract(*scan));
}

// The largest room and the largest shared error that the documents allow: its arcs are one line at 16 m of
// shared deviation, as long as the room.
TEST(Extract, WidestRoomInTheLargestSharedError)
{
    ale_extract_config_t config = ale_extract_default_config();
    config.noise.shared_um = 100000;
    config.noise.shared_ppm = 100000;
    config.noise.own_um = 0;
    config.noise.own_ppm = 0;
    for (const int32_t shared_beams : {1, ALE_MAX_BEAMS}) {
        config.noise.shared_beams = shared_beams;
        scene::extractor extract(config);
        for (int beams = 100; beams <= ALE_MAX_BEAMS; beams += 109) {
            const auto scan = empty_scan(beams, -beams * pi / 1440, pi / 720);
            for (int k = 0; k < beams; k++) {
                ale_scan_set_range(scan.get(), static_cast<uint16_t>(k), 79900000);
            }
            expect_sane(*scan, extract(*scan));
        }
    }
}

ale_extract_config_t any_config(std::mt19937 &random)
{
    const auto up_to = [&random](int32_t most) {
        return random() % 2 == 0 ? most : static_cast<int32_t>(random() % (static_cast<uint32_t>(most) + 1));
    };
    ale_extract_config_t config = ale_extract_default_config();
    config.noise = {.own_um = up_to(100000),
                    .own_ppm = up_to(100000),
                    .shared_um = up_to(100000),
                    .shared_ppm = up_to(100000),
                    .shared_beams = std::max(1, up_to(ALE_MAX_BEAMS)),
                    .surface_um = up_to(100000),
                    .bearing_nrad = up_to(100000000),
                    .own_ppm_per_m = random() % 2 == 0 ? 0 : up_to(10000)};
    config.min_points = static_cast<uint16_t>(5 + random() % 20);
    config.smooth_span = static_cast<uint16_t>(random() % 2 == 0 ? 1 : 1 + 2 * (random() % 16));
    return config;
}

// Surfaces of any distance and steepness, each with a noise of its own, seen by beams of any step.
void any_scan(std::mt19937 &random, ale_scan_t *scan)
{
    const auto part = [&random] { return std::uniform_real_distribution<double>(0, 1)(random); };
    scan->beams = static_cast<uint16_t>(random() % 2 == 0 ? ALE_MAX_BEAMS : random() % (ALE_MAX_BEAMS + 1));
    scan->step_bam = static_cast<int32_t>(random() >> (random() % 2 == 0 ? 0 : 10));
    scan->first_bearing_bam = static_cast<uint32_t>(random());
    scan->own_bearings = random() % 3 == 0;
    double range_m = 1;
    double slope_m = 0;
    double sigma_m = 0;
    for (int k = 0; k < scan->beams; k++) {
        if (k == 0 || random() % 100 == 0) {
            range_m = std::pow(10, -1.75 + 3.65 * part());
            slope_m = range_m * (part() - 0.5) * 0.02;
            sigma_m = random() % 2 == 0 ? 0 : std::pow(10, -4 + 3.5 * part());
        }
        range_m += slope_m;
        const double seen_m = std::clamp(range_m + sigma_m * (part() - part()), 0.0165, 80.0);
        scan->range_um[k] = static_cast<int32_t>(1e6 * seen_m);
        scan->flag[k] = random() % 50 == 0 ? ALE_BEAM_UNKNOWN : ALE_BEAM_VALID;
        scan->bearing_bam[k] = scan->first_bearing_bam +
                               static_cast<uint32_t>(k) * static_cast<uint32_t>(scan->step_bam) +
                               static_cast<uint32_t>(random() % 100000);
    }
}

// Whatever is configured and seen: sanitizers find what does not fit its numbers, and places are as
// features.h says.
TEST(Extract, AnyModelAndScanFitTheNumbers)
{
    std::mt19937 random(21);
    const auto scan = empty_scan();
    for (int round = 0; round < 400; round++) {
        scene::extractor extract(any_config(random));
        any_scan(random, scan.get());
        const ale_features_t &f = extract(*scan);
        for (int k = 0; k < f.line_count; k++) {
            const ale_line_t &line = f.line[k];
            EXPECT_LE(line.var_alpha_nrad2, ALE_MOST_VAR_ALPHA_NRAD2);
            EXPECT_LE(std::abs(line.cov_alpha_rho), ALE_MOST_VAR_ALPHA_NRAD2);
            EXPECT_LE(line.var_rho_um2, ALE_MOST_VAR_ALPHA_NRAD2);
            EXPECT_LE(line.rmse_um, ALE_MAX_RANGE_UM);
            for (const int32_t um : {line.start.x_um, line.start.y_um, line.end.x_um, line.end.y_um}) {
                EXPECT_LE(std::abs(um), ALE_MAX_PLACE_UM);
            }
        }
    }
}

TEST(Extract, CovarianceIsCalibratedInSimulation)
{
    scene::extractor extract;
    double alpha2 = 0;
    double rho2 = 0;
    int lines = 0;
    for (unsigned seed = 0; seed < 400; seed++) {
        const auto scan = empty_scan();
        see(*scan, {{2, -1.6, 2, 1.1}}, 8, seed, 0.001);
        const ale_features_t &f = extract(*scan);
        if (f.line_count == 1) {
            const ale_line_t &l = f.line[0];
            alpha2 += std::pow(std::remainder(alpha_of(l), 2 * pi), 2) * 1e18 /
                      static_cast<double>(l.var_alpha_nrad2);
            rho2 += std::pow(l.rho_um - 2e6, 2) / static_cast<double>(l.var_rho_um2);
            lines++;
        }
    }
    ASSERT_GE(lines, 390);
    // The tolerated shared error makes the stated variance larger than that of independent noise, never
    // smaller.
    EXPECT_GT(alpha2 / lines, 0.2);
    EXPECT_LT(alpha2 / lines, 1.2);
    EXPECT_GT(rho2 / lines, 0.2);
    EXPECT_LT(rho2 / lines, 1.2);
}

// A wall two metres away behind 340 beams, with 1.5 mm of each beam's own and 5 mm that neighbours share over
// 12 beams, which steps back by `step_mm` at beam 170.
scene::scan_ptr wavy_wall(double step_mm, unsigned seed)
{
    std::mt19937 engine(seed);
    std::normal_distribution<double> gauss;
    auto scan = empty_scan(340, -170 * scene::urg_step);
    const double kept = std::exp(-1.0 / 12);
    double shared = gauss(engine);
    for (int k = 0; k < scan->beams; k++) {
        const double distance = (2000 + (k > 170 ? step_mm : 0)) / std::cos((k - 170) * scene::urg_step);
        ale_scan_set_range(scan.get(), static_cast<uint16_t>(k),
                           static_cast<int32_t>(1000 * (distance + 5 * shared + 1.5 * gauss(engine))));
        shared = kept * shared + std::sqrt(1 - kept * kept) * gauss(engine);
    }
    return scan;
}

bool parted_near(const ale_features_t &f, int beam)
{
    return std::any_of(f.line, f.line + f.line_count,
                       [&](const ale_line_t &line) { return std::abs(line.last - beam) <= 4; });
}

TEST(Extract, AStepIsToldFromTheWavesThatNeighboursShareOnALongWall)
{
    scene::extractor extract;
    int whole = 0;
    int found = 0;
    for (unsigned seed = 0; seed < 500; seed++) {
        whole += extract(*wavy_wall(0, seed)).line_count == 1 ? 1 : 0;
        found += parted_near(extract(*wavy_wall(18, seed)), 170) ? 1 : 0;
    }
    EXPECT_GE(whole, 498);
    EXPECT_GT(found, 300);
}

// A room of many chords of uneven length, at 2.2 to 2.5 m.
std::vector<scene::wall> ring_of_chords(unsigned seed, int chords)
{
    std::mt19937 engine(seed);
    const auto uniform = [&](double low, double high) {
        return low + (high - low) * static_cast<double>(engine()) / 4294967296.0;
    };
    std::vector<scene::wall> ring(static_cast<std::size_t>(chords));
    for (int k = 0; k < chords; k++) {
        const double bearing = (k + uniform(-0.4, 0.4)) * 2 * pi / chords;
        const double range = uniform(2.2, 2.5);
        const double x = range * std::cos(bearing);
        const double y = range * std::sin(bearing);
        scene::wall &before = ring[static_cast<std::size_t>(k > 0 ? k - 1 : chords - 1)];
        before.x2 = x;
        before.y2 = y;
        ring[static_cast<std::size_t>(k)].x1 = x;
        ring[static_cast<std::size_t>(k)].y1 = y;
    }
    return ring;
}

// Each pass begins within the bound, so the last one may end beyond it: but not by three quarters of it.
TEST(Extract, SearchBreaksSplitsAndCurvesTogetherSpendNoMoreThanTheirBound)
{
    scene::extractor extract;
    int most = 0;
    int beyond = 0;
    for (unsigned seed = 0; seed < 200; seed++) {
        const auto scan = empty_scan();
        see(*scan, ring_of_chords(seed, 26), seed % 2 == 0 ? 10 : 15, seed);
        extract(*scan);
        most = std::max(most, extract.get()->runs.effort);
        beyond += extract.get()->runs.effort > ALE_MOST_EFFORT ? 1 : 0;
    }
    EXPECT_GT(beyond, 100) << "the rooms are too simple";
    EXPECT_LT(most, ALE_MOST_EFFORT * 7 / 4);
}

TEST(Extract, AnyInputGivesASaneResult)
{
    scene::extractor extract;
    std::mt19937 engine(14);
    for (int trial = 0; trial < 1500; trial++) {
        const int beams = static_cast<int>(engine() % (ALE_MAX_BEAMS + 1));
        const auto scan = empty_scan(beams, static_cast<double>(engine() % 1000) * 0.006,
                                     (static_cast<double>(engine() % 200) - 100) * 1e-4);
        const unsigned kind = engine() % 4;
        int64_t range = 1000000;
        for (int k = 0; k < beams; k++) {
            if (kind == 0 || engine() % 40 == 0) {
                range = static_cast<int64_t>(engine() % ALE_MAX_RANGE_UM);
            }
            range += kind == 1 ? static_cast<int64_t>(engine() % 20001) - 10000 : 0;
            range = std::clamp<int64_t>(range, -5, ALE_MAX_RANGE_UM + int64_t{5});
            scan->range_um[k] =
                static_cast<int32_t>(kind == 3 ? INT32_MAX - static_cast<int32_t>(engine() % 9) : range);
            scan->flag[k] = engine() % 9 == 0 ? ALE_BEAM_UNKNOWN : ALE_BEAM_VALID;
        }
        expect_sane(*scan, extract(*scan));
    }
}

TEST(Extract, TheSameScanGivesTheSameBytesWhateverCameBefore)
{
    scene::extractor used;
    scene::extractor fresh;
    const auto scan = empty_scan();
    for (unsigned seed = 0; seed < 5; seed++) {
        see(*scan, box(-2, -1.3 - 0.1 * seed, 2, 1.7), 5, seed);
        used(*scan);
    }
    const ale_features_t &a = used(*scan);
    const ale_features_t &b = fresh(*scan);
    ASSERT_EQ(a.line_count, b.line_count);
    for (int k = 0; k < a.line_count; k++) {
        EXPECT_EQ(a.line[k].alpha_bam, b.line[k].alpha_bam);
        EXPECT_EQ(a.line[k].var_rho_um2, b.line[k].var_rho_um2);
    }
}

TEST(Extract, AConfigurationOutOfRangeIsRefused)
{
    scene::extractor extract;
    for (int field = 0; field < 5; field++) {
        ale_extract_config_t config = ale_extract_default_config();
        config.noise.own_um = field == 0 ? -1 : config.noise.own_um;
        config.smooth_span = static_cast<uint16_t>(field == 1 ? 4 : config.smooth_span);
        config.min_points = static_cast<uint16_t>(field == 2 ? 2 : config.min_points);
        config.min_length_um = field == 3 ? -1 : config.min_length_um;
        config.noise.shared_beams = field == 4 ? 0 : config.noise.shared_beams;
        EXPECT_EQ(ale_extractor_init(extract.get(), &config), -1) << field;
    }
}

} // namespace
