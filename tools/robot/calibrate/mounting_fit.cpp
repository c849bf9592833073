#include "robot/calibrate/mounting_fit.h"

#include <algorithm>
#include <cmath>
#include <Eigen/Cholesky>
#include <stdexcept>

#include "robot/calibrate/pieces.h"

namespace mounting
{

namespace
{

/* The unknowns as they enter, see the header; last the lag. */
enum { A, B, U, V, TURN, BIAS, SHIFT, UNKNOWNS };
using Unknowns = Eigen::Matrix<double, UNKNOWNS, 1>;
using Square = Eigen::Matrix<double, UNKNOWNS, UNKNOWNS>;

constexpr int kinds = 3; /* of residuals: forward, left, turn */
constexpr size_t least_pieces = 20;
constexpr int iterations = 30;
constexpr double step = 0.005;       /* seconds, for the derivative by the lag */
constexpr double most_change = 0.05; /* seconds that the lag moves at once */
constexpr double lag_low = -0.1;     /* what the firmware takes */
constexpr double lag_high = 0.3;
constexpr double slow_scans = 0.35; /* seconds between scans, beyond which motion between them is not known */

/* How badly an unknown can be known before the drive: what it does not determine keeps this. */
const Unknowns prior_sigma = (Unknowns() << 1, 1, 2, 2, 1, 1, 0.08).finished();
/* Below these the drive determines a quantity. */
constexpr std::array<double, QUANTITIES> worth = {0.03, 0.03, 0.02, 0.015, 0.02, 0.02, 0.02};

struct Row {
    Eigen::Vector3d counted;
    Eigen::Vector3d residual;
    Eigen::Matrix<double, kinds, UNKNOWNS> jacobian;
    double weight = 1.0 / overlap;
};

Eigen::Matrix<double, kinds, UNKNOWNS> model(const Seen &s, double counted_forward)
{
    Eigen::Matrix<double, kinds, UNKNOWNS> j = Eigen::Matrix<double, kinds, UNKNOWNS>::Zero();
    j.row(0) << s.way.x(), -s.way.y(), 0, s.lever, 0, 0, 0;
    j.row(1) << s.way.y(), s.way.x(), -s.lever, 0, 0, 0, 0;
    j.row(2) << 0, 0, 0, 0, s.turn, counted_forward, 0;
    return j;
}

std::vector<Row> rows_at(const Drive &drive, const std::vector<Piece> &pieces, const Unknowns &p)
{
    std::vector<Row> rows;
    for (const Piece &piece : pieces) {
        const auto here = seen(drive, piece, p[SHIFT]);
        const auto before = seen(drive, piece, p[SHIFT] - step);
        const auto after = seen(drive, piece, p[SHIFT] + step);
        if (!here || !before || !after) {
            continue;
        }
        const double forward = piece.counted_way.x();
        Row row;
        row.counted << piece.counted_way, piece.counted_turn;
        row.jacobian = model(*here, forward);
        row.residual = row.counted - row.jacobian * p;
        row.jacobian.col(SHIFT) = (model(*after, forward) - model(*before, forward)) * p / (2 * step);
        rows.push_back(row);
    }
    return rows;
}

double median(std::vector<double> values)
{
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

/* Sigma of each kind of residual from its median size; floors: no drive is known better. */
Eigen::Vector3d spread(const std::vector<Row> &rows)
{
    const Eigen::Vector3d floor(2e-4, 2e-4, 2e-4);
    Eigen::Vector3d sigma;
    for (int kind = 0; kind < kinds; kind++) {
        std::vector<double> sizes;
        sizes.reserve(rows.size());
        for (const Row &row : rows) {
            sizes.push_back(std::fabs(row.residual[kind]));
        }
        sigma[kind] = std::max(1.4826 * median(std::move(sizes)), floor[kind]);
    }
    return sigma;
}

/* Cauchy's weights, of a piece as a whole: a wheel that slips spoils way and turn. */
void weigh(std::vector<Row> &rows, const Eigen::Vector3d &sigma)
{
    constexpr double tuning = 2.385;
    for (Row &row : rows) {
        const double squared = (row.residual.array() / sigma.array()).square().sum() / kinds;
        row.weight = 1 / (1 + squared / (tuning * tuning)) / overlap;
    }
}

struct Equations {
    Square information;
    Unknowns gradient;
};

Equations equations_of(const std::vector<Row> &rows, const Eigen::Vector3d &sigma, const Unknowns &p,
                       const Unknowns &prior, const Unknowns &sigma_before)
{
    Equations e;
    const Unknowns certainty = sigma_before.array().square().inverse();
    e.information = certainty.asDiagonal();
    e.gradient = certainty.array() * (prior - p).array();
    const Eigen::Vector3d per_variance = sigma.array().square().inverse();
    for (const Row &row : rows) {
        const auto weighted = (row.weight * row.jacobian.transpose() * per_variance.asDiagonal()).eval();
        e.information += weighted * row.jacobian;
        e.gradient += weighted * row.residual;
    }
    return e;
}

/* Covariance of the unknowns: that of least squares, and for each unknown no less than what the residuals of
 * neighbouring pieces, which are not independent, say themselves (Newey and West's estimate). */
Square covariance_of(const std::vector<Row> &rows, const Eigen::Vector3d &sigma, const Square &information)
{
    constexpr size_t reach = 2UL * overlap;
    const Eigen::Vector3d per_variance = sigma.array().square().inverse();
    std::vector<Unknowns> score;
    score.reserve(rows.size());
    for (const Row &row : rows) {
        score.emplace_back(row.weight * row.jacobian.transpose() * per_variance.asDiagonal() * row.residual);
    }
    Square scatter = Square::Zero();
    for (size_t k = 0; k < score.size(); k++) {
        scatter += score[k] * score[k].transpose();
        for (size_t apart = 1; apart <= reach && apart <= k; apart++) {
            const double part = 1 - static_cast<double>(apart) / (reach + 1);
            const Square cross = score[k] * score[k - apart].transpose();
            scatter += part * (cross + cross.transpose());
        }
    }
    const Square formal = information.ldlt().solve(Square::Identity());
    const Square found = formal * scatter * formal;
    const Unknowns stretch = (found.diagonal().array() / formal.diagonal().array()).max(1).sqrt();
    return stretch.asDiagonal() * formal * stretch.asDiagonal();
}

/* From the unknowns to what is asked, with the derivatives. */
Eigen::Matrix<double, QUANTITIES, 1> quantities(const Unknowns &p)
{
    const double g = std::hypot(p[A], p[B]);
    Eigen::Matrix<double, QUANTITIES, 1> q;
    q << p[U] / g, p[V] / g, std::atan2(p[B], p[A]), p[SHIFT], 1 / g, 1 / p[TURN], p[BIAS];
    return q;
}

Eigen::Matrix<double, QUANTITIES, UNKNOWNS> derivatives(const Unknowns &p)
{
    constexpr double small = 1e-6;
    Eigen::Matrix<double, QUANTITIES, UNKNOWNS> j;
    for (int k = 0; k < UNKNOWNS; k++) {
        const Unknowns delta = small * Unknowns::Unit(k);
        j.col(k) = (quantities(p + delta) - quantities(p - delta)) / (2 * small);
    }
    return j;
}

void refuse_wheels_that_turn_against_the_scans(const std::vector<Row> &rows)
{
    double with = 0;
    double square = 0;
    for (const Row &row : rows) {
        with += row.counted[2] * row.jacobian(2, TURN);
        square += std::fabs(row.counted[2] * row.jacobian(2, TURN));
    }
    if (with < -0.5 * square) {
        throw std::runtime_error(
            "the wheels turn against the scans: the scanner hangs upside down (sensor.reversed), "
            "or left and right wheel are exchanged");
    }
}

Fit result_of(const std::vector<Row> &rows, const Eigen::Vector3d &sigma, const Unknowns &p,
              const Square &information)
{
    Fit fit{};
    const auto values = quantities(p);
    const auto j = derivatives(p);
    const auto covariance = (j * covariance_of(rows, sigma, information) * j.transpose()).eval();
    for (int k = 0; k < QUANTITIES; k++) {
        const auto index = static_cast<size_t>(k);
        const double own = std::sqrt(covariance(k, k));
        fit.estimate[index] = {values[k], own, own < worth[index]};
    }
    fit.pieces = rows.size();
    for (const Row &row : rows) {
        fit.set_aside += row.weight * overlap < 0.5;
        fit.way += row.jacobian.block<1, 2>(0, 0).norm();
        fit.turned += std::fabs(row.jacobian(2, TURN));
    }
    fit.way /= overlap;
    fit.turned /= overlap;
    fit.way_error = sigma[0];
    fit.turn_error = sigma[2];
    return fit;
}

std::vector<Row> enough_rows(const Drive &drive, const std::vector<Piece> &pieces, const Unknowns &p)
{
    std::vector<Row> rows = rows_at(drive, pieces, p);
    if (rows.size() < least_pieces) {
        throw std::runtime_error("the drive is too short: " + std::to_string(rows.size()) +
                                 " pieces of 1.5 metres and radians that the scans saw, at least " +
                                 std::to_string(least_pieces) + " are needed");
    }
    return rows;
}

} // namespace

Fit fit(const Drive &drive)
{
    const std::vector<Piece> pieces = cut(drive);
    const bool slow = drive.laser.period() > slow_scans;
    Unknowns prior;
    prior << 1, 0, 0, 0, 1, 0, slow ? 0 : drive.lag;
    Unknowns sigma_before = prior_sigma;
    if (slow) {
        sigma_before[SHIFT] = 1e-6;
    }
    Unknowns p = prior;
    std::vector<Row> rows = enough_rows(drive, pieces, p);
    refuse_wheels_that_turn_against_the_scans(rows);
    Eigen::Vector3d sigma(0.01, 0.01, 0.01);
    Equations e;
    for (int k = 0; k < iterations; k++) {
        e = equations_of(rows, sigma, p, prior, sigma_before);
        Unknowns change = e.information.ldlt().solve(e.gradient);
        change[SHIFT] = std::clamp(change[SHIFT], -most_change, most_change);
        p += change;
        p[SHIFT] = std::clamp(p[SHIFT], lag_low, lag_high);
        rows = enough_rows(drive, pieces, p);
        sigma = spread(rows);
        weigh(rows, sigma);
    }
    Fit result = result_of(rows, sigma, p, e.information);
    if (slow) {
        result.estimate[LAG] = {0, prior_sigma[SHIFT], false};
    }
    return result;
}

} // namespace mounting
