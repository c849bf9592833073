#include "reference/run_fit.h"

#include "reference/total_least_squares.h"

namespace reference
{
namespace
{

constexpr double least_variance = 0.0625; // no range is known better than its quantum of 1 mm
constexpr double most_relative_variance = 1.0 / 128;

line_fit line_through(const ScanPoints &points, int first, int last)
{
    std::vector<Eigen::Vector2d> p;
    for (int i = first; i <= last; i++) {
        p.emplace_back(points[static_cast<size_t>(i)].x, points[static_cast<size_t>(i)].y);
    }
    return total_least_squares(p);
}

} // namespace

double sse_of_run(const ScanPoints &points, int first, int last)
{
    return line_through(points, first, last).sse;
}

// (26) along the normal: a point at range d, seen at the angle phi from the normal, has
// s_d^2 cos^2 phi + d^2 s_phi^2 sin^2 phi, and d cos phi = rho, d^2 sin^2 phi = d^2 - rho^2.
RunFit fit_run(const ScanPoints &points, const NoiseOfScan &noise, int first, int last)
{
    const line_fit line = line_through(points, first, last);
    const int n = last - first + 1;
    double own_relative = 0;
    double range2 = 0;
    for (int i = first; i <= last; i++) {
        const ScanPoint &p = points[static_cast<size_t>(i)];
        own_relative += noise.own(p.range) / (p.range * p.range) / n;
        range2 += (p.x * p.x + p.y * p.y) / n;
    }
    const double rho2 = line.rho * line.rho;
    const double own = rho2 * std::min(own_relative, most_relative_variance) +
                       std::max(range2 - rho2, 0.0) * noise.bearing_variance;
    const double shared = noise.shared(std::sqrt(range2)) / range2;
    return {n,
            line.sse,
            std::max(own * noise.own_scale, least_variance),
            rho2 * std::min(shared, most_relative_variance),
            line.along2,
            line.alpha,
            line.rho,
            line.mean_along};
}

// Wilson and Hilferty: the cube root of chi square over its degrees of freedom is nearly normal.
double chi_limit(int n, double z)
{
    const double freedom = std::max(n - 2, 1);
    const double variance = 2 / (9 * freedom);
    return freedom * std::pow(1 - variance + z * std::sqrt(variance), 3);
}

double points_together(const NoiseOfScan &noise, int n)
{
    return std::min<double>(n, 2 * noise.shared_beams);
}

} // namespace reference
