// Twin of the placing and finding of breaks in lib/extract/breakpoint.c and runs.c.
#ifndef ALE_TESTS_REFERENCE_JOINT_BREAK_H
#define ALE_TESTS_REFERENCE_JOINT_BREAK_H

#include "reference/decisions.h"
#include "reference/scan_points.h"

namespace reference
{

// First steps of the search for a break: where it is known from a search alone, and where it was placed
// before.
constexpr int wide_step = 8;
constexpr int fine_step = 1;

// Squared residuals of the lines through first..split and split+1..last, in units of two variances.
double joint_chi(const ScanPoints &points, Run both, int split, double var_a, double var_b);

struct BreakRange {
    int lowest;
    int highest;
    int start;
    int direction;   // in which the points are read
    int widest_step; // first step of the search
};

// The break of least joint chi square by a pattern search from range.start: up to four steps of the widest
// width to the better side, then of half of it, down to 1. From there to where the lines that part there
// meet, unless that has a chi square larger by more than 6, and up to twice more from there. Where no break
// is allowed: range.start.
int placed_break(const ScanPoints &points, const NoiseOfScan &noise, Run a, Run b, const BreakRange &range,
                 Decisions &decisions);

// What a break where two lines meet may fit worse than the best one.
constexpr double meeting_loss = 12;

// The break of least joint chi square of all from lowest to highest.
int best_break(const ScanPoints &points, const NoiseOfScan &noise, Run a, Run b, int lowest, int highest);

// Breaks where two runs may part: both keep enough points, whatever their other ends do.
BreakRange range_between(const ScanPoints &points, Run a, Run b, int widest_step);

// Residual sums of runs, and suspects, after which no pass over the runs is begun.
constexpr int most_effort = 840;

// The widest step with which the effort left is enough to place breaks again, or 0.
int affordable_step(const std::vector<Run> &segments, const std::vector<Run> &runs, int widest_step,
                    int effort_left);

// Places the breaks between runs that meet on one surface and are not both settled, all from the same state.
std::vector<Run> placed_runs(const ScanPoints &points, const NoiseOfScan &noise,
                             const std::vector<Run> &segments, std::vector<Run> runs, int widest_step,
                             Decisions &decisions);

// The best of the breaks at ninths of a run, by the squared residuals of both lines.
struct CoarseBreak {
    int split; // -1: no room for two runs
    double sse;
};
CoarseBreak coarse_break(const ScanPoints &points, Run run, int direction, Decisions &decisions);

// The break that makes two lines of a run which explain it better by more than noise would, or -1.
int found_break(const ScanPoints &points, const NoiseOfScan &noise, const std::vector<Run> &segments, Run run,
                Decisions &decisions);

// Splits the runs that have such a break and are not known to have none; of many that may only the longest.
std::vector<Run> split_runs(const ScanPoints &points, const NoiseOfScan &noise,
                            const std::vector<Run> &segments, const std::vector<Run> &runs,
                            Decisions &decisions);

// Long runs split at their sharpest step, where noise makes none so sharp; all runs once.
std::vector<Run> split_at_steps(const ScanPoints &points, const NoiseOfScan &noise,
                                const std::vector<Run> &runs, Decisions &decisions);

} // namespace reference

#endif
