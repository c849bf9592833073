// What an extractor finds in one scan: frame of the scanner, metres, radians.
#pragma once

#include <vector>

#include "lab/bench/geometry.hpp"

namespace bench
{

struct Line {
    int first = 0; // beams, inclusive
    int last = 0;
    NormalForm form; // rho >= 0
    Point start = Point::Zero();
    Point end = Point::Zero();
    double sigma_alpha = 0; // deviation of the direction as the extractor states it; 0: it states none
};

struct Extraction {
    std::vector<Line> lines;
    std::vector<Point> corners;
};

} // namespace bench
