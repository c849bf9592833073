// A patch of the map as a grid that answers "how near is the nearest surface, and which is it" in constant
// time: what hypotheses are scored on and what the refinement draws its pairs from.
//
// Memory and set-up are bounded by max_cells, the number of points, and four times (one a facing) the
// occupied cells times the disc of reach_m in cells, 113.
#ifndef ALE_GRAPH_LOOPS_SURFACE_FIELD_H
#define ALE_GRAPH_LOOPS_SURFACE_FIELD_H

#include <cstdint>
#include <vector>

#include "graph/optimise/node.h"

namespace ale
{

class SurfaceField
{
  public:
    static constexpr double cell_m = 0.05;
    static constexpr double cells_per_m = 1 / cell_m;
    static constexpr double reach_m = 0.30; // beyond this a point has no neighbour
    static constexpr int max_cells = 1 << 18;

    // Points in the frame of the patch, overlapping views of one surface welcome. What max_cells around the
    // origin do not hold is left out: the origin is where the patch was seen from.
    explicit SurfaceField(const std::vector<SurfacePoint> &points);

    // The nearest surface point, or nullptr when none lies within about reach_m.
    const SurfacePoint *nearest(const Eigen::Vector2d &p) const
    {
        const int cell = cell_of(p);
        const int32_t k = cell < 0 ? -1 : nearest_[static_cast<size_t>(cell)];
        return k < 0 ? nullptr : &points_[static_cast<size_t>(k)];
    }

    // 1 on a surface, falling to 0 at reach_m.
    double likeness(const Eigen::Vector2d &p) const
    {
        const int cell = cell_of(p);
        return cell < 0 ? 0 : static_cast<double>(likeness_[static_cast<size_t>(cell)]);
    }

    // Adds to each of (2 steps + 1)^2 sums, row by row, the likeness of p displaced by that many strides of
    // `stride` cells from -steps to steps.
    void add_likeness_around(const Eigen::Vector2d &p, int steps, int stride,
                             std::vector<double> *sums) const;

  private:
    void thin_out(const std::vector<SurfacePoint> &points);
    void add_means(const std::vector<SurfacePoint> &points, const std::vector<int32_t> &next, int32_t first);
    void spread(size_t k, std::vector<double> *distance2);
    void follow_likeness(const std::vector<double> &distance2);

    // -1: outside.
    int cell_of(const Eigen::Vector2d &p) const
    {
        const Eigen::Vector2d at = (p - origin_) * cells_per_m;
        if (!(at.x() >= 0 && at.y() >= 0 && at.x() < width_ && at.y() < height_)) {
            return -1;
        }
        return static_cast<int>(at.y()) * width_ + static_cast<int>(at.x());
    }

    std::vector<SurfacePoint> points_;
    Eigen::Vector2d origin_;
    int width_ = 0;
    int height_ = 0;
    std::vector<int32_t> nearest_; // index of the nearest point, -1: none
    std::vector<float> likeness_;
};

} // namespace ale

#endif
