// What the twins of lib/extract work on: the valid beams of one scan in millimetres and radians, double.
#ifndef ALE_TESTS_REFERENCE_SCAN_POINTS_H
#define ALE_TESTS_REFERENCE_SCAN_POINTS_H

#include <cstddef>
#include <vector>

namespace reference
{

struct ScanPoint {
    int beam;
    double range;
    double x;
    double y;
};

using ScanPoints = std::vector<ScanPoint>;

// Points first..last, both included.
struct Run {
    int first;
    int last;
    bool curved = false;
    bool no_break = false; // looked at: one line explains it as well as two
    bool settled = false;  // its ends have hardly moved when they were placed
    bool no_arc = false;   // looked at: lines explain it better than a circle

    int points() const
    {
        return last - first + 1;
    }
};

inline bool operator==(const Run &a, const Run &b)
{
    return a.first == b.first && a.last == b.last && a.curved == b.curved;
}

// Variance of a range r: constant + relative * r^2; the part of each beam's own, and the part that neighbours
// share over shared_beams.
struct NoiseOfScan {
    double own_constant = 0;
    double own_relative = 0;
    double own_scale = 1; // of both, from the residuals of the runs
    double shared_constant = 0;
    double shared_relative = 0;
    double shared_beams = 12;
    double bearing_variance = 0;
    double shared_stated = 1;   // part of the shared variances that the covariance of lines has
    bool shared_absent = false; // measured, and there is none
    bool shared_found = false;  // measured, and there is one
    bool unruly = false;        // more changes of the range are suspicious than surfaces make
    bool costly = false;        // unruly, or hard to search: less is tried

    double own(double range) const
    {
        return own_constant + own_relative * range * range;
    }
    double shared(double range) const
    {
        return shared_constant + shared_relative * range * range;
    }
};

// Fewer than three in four points have the next beam for a neighbour.
inline bool is_sparse(const ScanPoints &points)
{
    double neighbours = 0;
    for (std::size_t i = 1; i < points.size(); i++) {
        neighbours += points[i].beam - points[i - 1].beam == 1 ? 1 : 0;
    }
    return neighbours < 0.75 * static_cast<double>(points.size());
}

} // namespace reference

#endif
