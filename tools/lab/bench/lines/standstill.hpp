// Where in a recording the scanner is at rest: what a fixed scanner sees, and what a robot sees while its
// wheels stand still.
#pragma once

#include <memory>
#include <string>
#include <vector>

extern "C" {
#include "base/scan.h"
}

namespace bench
{

struct Standstill {
    int first_scan = 0; // in the recording, from 0
    std::vector<std::unique_ptr<ale_scan_t>> scans;
};

// Every stretch of at least `least_scans` scans between which the odometry is the same; without odometry the
// whole recording. What the log reader throws.
std::vector<Standstill> standstills(const std::string &path, std::size_t least_scans);

// The scan as the mirror image of the scene gives it: beam k is beam beams - 1 - k, its bearing has the other
// sign. Of a scan whose beams lie on a grid.
std::unique_ptr<ale_scan_t> mirrored(const ale_scan_t &scan);

// Every `stride`-th beam of a scan whose beams lie on a grid: what a scanner of wider steps would have seen.
std::unique_ptr<ale_scan_t> thinned(const ale_scan_t &scan, int stride);

} // namespace bench
