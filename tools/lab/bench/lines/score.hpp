// Extracted lines and corners held against the truth.
//
// A match pairs one extracted line with one true line, or with successive visible pieces of the same wall,
// when the beams they share are at least 75 % of the longer of the two, their directions differ by less
// than 10 degrees and the middle of the true line is less than 100 mm from the extracted one. An extracted
// line of less than 8 beams or 120 mm, or lying for 75 % on a true line too short to count, is neither right
// nor wrong. A corner is found when one lies within 50 mm of it.
#pragma once

#include <string>
#include <vector>

#include "lab/bench/lines/extraction.hpp"
#include "lab/bench/truth.hpp"

namespace bench
{

// What was counted over some scans. Sums of tallies are tallies.
struct Tally {
    int true_lines = 0;
    int found_lines = 0;  // true lines that were found
    int judged_lines = 0; // extracted lines that are right or wrong
    int false_lines = 0;  // extracted lines that are wrong
    int true_corners = 0;
    int found_corners = 0;
    int judged_corners = 0;
    std::vector<double> error_squared; // of (alpha, rho) in units of the bound, two degrees of freedom
    std::vector<double> end_error;     // metres along the line
    std::vector<double> corner_error;  // metres

    void add(const Tally &other);

    double true_positive() const;  // per cent
    double false_positive() const; // per cent
    double error_rms() const;      // in units of the Cramer-Rao bound
    double error_median() const;
    double end_median() const; // metres
    double end_90() const;
    double corner_precision() const; // per cent
    double corner_recall() const;
    double corner_rms() const; // metres
};

Tally score(const Truth &truth, const Extraction &extraction);

// The corners of an extractor that gives none: two successive lines at 15 to 165 degrees, at most 5 beams
// apart, both of whose facing ends lie within 150 mm of where the lines meet.
std::vector<Point> derived_corners(const std::vector<Line> &lines);

} // namespace bench
