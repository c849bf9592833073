#include "robot/calibrate/temporal.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "robot/calibrate/statistics.h"

namespace calibrate
{

namespace
{

constexpr double stray_sigmas = 5;
constexpr double least_sigma = 0.0005; /* quantised values may have no spread at all */
constexpr double jump = 0.06;  /* between neighbours of one surface, beyond what the slope foretells */
constexpr int edge_margin = 2; /* beams beside a depth edge see both sides */
constexpr int least_usable_beams = 40;
constexpr double shortest_length = 1;
constexpr double longest_length = 80;

double value_limit(const Beam &beam)
{
    return stray_sigmas * std::max(beam.sigma, least_sigma);
}

double mean_without_strays(const Eigen::Ref<const Eigen::VectorXd> &values, const Beam &beam)
{
    double sum = 0;
    int count = 0;
    for (const double v : values) {
        if (std::abs(v - beam.mean) <= value_limit(beam)) {
            sum += v;
            count++;
        }
    }
    return count > 0 ? sum / count : beam.mean;
}

/* On a straight wall the range changes from beam to beam by nearly the same amount. */
bool surface_ends(const std::vector<Beam> &beams, size_t k)
{
    if (!beams[k].seen || !beams[k + 1].seen) {
        return true;
    }
    const auto change = [&](size_t from) { return beams[from + 1].mean - beams[from].mean; };
    double closest = std::abs(change(k));
    if (k > 0 && beams[k - 1].seen) {
        closest = std::min(closest, std::abs(change(k) - change(k - 1)));
    }
    if (k + 2 < beams.size() && beams[k + 2].seen) {
        closest = std::min(closest, std::abs(change(k) - change(k + 1)));
    }
    return closest > jump;
}

void number_surfaces(std::vector<Beam> &beams)
{
    int surface = 0;
    for (size_t k = 0; k < beams.size(); k++) {
        beams[k].surface = surface;
        if (k + 1 < beams.size() && surface_ends(beams, k)) {
            surface++;
        }
    }
}

/* Slope of the mean by a straight fit over five beams of the surface. */
double slope_at(const std::vector<Beam> &beams, size_t k, double step)
{
    double rise = 0;
    double run = 0;
    for (int offset = 1; offset <= 2; offset++) {
        const auto o = static_cast<size_t>(offset);
        rise += offset * (beams[k + o].mean - beams[k - o].mean);
        run += 2.0 * offset * offset;
    }
    return rise / (run * step);
}

void choose_usable(std::vector<Beam> &beams, double step)
{
    constexpr auto margin = static_cast<size_t>(edge_margin);
    for (size_t k = margin; k + margin < beams.size(); k++) {
        const bool inside =
            beams[k - margin].surface == beams[k].surface && beams[k + margin].surface == beams[k].surface;
        beams[k].usable = beams[k].seen && inside;
        if (beams[k].usable) {
            beams[k].slope = slope_at(beams, k, step);
        }
    }
}

/* Deviations from the mean; what is missing or stray is 0 and not counted. */
struct Deviations {
    Eigen::MatrixXd value;
    Eigen::MatrixXd there;
};

Deviations deviations_of(const Recording &recording, const std::vector<Beam> &beams)
{
    Deviations d{Eigen::MatrixXd::Zero(recording.range.rows(), recording.range.cols()),
                 Eigen::MatrixXd::Zero(recording.range.rows(), recording.range.cols())};
    for (Eigen::Index beam = 0; beam < recording.range.cols(); beam++) {
        const Beam &b = beams[static_cast<size_t>(beam)];
        if (!b.usable) {
            continue;
        }
        for (Eigen::Index scan = 0; scan < recording.range.rows(); scan++) {
            const double deviation = recording.range(scan, beam) - b.mean;
            if (std::abs(deviation) <= value_limit(b)) {
                d.value(scan, beam) = deviation;
                d.there(scan, beam) = 1;
            }
        }
    }
    return d;
}

/* One equation of the fit: the model's coefficients of own, own_relative, bearing, shared, shared_relative.
 */
Eigen::RowVectorXd coefficients(const std::vector<Beam> &beams, const Product &p, double length)
{
    const Beam &a = beams[static_cast<size_t>(p.beam)];
    const Beam &b = beams[static_cast<size_t>(p.beam) + static_cast<size_t>(p.lag)];
    const double alike = std::exp(-p.lag / length);
    Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(5);
    if (p.lag == 0) {
        row.head(3) << 1, a.mean * a.mean, a.slope * a.slope;
    }
    row.tail(2) << alike, alike * a.mean * b.mean;
    return row;
}

double model_variance(const TemporalFit &fit, const Beam &beam)
{
    return fit.own_of(beam) + fit.shared_between(beam.mean, beam.mean);
}

/* Standard deviation of a mean product of two normal deviations. */
double product_sigma(const TemporalFit &fit, const std::vector<Beam> &beams, const Product &p)
{
    const Beam &a = beams[static_cast<size_t>(p.beam)];
    const Beam &b = beams[static_cast<size_t>(p.beam) + static_cast<size_t>(p.lag)];
    double together = fit.shared_between(a.mean, b.mean) * std::exp(-p.lag / fit.length);
    if (p.lag == 0) {
        together = model_variance(fit, a);
    }
    const double variance = model_variance(fit, a) * model_variance(fit, b) + together * together;
    return std::sqrt(variance / p.count);
}

/* Solves for the variances at a given length; the weighted error is left in *error. */
TemporalFit solve(const std::vector<Beam> &beams, const std::vector<Product> &products,
                  const std::vector<double> &sigmas, double length, double *error)
{
    Eigen::MatrixXd a(static_cast<Eigen::Index>(products.size()), 5);
    Eigen::VectorXd b(a.rows());
    for (Eigen::Index k = 0; k < a.rows(); k++) {
        const auto p = static_cast<size_t>(k);
        a.row(k) = coefficients(beams, products[p], length) / sigmas[p];
        b(k) = products[p].mean / sigmas[p];
    }
    const Eigen::VectorXd x = non_negative_solution(a, b);
    *error = (a * x - b).squaredNorm();
    return {x(0), x(1), x(2), x(3), x(4), length};
}

TemporalFit refine(const std::vector<Beam> &beams, const std::vector<Product> &products,
                   const TemporalFit &before)
{
    std::vector<double> sigmas;
    sigmas.reserve(products.size());
    for (const Product &p : products) {
        sigmas.push_back(product_sigma(before, beams, p));
    }
    double error = 0;
    const auto error_at = [&](double log_length) {
        solve(beams, products, sigmas, std::exp(log_length), &error);
        return error;
    };
    const double best = least_place(std::log(shortest_length), std::log(longest_length), 12, error_at);
    return solve(beams, products, sigmas, std::exp(best), &error);
}

} // namespace

std::vector<Beam> beams_of(const Recording &recording)
{
    std::vector<Beam> beams(static_cast<size_t>(recording.beams()));
    for (Eigen::Index k = 0; k < recording.range.cols(); k++) {
        Beam &beam = beams[static_cast<size_t>(k)];
        const Spread spread = robust_spread(recording.range.col(k));
        beam.seen = 2 * spread.count >= recording.scans();
        beam.mean = spread.median;
        beam.sigma = spread.sigma;
        if (beam.seen) {
            beam.mean = mean_without_strays(recording.range.col(k), beam);
        }
    }
    number_surfaces(beams);
    choose_usable(beams, recording.step);
    return beams;
}

std::vector<Product> deviation_products(const Recording &recording, const std::vector<Beam> &beams)
{
    const Deviations d = deviations_of(recording, beams);
    std::vector<Product> products;
    for (int k = 0; k < recording.beams(); k++) {
        for (int lag = 0; lag <= longest_lag && k + lag < recording.beams(); lag++) {
            const Beam &a = beams[static_cast<size_t>(k)];
            const Beam &b = beams[static_cast<size_t>(k) + static_cast<size_t>(lag)];
            if (!a.usable || !b.usable || a.surface != b.surface) {
                continue;
            }
            const int count = static_cast<int>(d.there.col(k).dot(d.there.col(k + lag)));
            if (count >= least_scans / 2) {
                /* The mean was taken from the same scans: one degree of freedom. */
                products.push_back({k, lag, d.value.col(k).dot(d.value.col(k + lag)) / (count - 1), count});
            }
        }
    }
    return products;
}

TemporalFit fit_temporal(const std::vector<Beam> &beams, const std::vector<Product> &products)
{
    const auto usable = std::count_if(beams.begin(), beams.end(), [](const Beam &b) { return b.usable; });
    if (usable < least_usable_beams) {
        throw std::runtime_error("only " + std::to_string(usable) +
                                 " beams see a surface steadily, at least " +
                                 std::to_string(least_usable_beams) + " are needed");
    }
    TemporalFit fit;
    double variance = 0;
    for (const Beam &b : beams) {
        variance += b.usable ? b.sigma * b.sigma / static_cast<double>(usable) : 0;
    }
    fit.own = fit.shared = std::max(variance / 2, least_sigma * least_sigma);
    for (int pass = 0; pass < 3; pass++) {
        fit = refine(beams, products, fit);
        fit.own = std::max(fit.own, 1e-10); /* keeps the weights of the next pass finite */
    }
    return fit;
}

} // namespace calibrate
