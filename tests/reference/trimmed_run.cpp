#include "reference/trimmed_run.h"

#include "reference/run_fit.h"

namespace reference
{
namespace
{

constexpr int most = 3;
constexpr double suspicious = 333.0 / 256; // chi square of a degree of freedom
constexpr double own_of_one = 10;          // own variances that one point given up must bring,
constexpr double own_of_next = 4;          // each further one,
constexpr double shared_of_each = 12;      // and shared ones each

int points_to_trim(const ScanPoints &points, const RunFit &fit, Run run, bool at_first, int least_points,
                   Decisions &decisions)
{
    int best = 0;
    double largest = 0;
    for (int k = 1; k <= most && 2 * k <= run.points() - least_points; k++) {
        const double rest = at_first ? sse_of_run(points, run.first + k, run.last)
                                     : sse_of_run(points, run.first, run.last - k);
        const double limit = (own_of_one + own_of_next * (k - 1)) * fit.var + shared_of_each * k * fit.shared;
        if (!decisions.below(fit.sse - rest, limit + largest)) {
            largest = fit.sse - rest - limit;
            best = k;
        }
    }
    return best;
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

} // namespace reference
