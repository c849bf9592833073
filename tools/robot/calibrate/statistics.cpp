#include "robot/calibrate/statistics.h"

#include <algorithm>
#include <cmath>
#include <Eigen/Cholesky>
#include <limits>
#include <vector>

namespace calibrate
{

namespace
{

double median_of(std::vector<double> values)
{
    if (values.empty()) {
        return std::numeric_limits<double>::quiet_NaN();
    }
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

} // namespace

Spread robust_spread(const Eigen::Ref<const Eigen::VectorXd> &values)
{
    std::vector<double> there;
    for (const double v : values) {
        if (!std::isnan(v)) {
            there.push_back(v);
        }
    }
    Spread spread;
    spread.count = static_cast<int>(there.size());
    spread.median = median_of(there);
    for (double &v : there) {
        v = std::abs(v - spread.median);
    }
    spread.sigma = 1.4826 * median_of(there);
    return spread;
}

namespace
{

/* The unconstrained solution over the columns whose bit is set; others 0. */
Eigen::VectorXd solution_over(const Eigen::MatrixXd &square, const Eigen::VectorXd &right, unsigned columns)
{
    std::vector<Eigen::Index> chosen;
    for (Eigen::Index k = 0; k < right.size(); k++) {
        if (columns >> k & 1u) {
            chosen.push_back(k);
        }
    }
    Eigen::VectorXd x = Eigen::VectorXd::Zero(right.size());
    if (chosen.empty()) {
        return x;
    }
    const Eigen::MatrixXd part = square(chosen, chosen);
    const Eigen::VectorXd scale = part.diagonal().cwiseSqrt().cwiseMax(1e-300).cwiseInverse();
    const Eigen::MatrixXd scaled = scale.asDiagonal() * part * scale.asDiagonal();
    const Eigen::VectorXd y = scaled.ldlt().solve(scale.cwiseProduct(right(chosen)));
    for (size_t k = 0; k < chosen.size(); k++) {
        x(chosen[k]) = y(static_cast<Eigen::Index>(k)) * scale(static_cast<Eigen::Index>(k));
    }
    return x;
}

} // namespace

Eigen::VectorXd non_negative_solution(const Eigen::MatrixXd &a, const Eigen::VectorXd &b)
{
    const Eigen::MatrixXd square = a.transpose() * a;
    const Eigen::VectorXd right = a.transpose() * b;
    Eigen::VectorXd best = Eigen::VectorXd::Zero(a.cols());
    double least = 0; /* of x' A x - 2 r' x, the part of the error that depends on x */
    for (unsigned columns = 1; columns < 1u << a.cols(); columns++) {
        const Eigen::VectorXd x = solution_over(square, right, columns);
        const double error = x.dot(square * x) - 2 * right.dot(x);
        if (x.allFinite() && x.minCoeff() >= 0 && error < least) {
            least = error;
            best = x;
        }
    }
    return best;
}

} // namespace calibrate
