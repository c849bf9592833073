// Where two lines in normal form meet, and how sure that is: in double, by Eigen. Twin of
// lib/extract/corner.c.
#ifndef TESTS_REFERENCE_CORNER_OF_LINES_H
#define TESTS_REFERENCE_CORNER_OF_LINES_H

#include <cmath>

#include <Eigen/Dense>

namespace reference
{

struct Line {
    double alpha;
    double rho;
    Eigen::Matrix2d cov; // of (alpha, rho)
};

struct Corner {
    Eigen::Vector2d p;
    Eigen::Matrix2d cov;
};

inline Eigen::Vector2d normal_of(const Line &line)
{
    return {std::cos(line.alpha), std::sin(line.alpha)};
}

// First-order propagation: n(alpha) . p = rho for both lines, the lines independent of each other.
inline Corner corner_of_lines(const Line &a, const Line &b)
{
    Eigen::Matrix2d n;
    n.row(0) = normal_of(a);
    n.row(1) = normal_of(b);
    Corner corner;
    corner.p = n.inverse() * Eigen::Vector2d(a.rho, b.rho);
    Eigen::Matrix2d along = Eigen::Matrix2d::Zero();
    const Line *const lines[2] = {&a, &b};
    for (int k = 0; k < 2; k++) {
        const Eigen::Vector2d tangent(-n(k, 1), n(k, 0));
        const Eigen::Vector2d by_line(-tangent.dot(corner.p), 1); // derivative of rho - n(alpha) . p
        along(k, k) = by_line.dot(lines[k]->cov * by_line);
    }
    corner.cov = n.inverse() * along * n.inverse().transpose();
    return corner;
}

} // namespace reference

#endif
