// Twin of the search of lib/extract/breakpoint.c and runs.c: the paper's III.D, its listing corrected.
#ifndef ALE_TESTS_REFERENCE_LINE_SEARCH_H
#define ALE_TESTS_REFERENCE_LINE_SEARCH_H

#include "reference/decisions.h"
#include "reference/scan_points.h"

namespace reference
{

constexpr int least_run = 5;     // points
constexpr size_t many_runs = 24; // rooms have fewer

// A search and what it has cost: a costly one, of a scan that is unruly or not that of a room, tries less.
struct Search {
    std::vector<Run> runs;
    int fits = 0;

    bool costly(const NoiseOfScan &noise) const;
};

// The last point of the line that begins at `from`, searched by bisection towards `to`, or `from` where there
// is none.
int end_of_line(const ScanPoints &points, const NoiseOfScan &noise, int from, int to, Search &search,
                Decisions &decisions);

// +1 or -1: a segment is read from the end that lies nearer.
int reading_direction(const ScanPoints &points, int first, int last);

// The runs of all segments, in the order of the points.
Search search_segments(const ScanPoints &points, const NoiseOfScan &noise, const std::vector<Run> &segments,
                       Decisions &decisions);

} // namespace reference

#endif
