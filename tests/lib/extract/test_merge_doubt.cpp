// lib/extract/merge.c, the doubt of a line: a step that noise hides against least squares in double; and
// whether the covariances of lines hold for a scanner that triangulates.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include <Eigen/Dense>

#include "lib/extract/scene.h"
#include "reference/total_least_squares.h"

extern "C" {
#include "extract/merge.h"
}

namespace
{

constexpr double shallow_mm = 50;
constexpr double deep_mm = 200;
constexpr int penalty = 19;

ale_scan_noise_t triangulating()
{
    ale_scan_noise_t noise = {};
    noise.own_square_q60 = 1;
    return noise;
}

// A wall of 1 mm steps and of this length, its second half behind the first one by a step.
std::vector<Eigen::Vector2d> stepped(int n, double length, double step)
{
    std::vector<Eigen::Vector2d> points;
    for (int i = 0; i < n; i++) {
        points.emplace_back(i * length / (n - 1), i < n / 2 ? 0 : step);
    }
    return points;
}

// The squares of the tilt and of what two lines gain are as the step's: found once at 1 mm. Bound: 3 % of the
// square of the step, for it lies between two of few points.
TEST(MergeDoubt, IsTheTiltOfTheDeepestStepThatABreakWouldNotGainBy)
{
    const ale_scan_noise_t noise = triangulating();
    std::mt19937 engine(1);
    std::uniform_real_distribution<double> unit(0, 1);
    int within = 0;
    for (int trial = 0; trial < 500; trial++) {
        const int n = 2 * (8 + static_cast<int>(unit(engine) * 200));
        const double length = 1000 + 7000 * unit(engine);
        const double var = std::pow(5 + 150 * unit(engine), 2);
        const auto unit_step = reference::total_least_squares(stepped(n, length, 1));
        const double deepest2 = penalty * var / unit_step.sse;
        const double step2 = std::min(std::max(deepest2 - shallow_mm * shallow_mm, 0.0), deep_mm * deep_mm);
        const double tilt = std::remainder(unit_step.alpha - scene::pi / 2, scene::pi);
        ale_spread_t m = {};
        m.fit.n = n;
        m.fit.var_q8 = std::llround(256 * var);
        m.along2_q8 = std::llround(256 * unit_step.along2);
        const ale_merge_doubt_t doubt = ale_merge_doubt(&noise, &m);
        EXPECT_EQ(doubt.var_q8, m.fit.var_q8);
        const double told = static_cast<double>(doubt.slope_q8) / static_cast<double>(m.along2_q8);
        const double bound = 0.03 * std::min(deepest2, deep_mm * deep_mm);
        EXPECT_NEAR(told, step2 * tilt * tilt, bound * tilt * tilt) << trial;
        EXPECT_NEAR(static_cast<double>(doubt.mean_q8) / 256 / n, step2 / 16, bound / 16) << trial;
        within += step2 > 0 && step2 < deep_mm * deep_mm ? 1 : 0;
    }
    EXPECT_GT(within, 100);
}

TEST(MergeDoubt, NoiseOfAnyOtherKindHidesNothing)
{
    const ale_scan_noise_t noise = {};
    ale_spread_t m = {};
    m.fit = {.n = 20, .sse_q8 = int64_t{1} << 30, .var_q8 = 1 << 20, .shared_q8 = 0};
    m.along2_q8 = int64_t{1} << 40;
    const ale_merge_doubt_t doubt = ale_merge_doubt(&noise, &m);
    EXPECT_EQ(doubt.var_q8, m.fit.var_q8);
    EXPECT_EQ(doubt.mean_q8, 0);
    EXPECT_EQ(doubt.slope_q8, 0);
}

TEST(MergeDoubt, ResidualsBeyondTheNoiseCountAsNoise)
{
    const ale_scan_noise_t noise = triangulating();
    ale_spread_t m = {};
    m.fit = {.n = 20, .sse_q8 = 18 * 900, .var_q8 = 400, .shared_q8 = 0};
    m.along2_q8 = int64_t{1} << 40;
    EXPECT_EQ(ale_merge_doubt(&noise, &m).var_q8, 900);
    m.fit.sse_q8 = 18 * 300;
    EXPECT_EQ(ale_merge_doubt(&noise, &m).var_q8, 400);
}

// The largest scan and the least: what is told stays a variance, and the turn below 3/4 rad^2.
TEST(MergeDoubt, StaysWithinItsBounds)
{
    const ale_scan_noise_t noise = triangulating();
    for (const int n : {1, 2, 3, ALE_MAX_BEAMS}) {
        for (const int64_t sse_q8 : {int64_t{0}, INT64_MAX}) {
            for (const int64_t var_q8 : {int64_t{1}, INT64_MAX}) {
                for (const int64_t along2_q8 : {int64_t{0}, int64_t{4}, INT64_MAX}) {
                    ale_spread_t m = {};
                    m.fit = {.n = n, .sse_q8 = sse_q8, .var_q8 = var_q8, .shared_q8 = 0};
                    m.along2_q8 = along2_q8;
                    const ale_merge_doubt_t doubt = ale_merge_doubt(&noise, &m);
                    EXPECT_GE(doubt.var_q8, var_q8);
                    EXPECT_GE(doubt.mean_q8, 0);
                    EXPECT_LE(doubt.slope_q8, along2_q8 / 4 * 3);
                }
            }
        }
    }
}

// The RPLIDAR A1 as its preset has it: a turn of 400 beams.
ale_extract_config_t rplidar_a1()
{
    ale_extract_config_t config = ale_extract_default_config();
    config.noise.own_um = 2000;
    config.noise.own_ppm = 1000;
    config.noise.own_ppm_per_m = 2200;
    config.noise.shared_um = 0;
    config.noise.shared_ppm = 0;
    config.noise.bearing_nrad = 2600000;
    return config;
}

scene::scan_ptr seen_by_rplidar_a1(const std::vector<scene::wall> &walls, std::mt19937 &engine)
{
    std::normal_distribution<double> gauss;
    auto scan = scene::empty_scan(400, -scene::pi, 2 * scene::pi / 400);
    for (int k = 0; k < 400; k++) {
        const double range = scene::cast(walls, scene::bearing_of(*scan, k) + 0.0026 * gauss(engine));
        const double sigma = std::hypot(0.002, 0.001 * range, 0.0022 * range * range);
        const double mm = std::round(1000 * (range + sigma * gauss(engine)));
        ale_scan_set_range(scan.get(), static_cast<uint16_t>(k), static_cast<int32_t>(1000 * mm));
    }
    return scan;
}

// A room whose far wall, 5 to 8 m off, is two surfaces: one stands out from the other by a step.
struct room {
    double far, step, at, near, left, right;

