// The extractors under comparison: libale and those of the textbook, behind one call.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "lab/bench/lines/extraction.hpp"

extern "C" {
#include "base/scan.h"
}

namespace bench
{

struct Extractor {
    std::string name;     // one word, for options
    std::string title;    // for tables
    std::string function; // whose instructions are counted
    std::function<Extraction(const ale_scan_t &scan)> extract;
};

// Farthest a point may lie from its line: metres, or a share of the range where that is more.
struct Threshold {
    double floor;
    double proportional;
};

// All of them: libale, and each of the textbook's once with a fixed threshold and once with what suits it
// best on the noise "urg". A threshold given here replaces the latter.
std::vector<Extractor> extractors(const std::optional<Threshold> &replaced = {});

} // namespace bench
