// Is the direction of a line as uncertain as it is told to be? Of a scanner at rest, without truth: lines of
// one surface scatter about their mean as their covariance says, or they do not.
#pragma once

#include <vector>

#include "lab/bench/lines/extraction.hpp"

namespace bench
{

struct StatedError {
    int surfaces = 0;   // seen in at least half of the scans
    double squared = 0; // squared errors of directions in units of the stated variance, median over the
                        // surfaces: 1 is right
    double worst = 0;   // the largest of them
};

// Lines of one surface: they share 60 % of the beams of the longer, whatever their direction.
StatedError stated_error(const std::vector<std::vector<Line>> &scans);

} // namespace bench
