// Likelihood field of a submap: a grid that gives the nearest surface point, and a score for the distance to
// it, in constant time. Hypotheses are scored on it and the refinement pairs points by it.
//
// Memory and construction are bounded by max_cells, the number of points, and four times (one a quadrant of
// the normal) the occupied cells times the 113 cells within reach_m.
// Source: Thrun, Burgard, Fox, "Probabilistic Robotics" (2005), 6.4, with a heavy-tailed kernel.
#ifndef ALE_GRAPH_FIELDS_LIKELIHOOD_FIELD_H
#define ALE_GRAPH_FIELDS_LIKELIHOOD_FIELD_H

#include <cstdint>
#include <vector>

#include "graph/optimise/node.h"

namespace ale
{

class LikelihoodField
{
  public:
    static constexpr double cell_m = 0.05;
    static constexpr double cells_per_m = 1 / cell_m;
    static constexpr double reach_m = 0.30; // beyond this a point has no neighbour
    static constexpr int max_cells = 1 << 18;

    // Points in the submap's frame; surfaces may be seen many times. Points beyond max_cells around the
    // origin, from where the submap was seen, are left out. May throw std::bad_alloc, as nothing else here.
    explicit LikelihoodField(const std::vector<SurfacePoint> &points);

    // The nearest surface point; nullptr: none within about reach_m. Belongs to the field. O(1).
    const SurfacePoint *nearest(const Eigen::Vector2d &p) const
    {
        const int cell = cell_of(p);
        const int32_t k = cell < 0 ? -1 : at(nearest_, cell);
        return k < 0 ? nullptr : &at(points_, k);
    }

    // 1 on a surface, falling to 0 at reach_m. O(1).
    double likelihood(const Eigen::Vector2d &p) const
    {
        const int cell = cell_of(p);
        return cell < 0 ? 0 : static_cast<double>(at(likelihood_, cell));
    }

    struct Cell {
        int column;
        int row;
    };
    int width() const
    {
        return width_;
    }
    int height() const
    {
        return height_;
    }
    // That p lies in, also outside of the field; what is farther than any position can be is far outside.
    Cell cell_at(const Eigen::Vector2d &p) const;
    // Of a cell of the field.
    double likelihood_of(const Cell &cell) const
    {
        return static_cast<double>(at(likelihood_, cell.row * width_ + cell.column));
    }

    // Adds to (2 steps + 1)^2 sums, row by row, the likelihood of p displaced by -steps..steps times
    // `stride` cells along each axis. O(steps^2).
    void add_likelihoods_around(const Eigen::Vector2d &p, int steps, int stride,
                                std::vector<double> *sums) const;

  private:
    void average_cells(const std::vector<SurfacePoint> &points);
    void add_means(const std::vector<SurfacePoint> &points, const std::vector<int32_t> &next, int32_t first);
    void propagate(size_t k, std::vector<double> *distance2);
    void set_likelihoods(const std::vector<double> &distance2);

    // -1: outside.
    int cell_of(const Eigen::Vector2d &p) const
    {
        const Eigen::Vector2d cell = (p - origin_) * cells_per_m;
        if (!(cell.x() >= 0 && cell.y() >= 0 && cell.x() < width_ && cell.y() < height_)) {
            return -1;
        }
        return static_cast<int>(cell.y()) * width_ + static_cast<int>(cell.x());
    }

    std::vector<SurfacePoint> points_;
    Eigen::Vector2d origin_;
    int width_ = 0;
    int height_ = 0;
    std::vector<int32_t> nearest_; // index of the nearest point, -1: none
    std::vector<float> likelihood_;
};

} // namespace ale

#endif
