#include "reference/joint_break.h"

#include <algorithm>
#include <Eigen/Dense>

#include "reference/line_search.h"
#include "reference/run_fit.h"
#include "reference/run_merge.h"
#include "reference/surface_segments.h"
#include "reference/trimmed_run.h"

namespace reference
{
namespace
{

constexpr int widest_gap = 8; // points between runs that meet
constexpr int grid = 9;
constexpr int least_to_split = 16;
constexpr size_t most_tried = 12;          // runs that are tried for a break
constexpr double suspicious = 236.0 / 256; // of the chi square that noise alone makes,
constexpr double suspicious_sum = 3;       // and beyond it
constexpr int most_meetings = 3;
constexpr int fine_effort = 8;      // of a break that is placed from a narrow step on, in residual sums,
constexpr int wide_effort = 16;     // and from a wide one
constexpr int placing_credit = 120; // by which both may exceed the effort that is left
constexpr int settled_part = 10;    // of its points that a settled run may gain or lose
constexpr double promising = 100.0 / 256;
constexpr int step_windows = 4; // of a run that is looked at for a step
constexpr double step_deviations = 4.75;

// Points that a run may give away at one end while the other end gives some too.
int spare_points(Run run)
{
    return std::max(0, run.points() - least_run) / 2;
}

// The last point of all from lowest to highest on the near side of where the lines through first..split and
// split + 1..last meet, seen from the sensor; -1 when they do not meet there.
int meeting_point(const ScanPoints &points, const NoiseOfScan &noise, Run both, int split,
                  const BreakRange &range)
{
    const RunFit a = fit_run(points, noise, both.first, split);
    const RunFit b = fit_run(points, noise, split + 1, both.last);
    const Eigen::Vector2d wa(std::cos(a.alpha), std::sin(a.alpha));
    const Eigen::Vector2d wb(std::cos(b.alpha), std::sin(b.alpha));
    // along a ray u the line n u r = rho is rho / (n u) away
    const auto a_is_nearer = [&](int k) {
        const ScanPoint &p = points[static_cast<size_t>(k)];
        return Eigen::Vector2d(p.x, p.y).dot(a.rho * wb - b.rho * wa) < 0;
    };
    const bool at_lowest = a_is_nearer(range.lowest);
    if (at_lowest == a_is_nearer(range.highest + 1)) {
        return -1;
    }
    int meeting = range.lowest;
    while (a_is_nearer(meeting + 1) == at_lowest) {
        meeting++;
    }
    return meeting;
}

bool may_move(const std::vector<Run> &segments, Run a, Run b)
{
    return !(a.settled && b.settled) && b.first - a.last <= widest_gap && !a.curved && !b.curved &&
           on_one_surface(segments, a.last, b.first);
}

bool is_suspicious(const ScanPoints &points, const NoiseOfScan &noise, Run run, Decisions &decisions)
{
    const RunFit one = fit_run(points, noise, run.first, run.last);
    return !run.curved && !decisions.below(one.chi(), suspicious * (run.points() - 2) + suspicious_sum);
}

// Of many suspicious runs only the longest are tried: the fewest points that they have.
int least_points_to_try(const ScanPoints &points, const NoiseOfScan &noise, const std::vector<Run> &runs)
{
    const size_t room = many_runs - std::min(runs.size(), many_runs);
    const size_t most = std::min(noise.costly ? most_tried / 3 : most_tried, room);
    const auto tried = [&](int least) {
        Decisions ignored;
        return static_cast<size_t>(std::count_if(runs.begin(), runs.end(), [&](const Run &run) {
            return !run.no_break && run.points() >= least && is_suspicious(points, noise, run, ignored);
        }));
    };
    int least = least_to_split;
    while (least <= static_cast<int>(points.size()) && tried(least) > most) {
        least += least / 4;
    }
    return least;
}

// Shared variances of the difference of the means of two adjoining windows.
double shared_in_step(const NoiseOfScan &noise, int window)
{
    double sum = 0;
    for (int i = 0; i < window; i++) {
        for (int j = 0; j < window; j++) {
            sum += std::exp(-std::abs(i - j) / noise.shared_beams) -
                   std::exp(-(window + j - i) / noise.shared_beams);
        }
    }
    return 2 * sum / window / window;
}

// The point after which a run has its sharpest step, or -1.
int step_of_run(const ScanPoints &points, const NoiseOfScan &noise, Run run, Decisions &decisions)
{
    const int window = static_cast<int>(noise.shared_beams);
    if (run.curved || run.points() < step_windows * window) {
        return -1;
    }
    const RunFit fit = fit_run(points, noise, run.first, run.last);
    const int direction = reading_direction(points, run.first, run.last);
    const auto mean = [&](int first) {
        double sum = 0;
        for (int i = first; i < first + window; i++) {
            const ScanPoint &p = points[static_cast<size_t>(i)];
            sum += p.x * std::cos(fit.alpha) + p.y * std::sin(fit.alpha);
        }
        return sum / window;
    };
    int best = -1;
    double most = 0;
    for (int k = window - 1; k + window <= run.last - run.first; k++) {
        const int split = direction > 0 ? run.first + k : run.last - 1 - k;
        const double step = std::fabs(mean(split + 1) - mean(split + 1 - window));
        if (step > most) {
            most = step;
            best = split;
        }
    }
    const double var = 2 * fit.var / window + fit.shared * shared_in_step(noise, window);
    return decisions.below(most, step_deviations * std::sqrt(var)) ? -1 : best;
}

} // namespace

BreakRange range_between(const ScanPoints &points, Run a, Run b, int widest_step)
{
    const int direction = reading_direction(points, a.first, b.last);
    return {a.last - spare_points(a), b.first - 1 + spare_points(b), direction > 0 ? a.last : b.first - 1,
            direction, widest_step};
}

double joint_chi(const ScanPoints &points, Run both, int split, double var_a, double var_b)
{
    return sse_of_run(points, both.first, split) / var_a + sse_of_run(points, split + 1, both.last) / var_b;
}

int best_break(const ScanPoints &points, const NoiseOfScan &noise, Run a, Run b, int lowest, int highest)
{
    const double var_a = fit_run(points, noise, a.first, a.last).var;
    const double var_b = fit_run(points, noise, b.first, b.last).var;
    int best = lowest;
    double least = HUGE_VAL;
    for (int k = lowest; k <= highest; k++) {
        const double chi = joint_chi(points, {a.first, b.last}, k, var_a, var_b);
        if (chi < least) {
            least = chi;
            best = k;
        }
    }
    return best;
}

int placed_break(const ScanPoints &points, const NoiseOfScan &noise, Run a, Run b, const BreakRange &range,
                 Decisions &decisions)
{
    if (range.lowest > range.highest) {
        return range.start;
    }
    const double var_a = fit_run(points, noise, a.first, a.last).var;
    const double var_b = fit_run(points, noise, b.first, b.last).var;
    const auto chi_at = [&](int k) {
        decisions.spend(2);
        return joint_chi(points, {a.first, b.last}, k, var_a, var_b);
    };
    int best = std::clamp(range.start, range.lowest, range.highest);
    int came_from = -1;
    double least = chi_at(best);
    for (int step = range.widest_step; step > 0; step /= 2) {
        for (int tries = 0; tries < 4; tries++) {
            const int centre = best;
            for (const int k : {centre - range.direction * step, centre + range.direction * step}) {
                if (k < range.lowest || k > range.highest || k == came_from) {
                    continue;
                }
                const double chi = chi_at(k);
                if (decisions.below(chi, least) && chi < least) {
                    least = chi;
                    best = k;
                }
            }
            if (best == centre) {
                break;
            }
            came_from = centre;
        }
    }
    for (int k = 0; k < most_meetings; k++) {
        const int meeting = meeting_point(points, noise, {a.first, b.last}, best, range);
        if (meeting < 0 || meeting == best || !decisions.below(chi_at(meeting), least + meeting_loss)) {
            break;
        }
        const bool moved_on = std::abs(meeting - best) > 1;
        best = meeting;
        if (!moved_on) {
            break;
        }
    }
    return best;
}

int affordable_step(const std::vector<Run> &segments, const std::vector<Run> &runs, int widest_step,
                    int effort_left)
{
    int breaks = 0;
    for (size_t k = 0; k + 1 < runs.size(); k++) {
        breaks += may_move(segments, runs[k], runs[k + 1]) ? 1 : 0;
    }
    if (effort_left < 0 || breaks * fine_effort > effort_left + placing_credit) {
        return 0;
    }
    return breaks * wide_effort > effort_left + placing_credit ? fine_step : widest_step;
}

std::vector<Run> placed_runs(const ScanPoints &points, const NoiseOfScan &noise,
                             const std::vector<Run> &segments, std::vector<Run> runs, int widest_step,
                             Decisions &decisions)
{
    const std::vector<Run> before = runs;
    for (size_t k = 0; k + 1 < runs.size(); k++) {
        if (may_move(segments, before[k], before[k + 1])) {
            const BreakRange range = range_between(points, before[k], before[k + 1], widest_step);
            const int split = placed_break(points, noise, before[k], before[k + 1], range, decisions);
            runs[k].last = split;
            runs[k + 1].first = split + 1;
        }
    }
    for (size_t k = 0; k < runs.size(); k++) {
        const int moved = std::abs(runs[k].first - before[k].first) + std::abs(runs[k].last - before[k].last);
        runs[k].no_break = before[k].no_break && moved == 0;
        runs[k].no_arc = before[k].no_arc && moved == 0;
        runs[k].settled = moved * settled_part <= runs[k].points();
    }
    return runs;
}

CoarseBreak coarse_break(const ScanPoints &points, Run run, int direction, Decisions &decisions)
{
    CoarseBreak best = {-1, HUGE_VAL};
    const int n = run.points();
    for (int j = 1; j < grid; j++) {
        const int near_part = 2 * j <= grid ? n * j / grid : n - n * (grid - j) / grid;
        const int split = direction > 0 ? run.first + near_part - 1 : run.last - near_part;
        if (near_part < least_run || n - near_part < least_run) {
            continue;
        }
        decisions.spend(2);
        const double sse = sse_of_run(points, run.first, split) + sse_of_run(points, split + 1, run.last);
        if (decisions.below(sse, best.sse) && sse < best.sse) {
            best = {split, sse};
        }
    }
    return best;
}

int found_break(const ScanPoints &points, const NoiseOfScan &noise, const std::vector<Run> &segments, Run run,
                Decisions &decisions)
{
    const int direction = reading_direction(points, run.first, run.last);
    const auto ratio_at = [&](int split) {
        return merge_ratio(points, noise, segments, {run.first, split}, {split + 1, run.last});
    };
    const CoarseBreak coarse = coarse_break(points, run, direction, decisions);
    if (coarse.split < 0 || decisions.below(ratio_at(coarse.split), promising)) {
        return -1;
    }
    const BreakRange range = {run.first + least_run - 1, run.last - least_run, coarse.split, direction,
                              wide_step};
    const int split = placed_break(points, noise, {run.first, coarse.split}, {coarse.split + 1, run.last},
                                   range, decisions);
    return decisions.below(ratio_at(split), 1) ? -1 : split;
}

std::vector<Run> split_runs(const ScanPoints &points, const NoiseOfScan &noise,
                            const std::vector<Run> &segments, const std::vector<Run> &runs,
                            Decisions &decisions)
{
    std::vector<Run> split_runs;
    const int least = least_points_to_try(points, noise, runs);
    for (const Run &run : runs) {
        const bool tried = !run.no_break && run.points() >= least;
        const int split = tried && is_suspicious(points, noise, run, decisions)
                              ? found_break(points, noise, segments, run, decisions)
                              : -1;
        if (split < 0) {
            split_runs.push_back(run);
            split_runs.back().no_break = run.no_break || (tried && !run.curved);
        } else {
            Run a = {run.first, split};
            Run b = {split + 1, run.last};
            if (!noise.shared_found) {
                a = with_points_beyond(points, noise, segments, runs, a, true, decisions);
                b = with_points_beyond(points, noise, segments, runs, b, false, decisions);
            }
            split_runs.push_back(a);
            split_runs.push_back(b);
        }
    }
    return split_runs;
}

std::vector<Run> split_at_steps(const ScanPoints &points, const NoiseOfScan &noise,
                                const std::vector<Run> &runs, Decisions &decisions)
{
    std::vector<Run> split_runs;
    for (const Run &run : runs) {
        const int split = step_of_run(points, noise, run, decisions);
        if (split < 0) {
            split_runs.push_back(run);
        } else {
            split_runs.push_back({run.first, split});
            split_runs.push_back({split + 1, run.last});
        }
    }
    return split_runs;
}

} // namespace reference
