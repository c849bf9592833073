// lib/extract/moments.c and line_fit.c against the twin in double.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <random>

#include "reference/total_least_squares.h"

extern "C" {
#include "extract/line_fit.h"
#include "extract/moments.h"
}

namespace
{

constexpr double pi = 3.14159265358979323846;

// Puts points (mm) into a scan as the steps before leave them.
void load(ale_prepared_scan_t *scan, const std::vector<Eigen::Vector2d> &points_mm)
{
    ale_points_t &p = scan->points;
    p.count = static_cast<uint16_t>(points_mm.size());
    for (size_t i = 0; i < points_mm.size(); i++) {
        p.beam[i] = static_cast<uint16_t>(i);
        p.x_q4[i] = static_cast<int32_t>(std::lround(points_mm[i].x() * 16));
        p.y_q4[i] = static_cast<int32_t>(std::lround(points_mm[i].y() * 16));
        p.range_um[i] = static_cast<int32_t>(std::lround(points_mm[i].norm() * 1000));
        p.inverse_q44[i] = static_cast<int32_t>((int64_t{1} << 44) / p.range_um[i]);
    }
    scan->noise = {};
    scan->noise.own_mm2_q36 = int64_t{25} << 36; // 5 mm
    scan->noise.own_scale_q16 = 1 << 16;
    scan->noise.shared_beams = ale_noise_default().shared_beams;
    ale_moments_build(scan);
}

std::vector<Eigen::Vector2d> grid_of(const ale_prepared_scan_t *scan, int first, int last)
{
    std::vector<Eigen::Vector2d> points;
    for (int i = first; i <= last; i++) {
        points.emplace_back(scan->points.x_q4[i] / 16.0, scan->points.y_q4[i] / 16.0);
    }
    return points;
}

std::vector<Eigen::Vector2d> noisy_wall(std::mt19937 &engine, int n, double reach_mm)
{
    std::uniform_real_distribution<double> angle(-pi, pi);
    std::uniform_real_distribution<double> unit(0.05, 1.0);
    std::normal_distribution<double> gauss(0, 5);
    const double alpha = angle(engine);
    const double rho = reach_mm * 0.5 * unit(engine);
    const double from = -reach_mm * 0.4 * unit(engine);
    const double length = reach_mm * 0.8 * unit(engine);
    std::vector<Eigen::Vector2d> points;
    for (int i = 0; i < n; i++) {
        const double t = from + length * i / n;
        const double r = rho + gauss(engine);
        points.emplace_back(r * std::cos(alpha) - t * std::sin(alpha),
                            r * std::sin(alpha) + t * std::cos(alpha));
    }
    return points;
}

TEST(Moments, SquaredResidualsOfAnyRunAgreeWithTheTwin)
{
    const auto scan = std::make_unique<ale_prepared_scan_t>();
    std::mt19937 engine(1);
    for (const double reach : {500.0, 5600.0, 30000.0, 80000.0}) {
        for (int trial = 0; trial < 200; trial++) {
            const int n = 5 + static_cast<int>(engine() % 600);
            load(scan.get(), noisy_wall(engine, n, reach));
            const int first = static_cast<int>(engine() % static_cast<unsigned>(n - 4));
            const int last = first + 3 + static_cast<int>(engine() % static_cast<unsigned>(n - first - 3));
            const auto twin = reference::total_least_squares(grid_of(scan.get(), first, last));
            const ale_run_fit_t fit = ale_moments_fit(scan.get(), first, last);
            const double points = last + 1 - first;
            // the scatter has 30 bits: its small eigenvalue is known to 2^-28 of the large one; one step of
            // the iteration for it leaves the square of their ratio
            const double bound = 0.02 * points + 4e-9 * twin.along2 + 1e-4 * twin.sse +
                                 1.5 * twin.sse * std::pow(twin.sse / twin.along2, 2);
            EXPECT_NEAR(static_cast<double>(fit.sse_q8) / 256, twin.sse, bound) << reach << " mm, " << points;
            EXPECT_EQ(fit.sse_q8, ale_moments_sse_q8(scan.get(), first, last));
        }
    }
}

TEST(Moments, ExpectedVarianceIsTheNoiseSeenAlongTheNormal)
{
    const auto scan = std::make_unique<ale_prepared_scan_t>();
    std::mt19937 engine(2);
    for (int trial = 0; trial < 200; trial++) {
        load(scan.get(), noisy_wall(engine, 200, 5600));
        const auto points = grid_of(scan.get(), 0, 199);
        const auto twin = reference::total_least_squares(points);
        double expected = 0;
        for (const auto &p : points) {
            expected += 25 * std::pow(twin.rho / p.norm(), 2) / 200;
        }
        const ale_run_fit_t fit = ale_moments_fit(scan.get(), 0, 199);
        EXPECT_NEAR(static_cast<double>(fit.var_q8) / 256, expected, 0.03 * expected + 0.1);
    }
}

TEST(LineFit, NormalFormAgreesWithTheTwin)
{
    const auto scan = std::make_unique<ale_prepared_scan_t>();
    std::mt19937 engine(3);
    for (int trial = 0; trial < 500; trial++) {
        const int n = 8 + static_cast<int>(engine() % 400);
        load(scan.get(), noisy_wall(engine, n, 5600));
        const auto twin = reference::total_least_squares(grid_of(scan.get(), 0, n - 1));
        ale_line_t line;
        ale_line_fit(scan.get(), {0, static_cast<uint16_t>(n - 1)}, &line);
        const double alpha = line.alpha_bam * (2 * pi / 4294967296.0);
        const double sigma_alpha = 5 / std::sqrt(twin.along2);
        EXPECT_NEAR(std::remainder(alpha - twin.alpha, 2 * pi), 0, 0.01 * sigma_alpha + 1e-8);
        EXPECT_NEAR(line.rho_um / 1000.0, twin.rho, 0.01 * sigma_alpha * std::fabs(twin.mean_along) + 0.01);
        EXPECT_NEAR(line.rmse_um / 1000.0, std::sqrt(twin.sse / (n - 2)), 0.02);
        EXPECT_GE(line.rho_um, 0);
    }
}

// A wall as a scanner at the origin sees it: beams of one angle from each other.
std::vector<Eigen::Vector2d> seen_wall(std::mt19937 &engine, int n)
{
    std::uniform_real_distribution<double> angle(-pi, pi);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    std::normal_distribution<double> gauss(0, 5);
    const double alpha = angle(engine);
    const double rho = 200 + 2000 * unit(engine);
    const double from = -1.4 + 2.2 * unit(engine);
    const double to = from + (1.4 - from) * (0.2 + 0.8 * unit(engine));
    std::vector<Eigen::Vector2d> points;
    for (int i = 0; i < n; i++) {
        const double turned = from + (to - from) * i / n;
        const double range = rho / std::cos(turned) + gauss(engine);
        points.emplace_back(range * std::cos(alpha + turned), range * std::sin(alpha + turned));
    }
    return points;
}

// Where the noise along the normal, 5 mm of the range, is not the same for all points, the slope has what
// least squares make of it, within 8 %: the noise is looked at in a few points only. With the mean it is not
// correlated.
TEST(LineFit, CovarianceIsThatOfIndependentNoiseAlongTheLine)
{
    const auto scan = std::make_unique<ale_prepared_scan_t>();
    std::mt19937 engine(4);
    for (int trial = 0; trial < 200; trial++) {
        const int n = 150;
        load(scan.get(), seen_wall(engine, n));
        ale_line_t line;
        ale_line_fit(scan.get(), {0, n - 1}, &line);
        const auto points = grid_of(scan.get(), 0, n - 1);
        const auto twin = reference::total_least_squares(points);
        const Eigen::Vector2d tangent(-std::sin(twin.alpha), std::cos(twin.alpha));
        double of_alpha = 0;
        double of_mean = 0;
        for (const auto &p : points) {
            const double var = 25 * std::pow(twin.rho / p.norm(), 2);
            of_alpha += var * std::pow((tangent.dot(p) - twin.mean_along) / twin.along2, 2);
            of_mean += var / (n * n);
        }
        const double alpha2 = static_cast<double>(line.var_alpha_nrad2) * 1e-18;
        const double both = static_cast<double>(line.cov_alpha_rho) * 1e-12;
        const double rho2 = static_cast<double>(line.var_rho_um2) * 1e-6;
        EXPECT_NEAR(alpha2, of_alpha, 0.16 * of_alpha) << trial;
        EXPECT_NEAR(both, alpha2 * twin.mean_along, 0.01 * std::fabs(both) + 1e-9) << trial;
        EXPECT_NEAR(rho2 - both * twin.mean_along, of_mean, 0.05 * of_mean + 1e-3 * rho2) << trial;
    }
}

TEST(LineFit, TheEndsLieOnTheLine)
{
    const auto scan = std::make_unique<ale_prepared_scan_t>();
    std::mt19937 engine(5);
    for (int trial = 0; trial < 100; trial++) {
        load(scan.get(), noisy_wall(engine, 60, 4000));
        ale_line_t line;
        ale_line_fit(scan.get(), {0, 59}, &line);
        const double alpha = line.alpha_bam * (2 * pi / 4294967296.0);
        for (const ale_point_t p : {line.start, line.end}) {
            EXPECT_NEAR(p.x_um * std::cos(alpha) + p.y_um * std::sin(alpha), line.rho_um, 3.0);
        }
    }
}

} // namespace
