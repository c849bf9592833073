// The mean of what many scans saw of the surfaces of a map: a grid of sums.
//
//   MeanSurface surface(low, high);
//   surface.add(point);                          (of all scans)
//   if (const auto mean = surface.around(point, 8)) ... mean->p, mean->normal ...
//
// Memory: four bytes for each of at most max_cells, and 160 for each that is not empty. Metres.
#ifndef ALE_GRAPH_OPTIMISE_MEAN_SURFACE_H
#define ALE_GRAPH_OPTIMISE_MEAN_SURFACE_H

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "graph/optimise/node.h"

namespace ale
{

class MeanSurface
{
  public:
    static constexpr double cell_m = 0.05;
    static constexpr int64_t max_cells = int64_t{1} << 25; // 290 m by 290 m

    // Covers the rectangle between two corners, cut to max_cells about its middle. May throw std::bad_alloc.
    MeanSurface(const Eigen::Vector2d &low, const Eigen::Vector2d &high);

    // Adds a point with its normal; one outside the grid is ignored. O(1); may throw std::bad_alloc.
    void add(const SurfacePoint &point);

    // Mean of the points in the cell of `point` and the eight around that face as it does, with a unit
    // normal. None: fewer than least_points, or outside the grid. O(1), never throws.
    std::optional<SurfacePoint> around(const SurfacePoint &point, double least_points) const;

  private:
    struct Sum {
        Eigen::Vector2d p{0, 0}; // from the origin
        Eigen::Vector2d normal{0, 0};
        double count = 0;
    };
    using Cell = std::array<Sum, quadrants>; // by quadrant of the normal

    int64_t index_of(const Eigen::Vector2d &p) const; // -1: outside
    void gather(int64_t cell, const Eigen::Vector2d &facing, Sum *sum) const;

    Eigen::Vector2d origin_;
    int64_t width_ = 0;
    int64_t height_ = 0;
    std::vector<int32_t> place_; // in cells_, -1: empty
    std::vector<Cell> cells_;
};

} // namespace ale

#endif
