// The mean of what many scans saw of the surfaces of a map: a grid of sums.
//
//   MeanSurface surface(low, high);
//   surface.add(point);                          (of all scans)
//   if (const auto mean = surface.around(point, 8)) ... mean->p, mean->normal ...
//
// Memory: four bytes for each of at most max_cells, and 160 for each that is not empty.
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

    // Over the rectangle between the two corners; what lies outside, or farther from its middle than
    // max_cells reach, is left out.
    MeanSurface(const Eigen::Vector2d &low, const Eigen::Vector2d &high);

    void add(const SurfacePoint &point);

    // Of what faces as the point does in its cell and in the eight around; none: fewer than least_points.
    std::optional<SurfacePoint> around(const SurfacePoint &point, double least_points) const;

  private:
    struct Sum {
        Eigen::Vector2d p{0, 0}; // from the origin
        Eigen::Vector2d normal{0, 0};
        double count = 0;
    };
    // Two sides of a thin panel lie in one cell: by quadrant of the normal.
    using Cell = std::array<Sum, 4>;

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
