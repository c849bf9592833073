#include "reference/stray_points.h"

namespace reference
{
namespace
{

constexpr double deviations = 4;
constexpr int widest = 7; // beams from the second neighbour on one side to that on the other
constexpr int stray_points = 4;
constexpr double suspect_deviations = 3.5;
constexpr int widest_gap = 8; // beams
constexpr double unruly_share = 0.45;

} // namespace

int suspects(const ScanPoints &points, const NoiseOfScan &noise)
{
    int count = 0;
    for (size_t i = 0; i + 1 < points.size(); i++) {
        const double range = (points[i].range + points[i + 1].range) / 2;
        const double limit =
            suspect_deviations * (std::sqrt(noise.own_constant) + std::sqrt(noise.own_relative) * range);
        count += std::fabs(points[i + 1].range - points[i].range) > limit ||
                         points[i + 1].beam - points[i].beam > widest_gap
                     ? 1
                     : 0;
    }
    return count;
}

bool is_unruly(const ScanPoints &points, const NoiseOfScan &noise)
{
    const double beams =
        is_sparse(points) ? points.back().beam - points.front().beam + 1 : static_cast<double>(points.size());
    return suspects(points, noise) > unruly_share * beams;
}

// The line from the second neighbour to the second neighbour gives the slope; with it taken off, the point is
// off both neighbours by more than the limit, to the same side, and by nearly the same amount; and off where
// two neighbours on either side lead, unless the bearing errs more there than the range.
bool is_spike(const ScanPoints &points, const NoiseOfScan &noise, double step, int i, Decisions &decisions)
{
    if (i < 2 || i + 2 >= static_cast<int>(points.size())) {
        return false;
    }
    const ScanPoint *p = &points[static_cast<size_t>(i)];
    const double sigma = std::sqrt(noise.own_constant) + std::sqrt(noise.own_relative) * p->range;
    const double limit = deviations * sigma;
    const double slope = (p[2].range - p[-2].range) / 4;
    const double left = p->range - (p[-1].range + slope);
    const double right = p->range - (p[1].range - slope);
    if (p[2].beam - p[-2].beam > widest || left * right <= 0) {
        return false;
    }
    if (decisions.below(std::fabs(left), limit) || decisions.below(std::fabs(right), limit) ||
        !decisions.below(std::fabs(left - right), limit)) {
        return false;
    }
    const double off_before = std::fabs(p->range - 2 * p[-1].range + p[-2].range);
    const double off_after = std::fabs(p->range - 2 * p[1].range + p[2].range);
    const double bearing_error = std::fabs(slope / step) * std::sqrt(noise.bearing_variance);
    return !decisions.below(bearing_error, sigma) ||
           (!decisions.below(off_before, limit) && !decisions.below(off_after, limit));
}

ScanPoints without_spikes(const ScanPoints &points, const NoiseOfScan &noise, double step,
                          Decisions &decisions)
{
    if (noise.unruly) {
        return points; // where changes stand out everywhere no point does
    }
    ScanPoints kept;
    for (int i = 0; i < static_cast<int>(points.size()); i++) {
        if (!is_spike(points, noise, step, i, decisions)) {
            kept.push_back(points[static_cast<size_t>(i)]);
        }
    }
    return kept;
}

ScanPoints without_strays(const ScanPoints &points, const std::vector<Run> &segments)
{
    ScanPoints kept;
    for (const Run &segment : segments) {
        if (segment.points() > stray_points) {
            kept.insert(kept.end(), points.begin() + segment.first, points.begin() + segment.last + 1);
        }
    }
    return kept;
}

} // namespace reference
