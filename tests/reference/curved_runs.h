// Twin of lib/extract/curve.c and circle.c: runs and chains of runs that lie on a circle.
#ifndef ALE_TESTS_REFERENCE_CURVED_RUNS_H
#define ALE_TESTS_REFERENCE_CURVED_RUNS_H

#include "reference/decisions.h"
#include "reference/scan_points.h"

namespace reference
{

struct Circle {
    double x;
    double y;
    double radius; // 0: none
};

// Least squares of x^2 + y^2 - 2 a x - 2 b y - c (Kasa).
Circle circle_through(const ScanPoints &points, int first, int last);

// How far the middle third of a run lies off the chord of the outer thirds, to the left of it, in deviations.
double bulge_of(const ScanPoints &points, const NoiseOfScan &noise, Run run);

// Marks the runs that lie on curves and joins those of one curve. again: they were looked for before.
std::vector<Run> with_curves(const ScanPoints &points, const NoiseOfScan &noise,
                             const std::vector<Run> &segments, std::vector<Run> runs, bool again,
                             Decisions &decisions);

} // namespace reference

#endif