    std::vector<scene::wall> walls() const
    {
        return {{far, left, far, at},    {far, at, far - step, at}, {far - step, at, far - step, right},
                {far, left, near, left}, {near, left, near, right}, {near, right, far - step, right}};
    }
};

struct far_errors {
    double alpha = 0; // mean squared errors over what is told: of one dimension,
    double both = 0;  // and of two
    int lines = 0;
};

// Of the lines that lie on the far wall, against the surface that is at their middle.
void add_far_lines(const ale_features_t &f, const room &r, far_errors &errors)
{
    for (int k = 0; k < f.line_count; k++) {
        const ale_line_t &line = f.line[k];
        const double alpha = std::remainder(line.alpha_bam * (2 * scene::pi / 4294967296.0), 2 * scene::pi);
        const double y = (line.start.y_um + line.end.y_um) * 0.5e-6;
        const double rho = y < r.at ? r.far : r.far - r.step;
        if (std::fabs(alpha) > 0.6 || line.rho_um * 1e-6 < r.far - 1.5) {
            continue;
        }
        const Eigen::Vector2d error(alpha, line.rho_um * 1e-6 - rho);
        const double both = static_cast<double>(line.cov_alpha_rho) * 1e-15;
        Eigen::Matrix2d cov;
        cov << static_cast<double>(line.var_alpha_nrad2) * 1e-18, both, both,
            static_cast<double>(line.var_rho_um2) * 1e-12;
        errors.alpha += alpha * alpha / cov(0, 0);
        errors.both += error.dot(cov.inverse() * error);
        errors.lines++;
    }
}

far_errors far_wall(double least_step, double most_step, unsigned seed)
{
    std::mt19937 engine(seed);
    std::uniform_real_distribution<double> unit(0, 1);
    const ale_extract_config_t config = rplidar_a1();
    scene::extractor extract(config);
    far_errors errors;
    for (int k = 0; k < 1000; k++) {
        const double step = least_step + (most_step - least_step) * unit(engine);
        const double left = -1 - 0.7 * unit(engine);
        const double right = 1 + 0.7 * unit(engine);
        const double at = left + (right - left) * unit(engine);
        const room r = {5 + 3 * unit(engine), step, at, -1.5 - unit(engine), left, right};
        add_far_lines(extract(*seen_by_rplidar_a1(r.walls(), engine)), r, errors);
    }
    errors.alpha /= errors.lines;
    errors.both /= errors.lines;
    std::printf("steps of %.2f to %.2f m: %d lines, %.2f of 1, %.2f of 2\n", least_step, most_step,
                errors.lines, errors.alpha, errors.both);
    return errors;
}

TEST(MergeDoubt, ALineThroughTwoSurfacesErrsByNoMoreThanItIsToldWith)
{
    const far_errors errors = far_wall(0.18, 0.30, 1);
    EXPECT_GT(errors.lines, 500);
    EXPECT_LT(errors.alpha, 1.5);
    EXPECT_LT(errors.both, 4);
}

// Whether there is a step cannot be known: lines on one surface are told with the same doubt.
TEST(MergeDoubt, ALineOnOneSurfaceErrsByLess)
{
    const far_errors errors = far_wall(0, 0, 2);
    EXPECT_GT(errors.lines, 500);
    EXPECT_LT(errors.both, 2.2);
    EXPECT_GT(errors.alpha, 0.03);
}

} // namespace
