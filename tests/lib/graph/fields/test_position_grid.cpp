// lib/graph/fields/position_grid: against sums of the field's likelihoods, one by one.
#include "graph/fields/position_grid.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace
{

using ale::LikelihoodField;
using ale::PositionGrid;

// Two walls with a corner, a tenth of a metre from point to point.
LikelihoodField corner()
{
    std::vector<ale::SurfacePoint> points;
    for (int k = 0; k <= 30; k++) {
        points.push_back({{0.1 * k, -1}, {0, 1}});
        points.push_back({{3, -1 + 0.1 * k}, {-1, 0}});
    }
    return LikelihoodField(points);
}

int byte_at(const LikelihoodField &field, int column, int row)
{
    const bool inside = column >= 0 && row >= 0 && column < field.width() && row < field.height();
    return inside ? static_cast<int>(std::lround(field.likelihood_of({column, row}) * 255)) : 0;
}

// The best of a cell and those `pool` farther; outside there is nothing.
int pooled_at(const LikelihoodField &field, int column, int row, int pool)
{
    const bool inside = column >= 0 && row >= 0 && column < field.width() && row < field.height();
    return inside ? std::max({byte_at(field, column, row), byte_at(field, column + pool, row),
                              byte_at(field, column, row + pool), byte_at(field, column + pool, row + pool)})
                  : 0;
}

void compare(int stride_log2, int pool, int count)
{
    const LikelihoodField field = corner();
    const PositionGrid grid(field, stride_log2, pool);
    const int stride = 1 << stride_log2;
    int seen = 0;
    for (int row = -count * stride - 3; row < field.height() + 3; row += 7) {
        for (int column = -count * stride - 3; column < field.width() + 3; column += 5) {
            std::vector<uint16_t> sums(static_cast<size_t>(count) * static_cast<size_t>(count), 1);
            grid.add({column, row}, count, sums.data());
            for (int k = 0; k < count * count; k++) {
                const int expected =
                    1 + pooled_at(field, column + k % count * stride, row + k / count * stride, pool);
                ASSERT_EQ(sums[static_cast<size_t>(k)], expected)
                    << "cell " << column << " " << row << ", " << k << " of " << count << " strides of "
                    << stride;
                seen += expected > 1;
            }
        }
    }
    EXPECT_GT(seen, 100);
}

TEST(PositionGrid, AddsWhatTheFieldHoldsAtEveryStride)
{
    compare(0, 0, 3);
    compare(1, 0, 2);
    compare(2, 0, 33);
}

TEST(PositionGrid, ABlockHasTheBestOfItsPositions)
{
    compare(2, 2, 9);
    compare(1, 1, 5);
}

TEST(PositionGrid, TheMostPointsDoNotOverflowASum)
{
    const LikelihoodField field = corner();
    const PositionGrid grid(field, 0, 0);
    const LikelihoodField::Cell on_wall = field.cell_at({1.01, -0.99});
    uint16_t sum = 0;
    uint16_t one = 0;
    grid.add(on_wall, 1, &one);
    ASSERT_GT(one, 200);
    for (size_t k = 0; k < PositionGrid::most_points; k++) {
        grid.add(on_wall, 1, &sum);
    }
    EXPECT_EQ(sum, PositionGrid::most_points * one);
}

TEST(PositionGrid, WhatIsFarOutsideIsNothing)
{
    const LikelihoodField field = corner();
    const PositionGrid grid(field, 1, 0);
    std::vector<uint16_t> sums(4, 0);
    for (const double far_m : {1e3, -1e3, 1e9, -1e9}) {
        grid.add(field.cell_at({far_m, 0}), 2, sums.data());
        grid.add(field.cell_at({0, far_m}), 2, sums.data());
    }
    EXPECT_EQ(sums, std::vector<uint16_t>(4, 0));
}

} // namespace
