// Line extractors as the literature describes them, written plainly: no noise model, thresholds in
// metres. After V. Nguyen, A. Martinelli, N. Tomatis, R. Siegwart, "A comparison of line extraction
// algorithms using 2D laser rangefinder for indoor mobile robotics", IROS 2005, and the sources it names.
//
// All start from the same clusters (cut where the distance jumps) and end with the same total least squares
// fit, the same smallest line, and the lines in the order of the beams.
#pragma once

#include <algorithm>
#include <vector>

#include "lab/bench/lines/extraction.hpp"

extern "C" {
#include "base/scan.h"
}

namespace bench::textbook
{

// Common to all. How the numbers in use were found is told in the README.
struct Setting {
    double threshold = 0.03;  // farthest a point may lie from its line ...
    double proportional = 0;  // ... or this share of its range, if that is more
    double jump = 0.1;        // distance of neighbours that begins a new cluster ...
    double jump_angle = 0.17; // ... or, on a slanted wall, the steepest incidence allowed (radians)
    int min_points = 8;
    double min_length = 0.12;

    double allowed(const Point &p) const
    {
        return std::max(threshold, proportional * p.norm());
    }
};

struct Beam {
    int index;
    Point p;
};

using Cluster = std::vector<Beam>;

// Inclusive range of positions in a cluster.
struct Run {
    std::size_t first;
    std::size_t last;
};

// The points of a scan, cut where the distance jumps; single stray points are left out.
std::vector<Cluster> cut_at_jumps(const ale_scan_t &scan, const Setting &setting);

// Total least squares over a run; constant cost per point.
NormalForm fit(const Cluster &cluster, const Run &run);

// The fitted line of a run, if it is long enough to be one.
void add_line(std::vector<Line> &lines, const Cluster &cluster, const Run &run, const Setting &setting);

void in_beam_order(std::vector<Line> &lines);

// Position in the run of the point that strays farthest from the line, in units of what is allowed.
struct Farthest {
    std::size_t at;
    double strays;
};
Farthest farthest_point(const Cluster &cluster, const Run &run, const NormalForm &line,
                        const Setting &setting);

// The line fitted to the run leaves no point farther away than allowed.
bool is_line(const Cluster &cluster, const Run &run, const Setting &setting);

// Points of the cluster within the threshold of the line, cut into runs without gaps.
std::vector<Run> runs_along(const Cluster &cluster, const std::vector<bool> &taken, const NormalForm &line,
                            const Setting &setting);

std::vector<Line> split_and_merge(const ale_scan_t &scan, const Setting &setting);
std::vector<Line> incremental(const ale_scan_t &scan, const Setting &setting);
std::vector<Line> ransac(const ale_scan_t &scan, const Setting &setting);
std::vector<Line> hough(const ale_scan_t &scan, const Setting &setting);
// Here the threshold bounds the root mean square, not the farthest point.
std::vector<Line> static_ale(const ale_scan_t &scan, const Setting &setting);
std::vector<Line> line_regression(const ale_scan_t &scan, const Setting &setting);

} // namespace bench::textbook
