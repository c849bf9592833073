// A patch of the map as a grid that answers "how near is the nearest surface, and which is it" in constant
// time: what hypotheses are scored on and what the refinement draws its pairs from.
//
// Memory and set-up are bounded by max_cells and the number of points times the reach in cells squared.
#ifndef ALE_GRAPH_SURFACE_FIELD_H
#define ALE_GRAPH_SURFACE_FIELD_H

#include <cstdint>
#include <vector>

#include "graph/node.h"

namespace ale
{

class SurfaceField
{
  public:
    static constexpr double cell_m = 0.05;
    static constexpr double reach_m = 0.30; // beyond this a point has no neighbour
    static constexpr int max_cells = 1 << 18;

    // Points in the frame of the patch, overlapping views of one surface welcome. Points outside max_cells
    // around the middle are left out.
    explicit SurfaceField(const std::vector<SurfacePoint> &points);

    // The nearest surface point, or nullptr when none lies within about reach_m.
    const SurfacePoint *nearest(const Eigen::Vector2d &p) const;

    // 1 on a surface, falling to 0 at reach_m.
    double likeness(const Eigen::Vector2d &p) const;

  private:
    void thin_out(const std::vector<SurfacePoint> &points);
    void spread(size_t k, std::vector<double> *distance2);
    int cell_of(const Eigen::Vector2d &p) const; // -1: outside

    std::vector<SurfacePoint> points_;
    Eigen::Vector2d origin_;
    int width_ = 0;
    int height_ = 0;
    std::vector<int32_t> nearest_; // index of the nearest point, -1: none
    std::vector<float> likeness_;
};

} // namespace ale

#endif
