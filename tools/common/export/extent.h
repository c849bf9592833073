/* A rectangle in the map that grows to hold points. */
#ifndef ALE_COMMON_EXPORT_EXTENT_H
#define ALE_COMMON_EXPORT_EXTENT_H

#include <algorithm>
#include <cstdint>

extern "C" {
#include "base/pose.h"
}

namespace ale
{

struct Extent {
    int32_t left_um;
    int32_t bottom_um;
    int32_t right_um;
    int32_t top_um;
};

/* Of nothing: left is beyond right. */
constexpr Extent no_extent = {INT32_MAX, INT32_MAX, INT32_MIN, INT32_MIN};

inline void include(Extent &extent, const ale_point_t &p)
{
    extent.left_um = std::min(extent.left_um, p.x_um);
    extent.bottom_um = std::min(extent.bottom_um, p.y_um);
    extent.right_um = std::max(extent.right_um, p.x_um);
    extent.top_um = std::max(extent.top_um, p.y_um);
}

} // namespace ale

#endif
