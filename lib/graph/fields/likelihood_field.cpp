#include "graph/fields/likelihood_field.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace ale
{

namespace
{

constexpr double likelihood_sigma_m = 0.08;

struct Extent {
    Eigen::Vector2d low;
    Eigen::Vector2d high;
};

Extent extent_of(const std::vector<SurfacePoint> &points)
{
    Extent e{{0, 0}, {0, 0}};
    if (!points.empty()) {
        e = {points[0].p, points[0].p};
    }
    for (const SurfacePoint &point : points) {
        e.low = e.low.cwiseMin(point.p);
        e.high = e.high.cwiseMax(point.p);
    }
    return e;
}

// The part within half_m of the origin along each axis.
Extent within(const Extent &e, double half_m)
{
    const Eigen::Vector2d corner(half_m, half_m);
    return {e.low.cwiseMax(-corner).cwiseMin(corner), e.high.cwiseMin(corner).cwiseMax(-corner)};
}

int cells_along(double metres)
{
    return static_cast<int>((metres + 2 * LikelihoodField::reach_m) * LikelihoodField::cells_per_m) + 1;
}

double cells_of(const Extent &e)
{
    const Eigen::Vector2d size = e.high - e.low;
    return static_cast<double>(cells_along(size.x())) * cells_along(size.y());
}

// The largest part around the origin that max_cells hold: all of a narrow corridor, a square of a wide hall.
Extent held_of(const Extent &all)
{
    double least_m = 0;
    double most_m = std::max(all.high.cwiseAbs().maxCoeff(), all.low.cwiseAbs().maxCoeff());
    if (cells_of(all) <= LikelihoodField::max_cells) {
        return all;
    }
    while (most_m - least_m > LikelihoodField::cell_m) {
        const double middle_m = (least_m + most_m) / 2;
        (cells_of(within(all, middle_m)) <= LikelihoodField::max_cells ? least_m : most_m) = middle_m;
    }
    return within(all, least_m);
}

double likelihood_at(double distance2)
{
    const double x2 = distance2 / (likelihood_sigma_m * likelihood_sigma_m);
    return 1 / (1 + x2 * x2 / 4);
}

} // namespace

LikelihoodField::LikelihoodField(const std::vector<SurfacePoint> &points)
{
    const Extent held = held_of(extent_of(points));
    origin_ = held.low - Eigen::Vector2d(reach_m, reach_m);
    width_ = cells_along(held.high.x() - held.low.x());
    height_ = cells_along(held.high.y() - held.low.y());
    const auto cells = static_cast<size_t>(width_) * static_cast<size_t>(height_);
    nearest_.assign(cells, -1);
    average_cells(points);
    std::vector<double> distance2(cells, reach_m * reach_m);
    for (size_t k = 0; k < points_.size(); k++) {
        propagate(k, &distance2);
    }
    set_likelihoods(distance2);
}

// Keeps the mean of the points of each cell and quadrant. The points of a cell are chained; nearest_ holds
// the first of each chain until this returns.
void LikelihoodField::average_cells(const std::vector<SurfacePoint> &points)
{
    std::vector<int32_t> next(points.size(), -1);
    for (size_t k = points.size(); k-- > 0;) {
        const int cell = cell_of(points[k].p);
        if (cell >= 0) {
            next[k] = nearest_[static_cast<size_t>(cell)];
            nearest_[static_cast<size_t>(cell)] = static_cast<int32_t>(k);
        }
    }
    for (int32_t &first : nearest_) {
        if (first >= 0) {
            add_means(points, next, first);
            first = -1;
        }
    }
}

// Appends the means of a chain of points, one a quadrant.
void LikelihoodField::add_means(const std::vector<SurfacePoint> &points, const std::vector<int32_t> &next,
                                int32_t first)
{
    struct Sum {
        SurfacePoint point{{0, 0}, {0, 0}};
        double count = 0;
    };
    std::array<Sum, quadrants> sums;
    for (int32_t k = first; k >= 0; k = next[static_cast<size_t>(k)]) {
        const SurfacePoint &point = points[static_cast<size_t>(k)];
        Sum &sum = sums[quadrant_of(point.normal)];
        sum.point.p += point.p;
        sum.point.normal += point.normal;
        sum.count++;
    }
    for (const Sum &sum : sums) {
        if (sum.count > 0) {
            const double length = sum.point.normal.norm();
            const Eigen::Vector2d none(0, 0);
            points_.push_back({sum.point.p / sum.count,
                               length > sum.count / 2 ? Eigen::Vector2d(sum.point.normal / length) : none});
        }
    }
}

// Enters point k in the cells within reach that have no nearer point yet.
void LikelihoodField::propagate(size_t k, std::vector<double> *distance2)
{
    const Eigen::Vector2d cell_p = (points_[k].p - origin_) * cells_per_m;
    const double reach = reach_m * cells_per_m;
    const int first_row = std::max(0, static_cast<int>(std::ceil(cell_p.y() - 0.5 - reach)));
    const int last_row = std::min(height_ - 1, static_cast<int>(std::floor(cell_p.y() - 0.5 + reach)));
    for (int r = first_row; r <= last_row; r++) {
        const double dy = r + 0.5 - cell_p.y();
        const double half = std::sqrt(std::max(0.0, reach * reach - dy * dy));
        const int first = std::max(0, static_cast<int>(std::ceil(cell_p.x() - 0.5 - half)));
        const int last = std::min(width_ - 1, static_cast<int>(std::floor(cell_p.x() - 0.5 + half)));
        const auto row = static_cast<size_t>(r) * static_cast<size_t>(width_);
        for (int c = first; c <= last; c++) {
            const double dx = c + 0.5 - cell_p.x();
            const double d2 = (dx * dx + dy * dy) * (cell_m * cell_m);
            const size_t cell = row + static_cast<size_t>(c);
            if (d2 < (*distance2)[cell]) {
                (*distance2)[cell] = d2;
                nearest_[cell] = static_cast<int32_t>(k);
            }
        }
    }
}

void LikelihoodField::set_likelihoods(const std::vector<double> &distance2)
{
    likelihood_.resize(nearest_.size());
    for (size_t cell = 0; cell < nearest_.size(); cell++) {
        likelihood_[cell] = nearest_[cell] < 0 ? 0 : static_cast<float>(likelihood_at(distance2[cell]));
    }
}

LikelihoodField::Cell LikelihoodField::cell_at(const Eigen::Vector2d &p) const
{
    const Eigen::Vector2d cell = (p - origin_) * cells_per_m;
    const auto whole = [](double x) {
        const double far = static_cast<double>(max_cells);
        return static_cast<int>(std::floor(std::min(std::max(x, -far), 2 * far)));
    };
    return {whole(cell.x()), whole(cell.y())};
}

void LikelihoodField::add_likelihoods_around(const Eigen::Vector2d &p, int steps, int stride,
                                             std::vector<double> *sums) const
{
    const Cell centre = cell_at(p);
    const int side = 2 * steps + 1;
    for (int y = 0; y < side; y++) {
        const int r = centre.row + (y - steps) * stride;
        if (r < 0 || r >= height_) {
            continue;
        }
        const float *cells = &likelihood_[static_cast<size_t>(r) * static_cast<size_t>(width_)];
        double *line = &(*sums)[static_cast<size_t>(y) * static_cast<size_t>(side)];
        for (int x = 0; x < side; x++) {
            const int c = centre.column + (x - steps) * stride;
            if (c >= 0 && c < width_) {
                line[x] += static_cast<double>(cells[c]);
            }
        }
    }
}

} // namespace ale
