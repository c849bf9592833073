/* A rectangular room seen by a scanner that stands still: scans for tests of the firmware, without noise. */
#ifndef ALE_TESTS_FIRMWARE_ROOM_HPP
#define ALE_TESTS_FIRMWARE_ROOM_HPP

#include <cmath>

extern "C" {
#include "base/scan.h"
}

namespace room
{

constexpr double kHalfLength = 2.0;
constexpr double kHalfWidth = 1.5;

inline double distance(double x, double y, double bearing)
{
    const double dx = std::cos(bearing);
    const double dy = std::sin(bearing);
    const double along_x = dx > 0 ? (kHalfLength - x) / dx : (dx < 0 ? (-kHalfLength - x) / dx : 1e9);
    const double along_y = dy > 0 ? (kHalfWidth - y) / dy : (dy < 0 ? (-kHalfWidth - y) / dy : 1e9);
    return std::fmin(along_x, along_y);
}

/* Geometry of the URG-04LX; the scanner at (x, y) looks along x. */
inline void fill(ale_scan_t &scan, double x, double y, int64_t stamp_us)
{
    scan = {};
    scan.stamp_us = stamp_us;
    scan.beams = 682;
    scan.step_bam = 1 << 22;
    scan.first_bearing_bam = static_cast<uint32_t>(-340) << 22;
    scan.range_min_um = 20000;
    scan.range_max_um = 5600000;
    for (int k = 0; k < scan.beams; k++) {
        const double bearing = (k - 340) * 2 * M_PI / 1024;
        scan.range_um[k] = static_cast<int32_t>(std::lround(distance(x, y, bearing) * 1e6));
    }
}

} // namespace room

#endif
