// Plain twin of the line fit: total least squares by the eigenvectors of the scatter matrix.
#ifndef ALE_TESTS_REFERENCE_TOTAL_LEAST_SQUARES_H
#define ALE_TESTS_REFERENCE_TOTAL_LEAST_SQUARES_H

#include <cmath>
#include <vector>

#include <Eigen/Eigenvalues>

namespace reference
{

struct line_fit {
    double alpha; // x cos(alpha) + y sin(alpha) = rho, rho >= 0
    double rho;
    double sse;        // squared distances from the line
    double along2;     // squared distances from the mean along the line
    double mean_along; // of the mean, along (-sin alpha, cos alpha)
};

inline line_fit total_least_squares(const std::vector<Eigen::Vector2d> &points)
{
    Eigen::Vector2d mean = Eigen::Vector2d::Zero();
    for (const auto &p : points) {
        mean += p / static_cast<double>(points.size());
    }
    Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
    for (const auto &p : points) {
        scatter += (p - mean) * (p - mean).transpose();
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(scatter);
    Eigen::Vector2d normal = solver.eigenvectors().col(0);
    if (normal.dot(mean) < 0) {
        normal = -normal;
    }
    const Eigen::Vector2d along(-normal.y(), normal.x());
    return {std::atan2(normal.y(), normal.x()), normal.dot(mean), solver.eigenvalues()(0),
            solver.eigenvalues()(1), along.dot(mean)};
}

} // namespace reference

#endif
