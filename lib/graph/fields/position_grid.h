// A likelihood field in bytes, for sums over many positions of a view that are whole cells apart: what is
// summed lies side by side, and sums of whole numbers are the same in whatever order they are made.
#ifndef ALE_GRAPH_FIELDS_POSITION_GRID_H
#define ALE_GRAPH_FIELDS_POSITION_GRID_H

#include <cstdint>
#include <vector>

#include "graph/fields/likelihood_field.h"

namespace ale
{

class PositionGrid
{
  public:
    static constexpr size_t most_points = 257; // whose sum a uint16_t holds

    // Positions are a stride of 2^stride_log2 cells apart. With pool > 0 each cell has the best of four: its
    // own and those `pool` cells farther along each axis and both, a bound for these positions. Where no cell
    // is farther, its own. O(cells); may throw std::bad_alloc.
    PositionGrid(const LikelihoodField &field, int stride_log2, int pool);

    // Adds to count * count sums, row by row, the likelihoods (0..255) of the cell and of those 1..count - 1
    // strides farther along each axis; outside the field they are 0. Any cell. O(count^2).
    void add(const LikelihoodField::Cell &first, int count, uint16_t *sums) const;

  private:
    size_t index_of(int column, int row) const
    {
        const int plane = row * stride_ + (column & (stride_ - 1));
        const int cell = plane * columns_ + (column >> stride_log2_);
        return static_cast<size_t>(cell);
    }

    int width_;
    int height_;
    int stride_log2_;
    int stride_;
    int columns_; // of one row with the same rest by the stride
    std::vector<uint8_t> cells_;
};

} // namespace ale

#endif
