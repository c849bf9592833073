#include "graph/surface_field.h"

#include <algorithm>
#include <cmath>

namespace ale
{

namespace
{

constexpr double likeness_sigma_m = 0.08;

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

double likeness_at(double distance2)
{
    const double x2 = distance2 / (likeness_sigma_m * likeness_sigma_m);
    return 1 / (1 + x2 * x2 / 4);
}

// Two sides of a thin panel lie in one cell: surfaces that face apart are kept apart.
int facing_of(const Eigen::Vector2d &normal)
{
    return (normal.x() > 0 ? 1 : 0) + (normal.y() > 0 ? 2 : 0);
}

} // namespace

SurfaceField::SurfaceField(const std::vector<SurfacePoint> &points)
{
    const Extent e = extent_of(points);
    const Eigen::Vector2d margin(reach_m, reach_m);
    const double side = std::sqrt(static_cast<double>(max_cells)) * cell_m;
    const Eigen::Vector2d size = (e.high - e.low + 2 * margin).cwiseMin(Eigen::Vector2d(side, side));
    origin_ = (e.low + e.high) / 2 - size / 2;
    width_ = static_cast<int>(size.x() / cell_m) + 1;
    height_ = static_cast<int>(size.y() / cell_m) + 1;
    const auto cells = static_cast<size_t>(width_) * static_cast<size_t>(height_);
    nearest_.assign(cells, -1);
    likeness_.assign(cells, 0);
    thin_out(points);
    std::vector<double> distance2(cells, reach_m * reach_m);
    for (size_t k = 0; k < points_.size(); k++) {
        spread(k, &distance2);
    }
}

// One point a cell and facing: where the patch was seen many times, the mean of what was seen.
void SurfaceField::thin_out(const std::vector<SurfacePoint> &points)
{
    struct Entry {
        int slot;
        SurfacePoint point;
    };
    std::vector<Entry> entries;
    for (const SurfacePoint &point : points) {
        const int cell = cell_of(point.p);
        if (cell >= 0) {
            entries.push_back({cell * 4 + facing_of(point.normal), point});
        }
    }
    std::stable_sort(entries.begin(), entries.end(),
                     [](const Entry &a, const Entry &b) { return a.slot < b.slot; });
    for (size_t k = 0; k < entries.size();) {
        SurfacePoint sum = {{0, 0}, {0, 0}};
        double count = 0;
        for (const int slot = entries[k].slot; k < entries.size() && entries[k].slot == slot; k++) {
            sum.p += entries[k].point.p;
            sum.normal += entries[k].point.normal;
            count++;
        }
        const double length = sum.normal.norm();
        const Eigen::Vector2d none(0, 0);
        points_.push_back({sum.p / count, length > count / 2 ? Eigen::Vector2d(sum.normal / length) : none});
    }
}

void SurfaceField::spread(size_t k, std::vector<double> *distance2)
{
    const int reach = static_cast<int>(reach_m / cell_m) + 1;
    const Eigen::Vector2d offset = (points_[k].p - origin_) / cell_m;
    const int column = static_cast<int>(offset.x());
    const int row = static_cast<int>(offset.y());
    for (int r = std::max(0, row - reach); r <= std::min(height_ - 1, row + reach); r++) {
        const double dy = (r + 0.5 - offset.y()) * cell_m;
        for (int c = std::max(0, column - reach); c <= std::min(width_ - 1, column + reach); c++) {
            const double dx = (c + 0.5 - offset.x()) * cell_m;
            const double d2 = dx * dx + dy * dy;
            const auto cell = static_cast<size_t>(r) * static_cast<size_t>(width_) + static_cast<size_t>(c);
            if (d2 < (*distance2)[cell]) {
                (*distance2)[cell] = d2;
                nearest_[cell] = static_cast<int32_t>(k);
                likeness_[cell] = static_cast<float>(likeness_at(d2));
            }
        }
    }
}

int SurfaceField::cell_of(const Eigen::Vector2d &p) const
{
    const double column = (p.x() - origin_.x()) / cell_m;
    const double row = (p.y() - origin_.y()) / cell_m;
    if (!(column >= 0 && row >= 0 && column < width_ && row < height_)) {
        return -1;
    }
    return static_cast<int>(row) * width_ + static_cast<int>(column);
}

const SurfacePoint *SurfaceField::nearest(const Eigen::Vector2d &p) const
{
    const int cell = cell_of(p);
    const int32_t k = cell < 0 ? -1 : nearest_[static_cast<size_t>(cell)];
    return k < 0 ? nullptr : &points_[static_cast<size_t>(k)];
}

double SurfaceField::likeness(const Eigen::Vector2d &p) const
{
    const int cell = cell_of(p);
    return cell < 0 ? 0 : static_cast<double>(likeness_[static_cast<size_t>(cell)]);
}

} // namespace ale
