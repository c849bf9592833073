#include "graph/fields/position_grid.h"

#include <algorithm>
#include <cmath>

namespace ale
{

namespace
{

constexpr double full = 255;

} // namespace

PositionGrid::PositionGrid(const LikelihoodField &field, int stride_log2, int pool)
    : width_(field.width()), height_(field.height()), stride_log2_(stride_log2), stride_(1 << stride_log2),
      columns_((width_ + stride_ - 1) >> stride_log2),
      cells_(static_cast<size_t>(columns_) * static_cast<size_t>(stride_) * static_cast<size_t>(height_), 0)
{
    const auto likelihood = [&](int column, int row) {
        return column < width_ && row < height_ ? field.likelihood_of({column, row}) : 0;
    };
    for (int row = 0; row < height_; row++) {
        for (int column = 0; column < width_; column++) {
            const double best =
                std::max(std::max(likelihood(column, row), likelihood(column + pool, row)),
                         std::max(likelihood(column, row + pool), likelihood(column + pool, row + pool)));
            cells_[index_of(column, row)] = static_cast<uint8_t>(std::lround(best * full));
        }
    }
}

void PositionGrid::add(const LikelihoodField::Cell &first, int count, uint16_t *sums) const
{
    if (first.column >= width_) {
        return;
    }
    const int begin = (std::max(0, -first.column) + stride_ - 1) >> stride_log2_;
    const int end = std::min(count, ((width_ - 1 - first.column) >> stride_log2_) + 1);
    if (begin >= end) {
        return;
    }
    const uint8_t *plane = &cells_[index_of(first.column + begin * stride_, 0)];
    for (int k = 0; k < count; k++) {
        const int row = first.row + k * stride_;
        if (row < 0 || row >= height_) {
            continue;
        }
        const uint8_t *from = plane + static_cast<ptrdiff_t>(row) * stride_ * columns_;
        uint16_t *to = sums + static_cast<ptrdiff_t>(k) * count + begin;
        for (int x = 0; x < end - begin; x++) {
            to[x] = static_cast<uint16_t>(to[x] + from[x]);
        }
    }
}

} // namespace ale
