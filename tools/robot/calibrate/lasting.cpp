#include "robot/calibrate/lasting.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <Eigen/QR>
#include <stdexcept>

#include "robot/calibrate/bend.h"
#include "robot/calibrate/statistics.h"

extern "C" {
#include "extract/extract.h"
}

namespace calibrate
{

namespace
{

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double radians_per_bam = 6.283185307179586 / 4294967296.0;
constexpr int least_wall_beams = 30;
constexpr int least_wall_length_um = 500000;
constexpr int end_margin = 3;     /* beams beside a corner see both walls */
constexpr double in_front = 0.08; /* farther from its line lies what hides a piece of the wall */
constexpr double shortest_length = 2;
constexpr double longest_length = 60;

struct FreeMemory {
    void operator()(void *memory) const
    {
        std::free(memory);
    }
};

/* Straight is a wall also when it is wavy by what the sensor does to it. */
ale_extract_config_t tolerant_config()
{
    ale_extract_config_t config = ale_extract_default_config();
    config.noise.own_um = 1000;
    config.noise.shared_um = 5000;
    config.noise.shared_ppm = 3000;
    config.min_points = least_wall_beams;
    config.min_length_um = least_wall_length_um;
    return config;
}

/* The mean of all scans as one. */
std::unique_ptr<ale_scan_t> mean_scan(const Recording &recording, const std::vector<Beam> &beams)
{
    auto scan = std::make_unique<ale_scan_t>(*recording.geometry);
    for (size_t k = 0; k < beams.size(); k++) {
        scan->range_um[k] = static_cast<int32_t>(std::lround(beams[k].mean * 1e6));
        scan->flag[k] = beams[k].usable ? ALE_BEAM_VALID : ALE_BEAM_UNKNOWN;
        if (!beams[k].usable) {
            scan->range_um[k] = 0;
        }
    }
    return scan;
}

std::vector<Wall> find_walls(const Recording &recording, const std::vector<Beam> &beams)
{
    const std::unique_ptr<ale_extractor_t, FreeMemory> extractor(
        static_cast<ale_extractor_t *>(std::calloc(1, ale_extractor_size())));
    const ale_extract_config_t config = tolerant_config();
    if (!extractor || ale_extractor_init(extractor.get(), &config) < 0) {
        throw std::runtime_error("the extractor cannot be set up");
    }
    const auto features = std::make_unique<ale_features_t>();
    ale_extract_scan(extractor.get(), mean_scan(recording, beams).get(), nullptr, features.get());
    std::vector<Wall> walls;
    for (int k = 0; k < features->line_count; k++) {
        const ale_line_t &line = features->line[k];
        Wall wall;
        wall.first = line.first + end_margin;
        wall.last = line.last - end_margin;
        wall.alpha = line.alpha_bam * radians_per_bam;
        wall.rho = line.rho_um * 1e-6;
        walls.push_back(wall);
    }
    return walls;
}

/* A wall with the residuals of its fit and all that their covariance depends on. */
struct WallFit {
    std::vector<int> beams;
    VectorXd mean;     /* ranges */
    MatrixXd jacobian; /* of the ranges: alpha, rho, bias */
    VectorXd residual; /* after the unweighted fit of all three */
    MatrixXd basis;    /* orthonormal, of the jacobian's columns */
};

VectorXd predicted_ranges(const Wall &wall, const Recording &recording, const std::vector<int> &beams)
{
    VectorXd ranges(static_cast<Index>(beams.size()));
    for (Index k = 0; k < ranges.size(); k++) {
        ranges(k) =
            wall.rho / std::cos(recording.bearing(beams[static_cast<size_t>(k)]) - wall.alpha) + wall.bias;
    }
    return ranges;
}

MatrixXd range_jacobian(const Wall &wall, const Recording &recording, const std::vector<int> &beams)
{
    MatrixXd jacobian(static_cast<Index>(beams.size()), 3);
    for (Index k = 0; k < jacobian.rows(); k++) {
        const double turned = recording.bearing(beams[static_cast<size_t>(k)]) - wall.alpha;
        const double c = std::cos(turned);
        jacobian.row(k) << -wall.rho * std::sin(turned) / (c * c), 1 / c, 1;
    }
    return jacobian;
}

/* The beams of a wall, without those that something in front takes. */
WallFit points_of(const Wall &wall, const Recording &recording, const std::vector<Beam> &beams)
{
    WallFit fit;
    std::vector<double> ranges;
    for (int k = wall.first; k <= wall.last; k++) {
        const Beam &beam = beams[static_cast<size_t>(k)];
        const double distance = beam.mean * std::cos(recording.bearing(k) - wall.alpha) - wall.rho;
        if (beam.usable && std::abs(distance) < in_front) {
            fit.beams.push_back(k);
            ranges.push_back(beam.mean);
        }
    }
    fit.mean = Eigen::Map<VectorXd>(ranges.data(), static_cast<Index>(ranges.size()));
    return fit;
}

/* Gauss and Newton; the model is nearly linear over what is left to correct. */
void adjust(Wall &wall, WallFit &fit, const Recording &recording, const MatrixXd &weight)
{
    for (int pass = 0; pass < 4; pass++) {
        fit.jacobian = range_jacobian(wall, recording, fit.beams);
        const VectorXd error = fit.mean - predicted_ranges(wall, recording, fit.beams);
        const MatrixXd left = fit.jacobian.transpose() * weight;
        const Eigen::Vector3d step = (left * fit.jacobian).ldlt().solve(left * error);
        wall.alpha += step(0);
        wall.rho += step(1);
        wall.bias += step(2);
    }
    fit.residual = fit.mean - predicted_ranges(wall, recording, fit.beams);
    fit.basis = MatrixXd(Eigen::HouseholderQR<MatrixXd>(fit.jacobian).householderQ() *
                         MatrixXd::Identity(fit.jacobian.rows(), 3));
}

struct FittedWall {
    Wall wall;
    WallFit fit;
};

/* The walls that the extractor finds, cut where they bend. */
std::vector<FittedWall> fitted_walls(const Recording &recording, const std::vector<Beam> &beams)
{
    std::vector<FittedWall> fitted;
    std::vector<Wall> waiting = find_walls(recording, beams);
    while (!waiting.empty()) {
        Wall wall = waiting.back();
        waiting.pop_back();
        WallFit fit = points_of(wall, recording, beams);
        const auto count = static_cast<Index>(fit.beams.size());
        if (count < least_wall_beams) {
            continue;
        }
        const Wall found = wall;
        adjust(wall, fit, recording, MatrixXd::Identity(count, count));
        if (const auto bend = bend_of(fit.jacobian, fit.residual, least_wall_beams / 2)) {
            const int corner = fit.beams[static_cast<size_t>(*bend)];
            Wall before = found;
            Wall after = found;
            before.last = corner - end_margin;
            after.first = corner + end_margin;
            waiting.insert(waiting.end(), {before, after});
        } else {
            fitted.push_back({wall, std::move(fit)});
        }
    }
    return fitted;
}

/* P S P for the projector P = 1 - Q Q'. */
MatrixXd projected(const MatrixXd &s, const MatrixXd &q)
{
    const MatrixXd sq = s * q;
    return s - q * sq.transpose() - sq * q.transpose() + q * (q.transpose() * sq) * q.transpose();
}

/* Sums of the products at each lag of beams. */
VectorXd by_lag(const MatrixXd &products, const std::vector<int> &beams)
{
    VectorXd sums = VectorXd::Zero(longest_lag + 1);
    for (Index i = 0; i < products.rows(); i++) {
        for (Index j = i; j < products.cols(); j++) {
            const int lag = beams[static_cast<size_t>(j)] - beams[static_cast<size_t>(i)];
            if (lag > longest_lag) {
                break;
            }
            sums(lag) += products(i, j);
        }
    }
    return sums;
}

MatrixXd alike(const std::vector<int> &beams, double length)
{
    const auto n = static_cast<Index>(beams.size());
    MatrixXd r(n, n);
    for (Index i = 0; i < n; i++) {
        for (Index j = 0; j < n; j++) {
            r(i, j) =
                std::exp(-std::abs(beams[static_cast<size_t>(i)] - beams[static_cast<size_t>(j)]) / length);
        }
    }
    return r;
}

/* Covariance that the changing errors leave in the mean of all scans. */
MatrixXd covariance_of_mean(const WallFit &fit, const std::vector<Beam> &beams, const TemporalFit &temporal,
                            int scans)
{
    MatrixXd s = alike(fit.beams, temporal.length);
    for (Index i = 0; i < s.rows(); i++) {
        for (Index j = 0; j < s.cols(); j++) {
            s(i, j) *= temporal.shared_between(fit.mean(i), fit.mean(j));
        }
        s(i, i) += temporal.own_of(beams[static_cast<size_t>(fit.beams[static_cast<size_t>(i)])]);
    }
    return s / scans;
}

MatrixXd lasting_covariance(const WallFit &fit, const LastingFit &lasting)
{
    const MatrixXd r = alike(fit.beams, lasting.length);
    const MatrixXd scaled = fit.mean.asDiagonal() * r * fit.mean.asDiagonal();
    return lasting.own * MatrixXd::Identity(r.rows(), r.cols()) + lasting.shared * r +
           lasting.shared_relative * scaled;
}

/* Solves for the variances at a given length; returns the error that is left. */
double solve(const std::vector<WallFit> &fits, const std::vector<VectorXd> &known, double length,
             LastingFit &out)
{
    const auto rows = static_cast<Index>(fits.size()) * (longest_lag + 1);
    MatrixXd a(rows, 3);
    VectorXd b(rows);
    for (size_t w = 0; w < fits.size(); w++) {
        const WallFit &fit = fits[w];
        const Index row = static_cast<Index>(w) * (longest_lag + 1);
        const MatrixXd r = alike(fit.beams, length);
        const MatrixXd scaled = fit.mean.asDiagonal() * r * fit.mean.asDiagonal();
        a.block(row, 0, longest_lag + 1, 3)
            << by_lag(projected(MatrixXd::Identity(r.rows(), r.cols()), fit.basis), fit.beams),
            by_lag(projected(r, fit.basis), fit.beams), by_lag(projected(scaled, fit.basis), fit.beams);
        b.segment(row, longest_lag + 1) =
            by_lag(fit.residual * fit.residual.transpose(), fit.beams) - known[w];
    }
    const VectorXd x = non_negative_solution(a, b);
    out.own = x(0);
    out.shared = x(1);
    out.shared_relative = x(2);
    out.length = length;
    return (a * x - b).squaredNorm();
}

/* Variance of the biases beyond what their own uncertainty explains, each weighted by what it tells. */
void fit_surface(LastingFit &lasting)
{
    for (int pass = 0; pass < 30; pass++) {
        double squares = 0;
        double owns = 0;
        double weights = 0;
        for (const Wall &wall : lasting.walls) {
            const double own = wall.bias_sigma * wall.bias_sigma;
            const double weight = 1 / std::pow(own + lasting.surface, 2);
            squares += weight * wall.bias * wall.bias;
            owns += weight * own;
            weights += weight;
        }
        lasting.surface = std::max(0.0, (squares - owns) / weights);
        lasting.bias_variance = owns / weights;
    }
}

} // namespace

LastingFit fit_lasting(const Recording &recording, const std::vector<Beam> &beams,
                       const TemporalFit &temporal)
{
    LastingFit lasting;
    std::vector<WallFit> fits;
    std::vector<VectorXd> known;
    for (auto &[wall, fit] : fitted_walls(recording, beams)) {
        known.push_back(by_lag(
            projected(covariance_of_mean(fit, beams, temporal, recording.scans()), fit.basis), fit.beams));
        fits.push_back(std::move(fit));
        lasting.walls.push_back(wall);
    }
    if (fits.empty()) {
        return lasting;
    }
    const auto error_at = [&](double log_length) {
        return solve(fits, known, std::exp(log_length), lasting);
    };
    const double best = least_place(std::log(shortest_length), std::log(longest_length), 10, error_at);
    solve(fits, known, std::exp(best), lasting);
    for (size_t w = 0; w < fits.size(); w++) {
        Wall &wall = lasting.walls[w];
        const MatrixXd covariance = covariance_of_mean(fits[w], beams, temporal, recording.scans()) +
                                    lasting_covariance(fits[w], lasting);
        const MatrixXd weight = covariance.inverse();
        adjust(wall, fits[w], recording, weight);
        const MatrixXd information = fits[w].jacobian.transpose() * weight * fits[w].jacobian;
        wall.bias_sigma = std::sqrt(information.inverse()(2, 2));
    }
    fit_surface(lasting);
    return lasting;
}

} // namespace calibrate
