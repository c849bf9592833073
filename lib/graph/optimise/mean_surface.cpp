#include "graph/optimise/mean_surface.h"

#include <algorithm>
#include <cmath>

namespace ale
{

namespace
{

constexpr double least_facing = 0.7; // cosine between the point's normal and the mean's

} // namespace

MeanSurface::MeanSurface(const Eigen::Vector2d &low, const Eigen::Vector2d &high)
{
    const double side = std::sqrt(static_cast<double>(max_cells)) * cell_m;
    const Eigen::Vector2d size = (high - low).cwiseMax(0).cwiseMin(Eigen::Vector2d(side, side));
    origin_ = (low + high) / 2 - size / 2;
    width_ = static_cast<int64_t>(size.x() / cell_m) + 1;
    height_ = static_cast<int64_t>(size.y() / cell_m) + 1;
    place_.assign(static_cast<size_t>(width_ * height_), -1);
}

int64_t MeanSurface::index_of(const Eigen::Vector2d &p) const
{
    const Eigen::Vector2d at = (p - origin_) / cell_m;
    if (!(at.x() >= 0 && at.y() >= 0 && at.x() < static_cast<double>(width_) &&
          at.y() < static_cast<double>(height_))) {
        return -1;
    }
    return static_cast<int64_t>(at.y()) * width_ + static_cast<int64_t>(at.x());
}

void MeanSurface::add(const SurfacePoint &point)
{
    const int64_t index = index_of(point.p);
    if (index < 0) {
        return;
    }
    int32_t &place = place_[static_cast<size_t>(index)];
    if (place < 0) {
        place = static_cast<int32_t>(cells_.size());
        cells_.emplace_back();
    }
    Sum &sum = cells_[static_cast<size_t>(place)][quadrant_of(point.normal)];
    sum.p += point.p - origin_;
    sum.normal += point.normal;
    sum.count++;
}

// Adds the points of a cell that face that way.
void MeanSurface::gather(int64_t cell, const Eigen::Vector2d &facing, Sum *sum) const
{
    const int32_t place = place_[static_cast<size_t>(cell)];
    if (place < 0) {
        return;
    }
    for (const Sum &part : cells_[static_cast<size_t>(place)]) {
        if (part.normal.dot(facing) > least_facing * part.count) {
            sum->p += part.p;
            sum->normal += part.normal;
            sum->count += part.count;
        }
    }
}

std::optional<SurfacePoint> MeanSurface::around(const SurfacePoint &point, double least_points) const
{
    const int64_t index = index_of(point.p);
    if (index < 0) {
        return std::nullopt;
    }
    Sum sum;
    const int64_t column = index % width_;
    const int64_t row = index / width_;
    for (int64_t r = std::max<int64_t>(0, row - 1); r <= std::min(height_ - 1, row + 1); r++) {
        for (int64_t c = std::max<int64_t>(0, column - 1); c <= std::min(width_ - 1, column + 1); c++) {
            gather(r * width_ + c, point.normal, &sum);
        }
    }
    const double length = sum.normal.norm();
    if (sum.count < least_points || length <= 0) {
        return std::nullopt;
    }
    return SurfacePoint{origin_ + sum.p / sum.count, sum.normal / length};
}

} // namespace ale
