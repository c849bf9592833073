#include "reference/trimmed_run.h"

#include <algorithm>

#include "reference/line_search.h"
#include "reference/run_fit.h"
#include "reference/surface_segments.h"

namespace reference
{
namespace
{

constexpr int most = 3;
constexpr double suspicious = 333.0 / 256; // chi square of a degree of freedom
constexpr double own_of_one = 10;          // own variances that one point given up must bring,
constexpr double own_of_next = 4;          // each further one,
constexpr double shared_of_each = 12;      // and shared ones each

double limit_of(const RunFit &fit, int k)
{
    return (own_of_one + own_of_next * (k - 1)) * fit.var + shared_of_each * k * fit.shared;
}

int points_to_trim(const ScanPoints &points, const RunFit &fit, Run run, bool at_first, int least_points,
                   Decisions &decisions)
{
    int best = 0;
    double largest = 0;
    for (int k = 1; k <= most && 2 * k <= run.points() - least_points; k++) {
        const double rest = at_first ? sse_of_run(points, run.first + k, run.last)
                                     : sse_of_run(points, run.first, run.last - k);
        const double limit = limit_of(fit, k);
        if (!decisions.below(fit.sse - rest, limit + largest)) {
            largest = fit.sse - rest - limit;
            best = k;
        }
    }
    return best;
}

int points_beyond(const std::vector<Run> &segments, const std::vector<Run> &others, Run run, bool at_first)
{
    const int end = at_first ? segment_of(segments, run.first).first : segment_of(segments, run.last).last;
    const int beyond = at_first ? run.first - end : end - run.last;
    const bool taken = std::any_of(others.begin(), others.end(), [&](const Run &other) {
        return at_first ? other.last < run.first && other.last >= end
                        : other.first > run.last && other.first <= end;
    });
    return beyond < least_run && !taken ? beyond : 0;
}

} // namespace

Run trimmed_run(const ScanPoints &points, const NoiseOfScan &noise, Run run, int least_points,
                Decisions &decisions)
{
    const RunFit fit = fit_run(points, noise, run.first, run.last);
    if (decisions.below(fit.chi(), suspicious * (fit.n - 2))) {
        return run;
    }
    return {run.first + points_to_trim(points, fit, run, true, least_points, decisions),
            run.last - points_to_trim(points, fit, run, false, least_points, decisions), run.curved};
}

Run with_points_beyond(const ScanPoints &points, const NoiseOfScan &noise, const std::vector<Run> &segments,
                       const std::vector<Run> &others, Run run, bool at_first, Decisions &decisions)
{
    const RunFit fit = fit_run(points, noise, run.first, run.last);
    for (int n = points_beyond(segments, others, run, at_first); n > 0; n /= 2) {
        const Run longer = {run.first - (at_first ? n : 0), run.last + (at_first ? 0 : n)};
        decisions.spend(1);
        if (decisions.below(sse_of_run(points, longer.first, longer.last) - fit.sse, limit_of(fit, n))) {
            return longer;
        }
    }
    return run;
}

} // namespace reference
