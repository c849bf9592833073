// Whether the covariances of lines, their ends and corners hold: mean normalised squared errors over
// simulated rooms, whose truth is known. A covariance that holds gives the number of dimensions.
//
// Asked of lines of 20 beams and more that end within two beams of where their wall ends: a shorter one, or
// one with beams of its neighbour, errs by what no noise model knows. So does one that is seven deviations
// off, which chance makes of none in 10^10: it is counted, not averaged.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <string>

#include <Eigen/Dense>

#include "lab/bench/truth.hpp"
#include "lib/extract/scene.h"

namespace
{

constexpr int least_beams = 20;
constexpr int scans = 1000;
constexpr double gross = 50; // squared deviations

class Mean
{
  public:
    void add(double value)
    {
        if (value > gross) {
            strays++;
            return;
        }
        sum += value;
        count++;
    }
    double value() const
    {
        return sum / count;
    }
    int samples() const
    {
        return count;
    }
    double stray_share() const
    {
        return static_cast<double>(strays) / count;
    }

  private:
    double sum = 0;
    int count = 0;
    int strays = 0;
};

struct Errors {
    Mean lines;   // of (alpha, rho): 2 dimensions
    Mean ends;    // at corners, along the line: 1
    Mean corners; // 2
};

bench::Point metres(const ale_point_t &p)
{
    return {p.x_um * 1e-6, p.y_um * 1e-6};
}

bool is_of(const ale_line_t &line, const bench::TrueLine &truth)
{
    return truth.counts && line.points >= least_beams && std::abs(line.first - truth.first) <= 2 &&
           std::abs(line.last - truth.last) <= 2;
}

void add_line(const ale_line_t &line, const bench::NormalForm &truth, Errors &errors)
{
    const double alpha = line.alpha_bam * (2 * bench::pi / 4294967296.0);
    const Eigen::Vector2d error(std::remainder(alpha - truth.alpha, 2 * bench::pi),
                                line.rho_um * 1e-6 - truth.rho);
    const auto cov_alpha_rho = static_cast<double>(line.cov_alpha_rho) * 1e-15;
    Eigen::Matrix2d cov;
    cov << static_cast<double>(line.var_alpha_nrad2) * 1e-18, cov_alpha_rho, cov_alpha_rho,
        static_cast<double>(line.var_rho_um2) * 1e-12;
    errors.lines.add(error.dot(cov.inverse() * error));
}

void add_ends(const ale_line_t &line, const bench::Truth &truth, const bench::NormalForm &form,
              Errors &errors)
{
    const bench::Point tangent(-form.normal().y(), form.normal().x());
    for (const bool start : {true, false}) {
        const bench::Point end = metres(start ? line.start : line.end);
        const auto var = static_cast<double>(start ? line.var_start_um2 : line.var_end_um2) * 1e-12;
        for (const bench::TrueCorner &corner : truth.corners) {
            const double error = tangent.dot(end - corner.p);
            if (corner.counts && std::abs(form.normal().dot(corner.p) - form.rho) < 1e-6 &&
                std::abs(error) < 0.1) {
                errors.ends.add(error * error / var);
            }
        }
    }
}

void add_corners(const ale_features_t &f, const bench::Truth &truth, Errors &errors)
{
    for (int k = 0; k < f.corner_count; k++) {
        const ale_corner_t &corner = f.corner[k];
        if (f.line[corner.first_line].points < least_beams ||
            f.line[corner.second_line].points < least_beams) {
            continue;
        }
        Eigen::Matrix2d cov;
        cov << static_cast<double>(corner.cov_um2[0]), static_cast<double>(corner.cov_um2[1]),
            static_cast<double>(corner.cov_um2[1]), static_cast<double>(corner.cov_um2[2]);
        for (const bench::TrueCorner &t : truth.corners) {
            const bench::Point error = (metres(corner.p) - t.p) * 1e6;
            if (error.norm() < 1e5) {
                errors.corners.add(error.dot(cov.inverse() * error));
            }
        }
    }
}

// A line does not know the bias of its surface (section II of the paper names it and models none): it is left
// out here, and lib/track adds it.
Errors errors_under(const std::string &kind)
{
    bench::Noise noise = bench::noise_kind(kind);
    noise.surface = 0;
    bench::Random random(7);
    scene::extractor extract;
    Errors errors;
    const char *const kinds[] = {"room", "lroom", "boxes", "corridor", "doors"};
    for (int k = 0; k < scans; k++) {
        const bench::World world = bench::make_world(kinds[k % 5], random);
        const bench::SimulatedScan simulated = bench::simulate(world, noise, random);
        const bench::Truth truth = bench::make_truth(world, noise, simulated);
        const ale_features_t &f = extract(*simulated.scan);
        for (int i = 0; i < f.line_count; i++) {
            for (const bench::TrueLine &t : truth.lines) {
                if (is_of(f.line[i], t)) {
                    add_line(f.line[i], t.form, errors);
                    add_ends(f.line[i], truth, t.form, errors);
                }
            }
        }
        add_corners(f, truth, errors);
    }
    return errors;
}

void report(const std::string &kind, const Errors &e)
{
    std::printf("%-5s %5d lines %.3f of 2, %5d ends %.3f of 1, %5d corners %.3f of 2\n", kind.c_str(),
                e.lines.samples(), e.lines.value(), e.ends.samples(), e.ends.value(), e.corners.samples(),
                e.corners.value());
}

// How much is shared is measured anew in every scan, from few independent pieces: more lines are far off.
TEST(Covariance, HoldsWithinATenthAtEveryNoise)
{
    for (const std::string kind : {"urg", "3mm", "10mm", "20mm", "real"}) {
        const Errors e = errors_under(kind);
        report(kind, e);
        EXPECT_GT(e.lines.samples(), 4000) << kind;
        EXPECT_LT(e.lines.stray_share() + e.ends.stray_share() + e.corners.stray_share(),
                  kind == "real" ? 0.003 : 0.001)
            << kind;
        EXPECT_NEAR(e.lines.value(), 2, 0.2) << kind;
        EXPECT_NEAR(e.ends.value(), 1, 0.1) << kind;
        EXPECT_NEAR(e.corners.value(), 2, 0.2) << kind;
    }
}

} // namespace
