#include "reference/scan_noise.h"

#include <algorithm>
#include <iterator>
#include <map>

#include <Eigen/Dense>

#include "reference/run_fit.h"

namespace reference
{
namespace
{

constexpr size_t least_samples = 20;    // of an octave
constexpr double most_misfit = 16;      // variances that an octave's own one may be
constexpr double clutter_factor = 2;    // beyond what the model allows beside a better known octave
constexpr size_t difference_stride = 3; // neighbouring differences share two of three points
constexpr int widest_gap = 8;           // beams to the next point of a surface
constexpr double difference_share = 0.75;
constexpr double counts_per_mm = 16000; // the bins count sixteenths of a micrometre
constexpr double least_sigma = 0.4;     // mm
constexpr double most_sigma = 100;
const double quartile_of_difference = 1.1503 * std::sqrt(6); // of |d| for a deviation of 1
constexpr double quartile_of_chi_square = 1.323;             // of one degree of freedom

constexpr int block = 8; // beams
constexpr int stride = 6;
constexpr size_t least_blocks = 12;
constexpr double shared_gain = 299.0 / 256; // of three block means, for an error correlated over 12 beams
constexpr double held_ratio = 8;            // what a ratio counts at most in the mean
constexpr double plain_mean = 480.0 / 256;  // own noise alone gives up to this
constexpr double least_scale = 3;
constexpr double least_stated = 2;
constexpr double most_scale = 4;
constexpr double least_remainder = 0.25; // where there is none

double bin_edge(int bin)
{
    return (4 + bin % 4) * std::ldexp(1.0, bin / 4) - 4;
}

struct Octave {
    std::vector<double> difference; // in units of the bins
    double range = 0;               // mm, sum
};

// Every third point that has two neighbours, counted from both ends to the middle.
std::vector<size_t> every_third(size_t points)
{
    std::vector<size_t> chosen;
    for (size_t i = 1; 2 * i + 1 <= points; i += difference_stride) {
        chosen.push_back(i);
        if (points - 1 - i != i) {
            chosen.push_back(points - 1 - i);
        }
    }
    return chosen;
}

// In a sparse scan every point, whatever its neighbours.
std::vector<size_t> chosen_points(const ScanPoints &points)
{
    if (!is_sparse(points)) {
        return every_third(points.size());
    }
    std::vector<size_t> all;
    for (size_t i = 1; i + 1 < points.size(); i++) {
        all.push_back(i);
    }
    return all;
}

std::map<int, Octave> octaves_of(const ScanPoints &points, double step)
{
    std::map<int, Octave> octaves;
    const int reach = is_sparse(points) ? widest_gap : 1;
    for (const size_t i : chosen_points(points)) {
        const int left = points[i].beam - points[i - 1].beam;
        const int right = points[i + 1].beam - points[i].beam;
        if (std::max(left, right) <= reach) {
            // 1/range of a wall is a sine of the bearing: the middle one follows from its neighbours
            const double q = 1 / points[i].range;
            const double from_neighbours =
                (std::sin(right * step) / points[i - 1].range + std::sin(left * step) / points[i + 1].range) /
                std::sin((left + right) * step);
            const double d = 2 * std::cos((left + right) * step / 2) * (from_neighbours - q);
            Octave &octave = octaves[std::ilogb(points[i].range * 1000)];
            octave.difference.push_back(std::fabs(d) / q * points[i].range * counts_per_mm);
            octave.range += points[i].range;
        }
    }
    return octaves;
}

// Range in the middle of three blocks.
double middle_range(const ScanPoints &points, size_t start)
{
    const size_t middle = start + 3 * block / 2;
    return (points[middle - 1].range + points[middle].range) / 2;
}

// Second difference of three neighbouring blocks of 1/range, squared, over what own noise makes of it.
double block_ratio(const ScanPoints &points, const NoiseOfScan &noise, size_t start, double step)
{
    double sum[3] = {0, 0, 0};
    for (size_t i = 0; i < 3 * block; i++) {
        sum[i / block] += 1 / points[start + i].range;
    }
    const double d = sum[0] + sum[2] - 2 * sum[1] * std::cos(step * block);
    const double range = middle_range(points, start);
    const double difference = d / sum[1] * range;
    return difference * difference / (noise.own(range) * 6 / block);
}

struct VarianceAtRange {
    double samples;
    double range2;
    double variance;
};

// Without the octaves that have more noise than a range may have beside the noise of the best known one: it
// does not fall with the range, nor rise faster than it.
std::vector<VarianceAtRange> without_clutter(const std::vector<VarianceAtRange> &all)
{
    const VarianceAtRange best =
        *std::max_element(all.begin(), all.end(), [](const VarianceAtRange &a, const VarianceAtRange &b) {
            return a.samples < b.samples;
        });
    std::vector<VarianceAtRange> kept;
    std::copy_if(all.begin(), all.end(), std::back_inserter(kept), [&best](const VarianceAtRange &octave) {
        const double rise = std::max(octave.range2 / best.range2, 1.0);
        return octave.samples >= best.samples ||
               octave.variance <= clutter_factor * clutter_factor * best.variance * rise;
    });
    return kept;
}

// Least squares of the misfits, each in its unit, weighted by the samples; where one of the two parts would
// be negative, or the ranges do not tell them apart, the other alone.
Eigen::Vector2d noise_model(const std::vector<VarianceAtRange> &measured, const std::vector<double> &unit)
{
    Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
    Eigen::Vector2d right = Eigen::Vector2d::Zero();
    for (size_t k = 0; k < measured.size(); k++) {
        const Eigen::Vector2d row = Eigen::Vector2d(1, measured[k].range2) / unit[k];
        normal += measured[k].samples * row * row.transpose();
        right += measured[k].samples * row * std::min(measured[k].variance / unit[k], most_misfit);
    }
    const Eigen::Vector2d constant(right(0) / normal(0, 0), 0);
    if (normal.determinant() <= normal(0, 0) * normal(1, 1) / 64) {
        return constant;
    }
    const Eigen::Vector2d both = normal.inverse() * right;
    return both(0) < 0 ? Eigen::Vector2d(0, right(1) / normal(1, 1)) : both(1) < 0 ? constant : both;
}

} // namespace

double binned_quantile(const std::vector<double> &values, double share)
{
    std::map<int, int> bins;
    for (const double v : values) {
        int bin = 0;
        while (bin_edge(bin + 1) <= v) {
            bin++;
        }
        bins[bin]++;
    }
    const double wanted = share * static_cast<double>(values.size());
    double below = 0;
    for (const auto &[bin, count] : bins) {
        if (below + count >= wanted) {
            return bin_edge(bin) + (bin_edge(bin + 1) - bin_edge(bin)) * (wanted - below) / count;
        }
        below += count;
    }
    return 0;
}

// sigma^2 = a + b r^2 over the octaves; where there is none the prior.
NoiseOfScan own_noise(const ScanPoints &points, const NoiseOfScan &prior, double step)
{
    NoiseOfScan noise = prior;
    std::vector<VarianceAtRange> all;
    for (const auto &[number, octave] : octaves_of(points, step)) {
        const auto n = static_cast<double>(octave.difference.size());
        if (octave.difference.size() >= least_samples) {
            const double quartile = binned_quantile(octave.difference, difference_share) / counts_per_mm;
            const double sigma = std::clamp(quartile / quartile_of_difference, least_sigma, most_sigma);
            const double range = octave.range / n;
            all.push_back({n, range * range, sigma * sigma});
        }
    }
    if (all.empty()) {
        return noise;
    }
    const std::vector<VarianceAtRange> measured = without_clutter(all);
    std::vector<double> unit;
    for (const VarianceAtRange &octave : measured) {
        unit.push_back(octave.variance);
    }
    const Eigen::Vector2d first = noise_model(measured, unit);
    for (size_t k = 0; k < unit.size(); k++) {
        unit[k] = first(0) + first(1) * measured[k].range2;
    }
    const Eigen::Vector2d model = noise_model(measured, unit);
    noise.own_constant = model(0);
    noise.own_relative = model(1);
    return noise;
}

SharedNoise shared_noise(const ScanPoints &points, const NoiseOfScan &noise, const std::vector<Run> &runs,
                         double step, Decisions &decisions)
{
    std::vector<double> ratio;
    double range = 0;
    for (const Run &run : runs) {
        const int windows = run.points() - 3 * block + 1;
        for (int o = 0; 2 * o < windows; o += stride) {
            std::vector<int> starts = {run.first + o};
            if (2 * o + 1 < windows) {
                starts.push_back(run.first + windows - 1 - o); // the same from the other end
            }
            for (const int start : starts) {
                const auto from = static_cast<size_t>(start);
                if (points[from + 3 * block - 1].beam - points[from].beam == 3 * block - 1) {
                    ratio.push_back(256 * block_ratio(points, noise, from, step));
                    range += middle_range(points, from);
                }
            }
        }
    }
    if (ratio.size() < least_blocks) {
        return {1, 1, false};
    }
    range /= static_cast<double>(ratio.size());
    double mean = 0;
    for (const double r : ratio) {
        mean += std::min(r / 256, held_ratio) / static_cast<double>(ratio.size());
    }
    if (decisions.below(mean, plain_mean)) {
        return {std::clamp(1 - 2 * (plain_mean - mean), least_remainder, 1.0), 1, true};
    }
    const double quartile = binned_quantile(ratio, 0.75) / 256 / quartile_of_chi_square;
    const double shared = (quartile - 1) * noise.own(range) * 6 / block / shared_gain;
    const double scale = shared / noise.shared(range);
    return {std::clamp(scale, least_scale, most_scale), std::clamp(scale, least_stated, most_scale), false};
}

double own_scale(const ScanPoints &points, const NoiseOfScan &noise, const std::vector<Run> &runs,
                 Decisions &decisions)
{
    double chi = 100; // the second differences count like a hundred points
    double freedom = 100;
    for (const Run &run : runs) {
        const RunFit fit = fit_run(points, noise, run.first, run.last);
        if (fit.n >= 20 && decisions.below(fit.chi(), chi_limit(fit.n, chi_high_z))) {
            chi += fit.chi() * noise.own_scale;
            freedom += fit.n - 2;
        }
    }
    return std::clamp(chi / freedom, 180.0 / 256, 360.0 / 256);
}

} // namespace reference
