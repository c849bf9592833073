#include "reference/run_merge.h"

#include "reference/run_fit.h"
#include "reference/surface_segments.h"

namespace reference
{
namespace
{

constexpr double penalty = 19; // own variances that a second line must gain,
constexpr double peak = 3;     // and shared ones, where both lie on one surface, beside one for each point
constexpr int widest_gap_points = 8;
constexpr int widest_gap_beams = 8;

bool may_join(const ScanPoints &points, Run a, Run b)
{
    const int beams = points[static_cast<size_t>(b.first)].beam - points[static_cast<size_t>(a.last)].beam;
    return !a.curved && !b.curved && b.first - a.last <= widest_gap_points && beams <= widest_gap_beams;
}

} // namespace

double merge_ratio(const ScanPoints &points, const NoiseOfScan &noise, const std::vector<Run> &segments,
                   Run a, Run b)
{
    const RunFit one = fit_run(points, noise, a.first, b.last);
    const RunFit fa = fit_run(points, noise, a.first, a.last);
    const RunFit fb = fit_run(points, noise, b.first, b.last);
    const double n = fa.n + fb.n;
    const double var = std::max(one.var, (fa.var * fa.n + fb.var * fb.n) / n);
    const double shared = std::max(one.shared, (fa.shared * fa.n + fb.shared * fb.n) / n);
    const double together =
        on_one_surface(segments, a.last, b.first) ? peak * points_together(noise, one.n) : 0;
    return (one.sse - fa.sse - fb.sse) / (penalty * var + shared * (one.n + together));
}

std::vector<Run> merged_runs(const ScanPoints &points, const NoiseOfScan &noise,
                             const std::vector<Run> &segments, std::vector<Run> runs, Decisions &decisions)
{
    for (;;) {
        size_t best = 0;
        double least = HUGE_VAL;
        double second = HUGE_VAL;
        for (size_t k = 0; k + 1 < runs.size(); k++) {
            if (may_join(points, runs[k], runs[k + 1])) {
                const double ratio = merge_ratio(points, noise, segments, runs[k], runs[k + 1]);
                if (ratio < least) {
                    second = least;
                    least = ratio;
                    best = k;
                } else {
                    second = std::min(second, ratio);
                }
            }
        }
        if (least == HUGE_VAL || !decisions.below(least, 1)) {
            return runs;
        }
        if (second < 1) {
            decisions.below(least, second);
        }
        runs[best] = {runs[best].first, runs[best + 1].last};
        runs.erase(runs.begin() + static_cast<long>(best) + 1);
    }
}

} // namespace reference
