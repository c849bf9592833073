#include "robot/calibrate/rest.h"

#include <algorithm>
#include <cmath>
#include <Eigen/Cholesky>
#include <stdexcept>

#include "common/export/formatted.h"
#include "robot/calibrate/statistics.h"

namespace calibrate
{

namespace
{

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr Index least_block = least_scans / 2;
constexpr Index most_blocks = 20;
constexpr double least_sigma = 0.0005; /* metres: what rounding to millimetres does */
constexpr double most_of_noise =
    0.5; /* that motion may add to the ranges: their variance then grows by a quarter */
constexpr double noticeable = 0.03; /* metres */
constexpr double noticeable_sigmas = 4;
constexpr double most_changed = 0.2; /* of the beams */

/* One sigma from scan to scan. */
double successive_sigma(const Eigen::Ref<const VectorXd> &ranges)
{
    const VectorXd differences = ranges.tail(ranges.size() - 1) - ranges.head(ranges.size() - 1);
    const Spread spread = robust_spread(differences);
    return spread.count > 0 ? std::max(spread.sigma / std::sqrt(2.0), least_sigma) : least_sigma;
}

/* Scans of a recording, some at a time. */
struct Blocks {
    MatrixXd median; /* by block and beam; not a number where fewer than half of the scans have the beam */
    Index scans;     /* of a block; the last one may have more */

    double middle_s(const Recording &recording, Index block) const
    {
        return recording.time_s[static_cast<size_t>(block * scans + scans / 2)] - recording.time_s.front();
    }
};

Blocks blocks_of(const Recording &recording)
{
    const Index all = recording.range.rows();
    const Index scans = std::max(least_block, (all + most_blocks - 1) / most_blocks);
    Blocks blocks{MatrixXd(all / scans, recording.range.cols()), scans};
    for (Index block = 0; block < blocks.median.rows(); block++) {
        for (Index beam = 0; beam < blocks.median.cols(); beam++) {
            const Spread spread = robust_spread(recording.range.col(beam).segment(block * scans, scans));
            blocks.median(block, beam) = 2 * spread.count >= scans ? spread.median : std::nan("");
        }
    }
    return blocks;
}

/* Of the beams that are there in this block and the first one, those whose range is another. */
double changed_share(const Blocks &blocks, Index block, const VectorXd &sigma)
{
    int compared = 0;
    int changed = 0;
    for (Index beam = 0; beam < sigma.size(); beam++) {
        const double change = std::abs(blocks.median(block, beam) - blocks.median(0, beam));
        compared += !std::isnan(change);
        changed += change > std::max(noticeable, noticeable_sigmas * sigma(beam));
    }
    return compared > 0 ? static_cast<double>(changed) / compared : 0;
}

/* The beams that tell of motion. */
struct Witnesses {
    std::vector<Index> beam;
    MatrixXd jacobian; /* of the range: x, y, theta of the scanner */
    VectorXd mean;
    VectorXd sigma;
};

Witnesses witnesses_of(const Recording &recording, const std::vector<Beam> &beams, const VectorXd &sigma)
{
    Witnesses w;
    for (size_t k = 0; k < beams.size(); k++) {
        if (beams[k].usable) {
            w.beam.push_back(static_cast<Index>(k));
        }
    }
    const auto count = static_cast<Index>(w.beam.size());
    w.jacobian.resize(count, 3);
    w.mean.resize(count);
    w.sigma.resize(count);
    for (Index row = 0; row < count; row++) {
        const Index k = w.beam[static_cast<size_t>(row)];
        const Beam &beam = beams[static_cast<size_t>(k)];
        const double c = std::cos(recording.bearing(static_cast<int>(k)));
        const double s = std::sin(recording.bearing(static_cast<int>(k)));
        const double slant = beam.slope / beam.mean;
        w.jacobian.row(row) << -slant * s - c, slant * c - s, beam.slope;
        w.mean(row) = beam.mean;
        w.sigma(row) = sigma(k);
    }
    return w;
}

/* Where the scanner stood in a block, from its mean place: x, y, theta; Cauchy's weights. */
Vector3d displacement(const Witnesses &w, const Blocks &blocks, Index block)
{
    constexpr double tuning = 2.385;
    constexpr double median_variance = 1.57; /* of a median, in those of a mean */
    constexpr int passes = 20;
    Vector3d moved = Vector3d::Zero();
    for (int pass = 0; pass < passes; pass++) {
        Eigen::Matrix3d information = 1e-9 * Eigen::Matrix3d::Identity();
        Vector3d gradient = Vector3d::Zero();
        for (Index row = 0; row < w.mean.size(); row++) {
            const double change = blocks.median(block, w.beam[static_cast<size_t>(row)]) - w.mean(row);
            if (std::isnan(change)) {
                continue;
            }
            const double variance =
                median_variance * w.sigma(row) * w.sigma(row) / static_cast<double>(blocks.scans) +
                least_sigma * least_sigma;
            const double left = change - w.jacobian.row(row).dot(moved);
            const double weight = 1 / (variance + left * left / (tuning * tuning));
            information += weight * w.jacobian.row(row).transpose() * w.jacobian.row(row);
            gradient += weight * change * w.jacobian.row(row).transpose();
        }
        moved = information.ldlt().solve(gradient);
    }
    return moved;
}

/* What a displacement does to the ranges, root mean square, in units of their noise. */
double part_of_noise(const Witnesses &w, const Vector3d &moved)
{
    return ((w.jacobian * moved).array() / w.sigma.array()).matrix().norm() /
           std::sqrt(static_cast<double>(w.mean.size()));
}

[[noreturn]] void refuse(const std::string &what)
{
    throw std::runtime_error("the scanner moves: " + what + "; a recording at rest is needed");
}

} // namespace

void require_rest(const Recording &recording, const std::vector<Beam> &beams)
{
    const Blocks blocks = blocks_of(recording);
    VectorXd sigma(recording.range.cols());
    for (Index beam = 0; beam < sigma.size(); beam++) {
        sigma(beam) = successive_sigma(recording.range.col(beam));
    }
    for (Index block = 1; block < blocks.median.rows(); block++) {
        const double share = changed_share(blocks, block, sigma);
        if (share > most_changed) {
            refuse(ale::formatted("%.0f %% of its beams measure other ranges after %.1f s than at the start",
                                  100 * share, blocks.middle_s(recording, block)));
        }
    }
    const Witnesses witnesses = witnesses_of(recording, beams, sigma);
    if (witnesses.beam.empty()) {
        return;
    }
    const Vector3d start = displacement(witnesses, blocks, 0);
    for (Index block = 1; block < blocks.median.rows(); block++) {
        const Vector3d moved = displacement(witnesses, blocks, block) - start;
        if (part_of_noise(witnesses, moved) > most_of_noise) {
            refuse(ale::formatted("after %.1f s it stands %.1f mm and %.2f degrees from where it began",
                                  blocks.middle_s(recording, block), 1e3 * moved.head<2>().norm(),
                                  std::abs(moved.z()) * 180 / M_PI));
        }
    }
}

} // namespace calibrate
