#include "reference/line_search.h"

#include <algorithm>

#include "reference/run_fit.h"

namespace reference
{
namespace
{

constexpr double shared_share = 2; // shared variances that a point adds in the mean,
constexpr double shared_peak = 6;  // and those by which points that err together may be off besides
constexpr double floating_factor = 1.5;
constexpr int costly_reach = 2; // times the points accepted that a costly scan is tried for before a refusal
constexpr int costly_run = 12;
constexpr int costly_step = 4; // to the next try where there is no line
constexpr int many_fits = 144;
constexpr int fit_effort = 2; // in residual sums of runs

// Squared residuals that n points of a true line may have.
double allowed(const NoiseOfScan &noise, const RunFit &fit, int n, double chi)
{
    return fit.var * chi + fit.shared * (shared_share * n + shared_peak * points_together(noise, n));
}

// The bound floats: what the fit accepted last had, scaled to the longer run, but within the bounds that the
// noise model sets.
double floating_bound(const RunFit &accepted, int n)
{
    const double scaled =
        floating_factor * accepted.chi() * chi_limit(n, chi_high_z) / chi_limit(accepted.n, chi_high_z);
    return std::clamp(scaled, chi_limit(n, chi_low_z), chi_limit(n, chi_high_z));
}

// Value of the error, and its rate of increase: the error that the points added have brought.
bool acceptable(const NoiseOfScan &noise, const RunFit &fit, const RunFit &accepted, Decisions &decisions)
{
    const int added = fit.n - accepted.n + 2;
    return decisions.below(fit.sse, allowed(noise, fit, fit.n, floating_bound(accepted, fit.n))) &&
           decisions.below(fit.sse - accepted.sse, allowed(noise, fit, added, chi_limit(added, chi_high_z)));
}

} // namespace

bool Search::costly(const NoiseOfScan &noise) const
{
    return noise.unruly || fits > many_fits || runs.size() > many_runs;
}

int end_of_line(const ScanPoints &points, const NoiseOfScan &noise, int from, int to, Search &search,
                Decisions &decisions)
{
    const int direction = to >= from ? 1 : -1;
    const auto fit_to = [&](int count) {
        const int end = from + direction * (count - 1);
        search.fits++;
        decisions.spend(fit_effort);
        return fit_run(points, noise, std::min(from, end), std::max(from, end));
    };
    int good = search.costly(noise) ? costly_run : least_run;
    int bad = std::abs(to - from) + 2;
    if (good >= bad) {
        return from;
    }
    RunFit accepted = fit_to(good);
    if (!decisions.below(accepted.sse, allowed(noise, accepted, good, chi_limit(good, chi_high_z)))) {
        return from;
    }
    bool bracketed = !search.costly(noise);
    while (bad - good > 1) {
        const int half = (good - 1 + bad - 1) / 2; // beyond the first point
        const int count = (bracketed ? half : std::min(half, costly_reach * (good - 1))) + 1;
        const RunFit fit = fit_to(count);
        if (acceptable(noise, fit, accepted, decisions)) {
            good = count;
            accepted = fit;
        } else {
            bracketed = true;
            bad = count;
        }
    }
    return from + direction * (good - 1);
}

int reading_direction(const ScanPoints &points, int first, int last)
{
    while (first < last) {
        const double here = points[static_cast<size_t>(first++)].range;
        const double there = points[static_cast<size_t>(last--)].range;
        if (here != there) {
            return here < there ? 1 : -1;
        }
    }
    return 1;
}

Search search_segments(const ScanPoints &points, const NoiseOfScan &noise, const std::vector<Run> &segments,
                       Decisions &decisions)
{
    Search search;
    for (const Run &segment : segments) {
        const int direction = reading_direction(points, segment.first, segment.last);
        const int stop = direction > 0 ? segment.last : segment.first;
        const auto before = static_cast<std::ptrdiff_t>(search.runs.size());
        int from = direction > 0 ? segment.first : segment.last;
        while ((stop - from) * direction + 1 >= least_run) {
            const int end = end_of_line(points, noise, from, stop, search, decisions);
            if (end != from) {
                search.runs.push_back({std::min(from, end), std::max(from, end)});
            }
            from =
                end != from ? end + direction : from + direction * (search.costly(noise) ? costly_step : 1);
        }
        if (direction < 0) {
            std::reverse(search.runs.begin() + before, search.runs.end());
        }
    }
    return search;
}

} // namespace reference
