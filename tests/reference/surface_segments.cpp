#include "reference/surface_segments.h"

namespace reference
{
namespace
{

constexpr double own_deviations = 7;    // of one beam: 5 of the difference of two
constexpr double shared_deviations = 5; // of the part of the shared error that does not grow with range
constexpr int widest_gap = 8;           // beams

double change_per_beam(const ScanPoints &points, int i)
{
    if (i < 0 || i + 1 >= static_cast<int>(points.size())) {
        return 0;
    }
    const ScanPoint *p = &points[static_cast<size_t>(i)];
    return std::fabs(p[1].range - p[0].range) / (p[1].beam - p[0].beam);
}

} // namespace

// A wall seen at 45 degrees of incidence changes its range by range * step a beam. What exceeds that and the
// noise is a jump, unless both changes beside it are so large (two thirds of the excess) that the surface is
// merely steep.
bool is_jump(const ScanPoints &points, const NoiseOfScan &noise, double step, int after, Decisions &decisions)
{
    const ScanPoint *p = &points[static_cast<size_t>(after)];
    const int gap = p[1].beam - p[0].beam;
    if (gap > widest_gap) {
        return true;
    }
    const double range = std::min(p[0].range, p[1].range);
    const double own = std::sqrt(noise.own_constant) + std::sqrt(noise.own_relative) * range;
    const double allowed =
        own_deviations * own + shared_deviations * std::sqrt(noise.shared_constant) + gap * step * range;
    const double change = std::fabs(p[1].range - p[0].range);
    if (decisions.below(change, allowed)) {
        return false;
    }
    const double beside = std::min(change_per_beam(points, after - 1), change_per_beam(points, after + 1));
    return !decisions.below(change - allowed, 1.5 * gap * beside);
}

std::vector<Run> surface_segments(const ScanPoints &points, const NoiseOfScan &noise, double step,
                                  Decisions &decisions)
{
    std::vector<Run> segments;
    int first = 0;
    for (int i = 0; i < static_cast<int>(points.size()); i++) {
        if (i + 1 == static_cast<int>(points.size()) || is_jump(points, noise, step, i, decisions)) {
            segments.push_back({first, i});
            first = i + 1;
        }
    }
    return segments;
}

Run segment_of(const std::vector<Run> &segments, int i)
{
    return *std::find_if(segments.begin(), segments.end(),
                         [=](const Run &s) { return s.first <= i && i <= s.last; });
}

bool on_one_surface(const std::vector<Run> &segments, int i, int j)
{
    return std::any_of(segments.begin(), segments.end(),
                       [=](const Run &s) { return s.first <= i && j <= s.last; });
}

} // namespace reference
