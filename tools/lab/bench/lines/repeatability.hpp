// How repeatable are the lines of a scanner at rest? No truth is needed: the same walls should be found in
// every scan, whole, with the same ends, and nothing else.
#pragma once

#include <vector>

#include "lab/bench/lines/extraction.hpp"

namespace bench
{

struct Repeatability {
    int walls = 0;      // groups of alike lines seen in at least half of the scans
    double seen = 0;    // per cent of the scans in which a wall is found, mean over the walls
    double pieces = 0;  // lines per wall and scan where it is found
    double stray = 0;   // lines a scan that belong to no wall
    double end_rms = 0; // scatter of a wall's ends in beams, median over the ends
};

// Lines of one wall: the same direction within 3 degrees, distance within 40 mm, half of the beams of the
// shorter shared. Lines of fewer than 8 beams are left out.
Repeatability repeatability(const std::vector<std::vector<Line>> &scans);

} // namespace bench
