#include "reference/extraction.h"

#include <Eigen/Dense>

#include "reference/corner_of_lines.h"
#include "reference/curved_runs.h"
#include "reference/joint_break.h"
#include "reference/line_search.h"
#include "reference/run_fit.h"
#include "reference/run_merge.h"
#include "reference/scan_noise.h"
#include "reference/stray_points.h"
#include "reference/surface_segments.h"
#include "reference/trimmed_run.h"

namespace reference
{
namespace
{

constexpr double pi = 3.14159265358979323846;
constexpr double rough_own = 1.5;   // the measured noise errs too
constexpr double rough_shared = 12; // shared variances that a long wall may be wavy by,
constexpr double rough_reaches = 4; // and the reaches of the shared error from which on it is a long one
constexpr double calmer = 64000.0 / 65536; // change of the own noise from which on breaks may show
constexpr double most_sigma_alpha = 8 * pi / 180;
constexpr int corner_gap = 5;        // beams
constexpr double corner_reach = 150; // mm
constexpr double overshoot = 2;      // deviations of both walls and a beam's width
const double corner_least_sine = std::sin(15 * pi / 180);

struct Prepared {
    ScanPoints points;
    std::vector<Run> segments;
    NoiseOfScan noise;
    int suspects = 0; // changes of the range
    double frame = 0; // direction of the points' x axis in the sensor's frame
};

// Both chains decide on the same points: on the grid of 1/16 mm, in a frame midway between the outer beams.
void lay_on_grid(Prepared &p, const ExtractionSettings &settings)
{
    if (p.points.empty()) {
        return;
    }
    p.frame = settings.first_bearing + settings.step * (p.points.front().beam + p.points.back().beam) / 2;
    for (ScanPoint &point : p.points) {
        const double bearing = settings.first_bearing + settings.step * point.beam - p.frame;
        point.x = std::round(point.range * std::cos(bearing) * 16) / 16;
        point.y = std::round(point.range * std::sin(bearing) * 16) / 16;
    }
}

Prepared prepare(const ScanPoints &valid, const ExtractionSettings &settings, Decisions &decisions)
{
    Prepared p;
    p.noise = own_noise(valid, settings.prior, settings.step);
    p.noise.unruly = is_unruly(valid, p.noise);
    p.suspects = suspects(valid, p.noise);
    p.points = without_spikes(valid, p.noise, settings.step, decisions);
    p.segments = surface_segments(p.points, p.noise, settings.step, decisions);
    p.points = without_strays(p.points, p.segments);
    p.segments = surface_segments(p.points, p.noise, settings.step, decisions);
    lay_on_grid(p, settings);
    return p;
}

std::vector<Run> search(Prepared &p, Decisions &decisions)
{
    const Search search = search_segments(p.points, p.noise, p.segments, decisions);
    p.noise.costly = search.costly(p.noise);
    return search.runs;
}

bool is_clutter(const Prepared &p, const std::vector<Run> &runs)
{
    return runs.size() > (p.noise.costly ? many_runs / 3 : many_runs);
}

std::vector<Run> searched_runs(Prepared &p, const ExtractionSettings &settings, Decisions &decisions)
{
    const std::vector<Run> runs = search(p, decisions);
    const SharedNoise shared = shared_noise(p.points, p.noise, runs, settings.step, decisions);
    p.noise.shared_constant *= shared.scale;
    p.noise.shared_relative *= shared.scale;
    p.noise.shared_absent = shared.absent;
    p.noise.shared_found = shared.scale > 1;
    p.noise.shared_stated = shared.scale > 1 ? shared.stated / shared.scale : 1;
    return shared.scale > 1 && !p.noise.costly ? search(p, decisions) : runs;
}

// Of clutter, to bound the work: its longer runs, of more than a room has the longest, of equally long ones
// those in the middle, joined where they are one line.
std::vector<Run> improved_clutter(const Prepared &p, const std::vector<Run> &runs, int least,
                                  Decisions &decisions)
{
    const int count = static_cast<int>(p.points.size());
    const auto rank = [count](const Run &run) {
        return std::pair(run.points(), -std::abs(run.first + run.last + 1 - count));
    };
    std::vector<std::pair<int, int>> ranks;
    for (const Run &run : runs) {
        ranks.push_back(rank(run));
    }
    std::sort(ranks.rbegin(), ranks.rend());
    std::vector<Run> longer;
    for (const Run &run : runs) {
        if (run.points() >= least && (ranks.size() < many_runs || rank(run) >= ranks[many_runs - 1])) {
            longer.push_back(run);
        }
    }
    return merged_runs(p.points, p.noise, p.segments, longer, decisions);
}

// By residuals, which a shared error would be part of. Where it has become less runs are tried for a break
// again.
void refine_own_noise(Prepared &p, std::vector<Run> &runs, Decisions &decisions)
{
    if (p.noise.shared_found) {
        return;
    }
    const double before = p.noise.own_scale;
    p.noise.own_scale = own_scale(p.points, p.noise, runs, decisions);
    if (p.noise.own_scale < calmer * before) {
        for (Run &run : runs) {
            run.no_break = false;
        }
    }
}

int effort_left(const Prepared &p, const Decisions &decisions)
{
    return most_effort - p.suspects - decisions.spent();
}

// Until a round changes nothing or the effort is spent, two at most.
std::vector<Run> split_in_rounds(Prepared &p, std::vector<Run> runs, Decisions &decisions)
{
    const int rounds = p.noise.shared_found || p.noise.costly ? 1 : 2;
    bool changed = true;
    for (int round = 0; changed && round < rounds && effort_left(p, decisions) >= 0; round++) {
        const size_t before = runs.size();
        runs = split_runs(p.points, p.noise, p.segments, runs, decisions);
        const size_t split = runs.size();
        runs = merged_runs(p.points, p.noise, p.segments, runs, decisions);
        changed = split > before || runs.size() < split;
        const int step =
            affordable_step(p.segments, runs, round == 0 ? fine_step : wide_step, effort_left(p, decisions));
        if (step == 0) {
            break;
        }
        runs = placed_runs(p.points, p.noise, p.segments, runs, step, decisions);
        if (changed) {
            refine_own_noise(p, runs, decisions);
        }
    }
    return runs;
}

std::vector<Run> improved_runs(Prepared &p, const ExtractionSettings &settings, std::vector<Run> runs,
                               Decisions &decisions)
{
    if (is_clutter(p, runs)) {
        refine_own_noise(p, runs, decisions);
        return improved_clutter(p, runs, settings.least_points * 4 / 3, decisions);
    }
    runs = merged_runs(p.points, p.noise, p.segments, runs, decisions);
    runs = placed_runs(p.points, p.noise, p.segments, runs, wide_step, decisions);
    refine_own_noise(p, runs, decisions);
    runs = with_curves(p.points, p.noise, p.segments, runs, false, decisions);
    runs = split_in_rounds(p, runs, decisions);
    if (effort_left(p, decisions) >= 0) {
        runs = with_curves(p.points, p.noise, p.segments, runs, true, decisions);
    }
    const size_t before = runs.size();
    if (p.noise.shared_found) {
        runs = split_at_steps(p.points, p.noise, runs, decisions);
    }
    const int step =
        runs.size() > before ? affordable_step(p.segments, runs, wide_step, effort_left(p, decisions)) : 0;
    return step > 0 ? placed_runs(p.points, p.noise, p.segments, runs, step, decisions) : runs;
}

// How many of n points err together in the slope of their line: the quadratic form of the correlations
// exp(-|i - j| / shared_beams) with their places along the line.
double together_in_slope(const NoiseOfScan &noise, int n)
{
    double form = 0;
    double squares = 0;
    for (int i = 0; i < n; i++) {
        const double u = i - (n - 1) / 2.0;
        squares += u * u;
        for (int j = 0; j < n; j++) {
            form += u * (j - (n - 1) / 2.0) * std::exp(-std::abs(i - j) / noise.shared_beams);
        }
    }
    return form / squares;
}

// Where the beam of a point meets the line, or the point's foot where the two are almost parallel.
Eigen::Vector2d end_on_line(const ScanPoint &point, const RunFit &fit)
{
    const Eigen::Vector2d p(point.x, point.y);
    const Eigen::Vector2d normal(std::cos(fit.alpha), std::sin(fit.alpha));
    const double off = fit.rho - normal.dot(p);
    return std::fabs(off) * 8 < normal.dot(p) ? Eigen::Vector2d(p * fit.rho / normal.dot(p))
                                              : Eigen::Vector2d(p + off * normal);
}

// Squared residuals that a line may have. What neighbours share bends a short line hardly at all.
double rough_limit(const NoiseOfScan &noise, const RunFit &fit)
{
    const double n2 = static_cast<double>(fit.n) * fit.n;
    const double bent = n2 / (n2 + std::pow(rough_reaches * noise.shared_beams, 2));
    return rough_own * fit.var * chi_limit(fit.n, chi_high_z) + rough_shared * fit.shared * fit.n * bent;
}

bool is_wall(const Prepared &p, const ExtractionSettings &settings, Run run, Decisions &decisions)
{
    const RunFit fit = fit_run(p.points, p.noise, run.first, run.last);
    return fit.n >= settings.least_points && decisions.below(fit.sse, rough_limit(p.noise, fit));
}

bool is_line(const Prepared &p, const ExtractionSettings &settings, Run run, const RunFit &fit,
             Decisions &decisions)
{
    const Eigen::Vector2d start = end_on_line(p.points[static_cast<size_t>(run.first)], fit);
    const Eigen::Vector2d end = end_on_line(p.points[static_cast<size_t>(run.last)], fit);
    const double shared =
        p.noise.shared_absent ? 0 : p.noise.shared_stated * fit.shared * together_in_slope(p.noise, fit.n);
    const double var_alpha = (fit.var + shared) / fit.along2;
    return !decisions.below((end - start).norm(), settings.least_length) &&
           decisions.below(std::sqrt(var_alpha), most_sigma_alpha);
}

double cross(const Eigen::Vector2d &a, const Eigen::Vector2d &b)
{
    return a.x() * b.y() - a.y() * b.x();
}

double deviation(const RunFit &fit)
{
    return std::sqrt(fit.sse / std::max(fit.n - 2, 1));
}

// A wall that was seen beyond the corner, off the other one by more than noise, does not end there.
bool ends_at_corner(const RunFit &a, const RunFit &b, const Eigen::Vector2d &end,
                    const Eigen::Vector2d &start, int beams, const Eigen::Vector2d &corner,
                    Decisions &decisions)
{
    const auto off = [](const RunFit &fit, const Eigen::Vector2d &p) {
        return std::fabs(p.x() * std::cos(fit.alpha) + p.y() * std::sin(fit.alpha) - fit.rho);
    };
    const double turn = cross(end, start);
    const double distance = turn * cross(end, corner) < 0     ? off(b, end)
                            : turn * cross(corner, start) < 0 ? off(a, start)
                                                              : 0;
    const double width = std::fabs(turn) / corner.norm() / beams;
    return decisions.below(distance, overshoot * (deviation(a) + deviation(b) + width));
}

void find_corners(const Prepared &p, Extraction &out)
{
    for (size_t k = 0; k + 1 < out.lines.size(); k++) {
        const ExtractedLine &a = out.lines[k];
        const ExtractedLine &b = out.lines[k + 1];
        if (b.first - a.last > corner_gap ||
            out.decisions.below(std::fabs(std::sin(b.alpha - a.alpha)), corner_least_sine)) {
            continue;
        }
        const RunFit fit_a = fit_run(p.points, p.noise, a.run.first, a.run.last);
        const RunFit fit_b = fit_run(p.points, p.noise, b.run.first, b.run.last);
        const Eigen::Vector2d corner = corner_of_lines({a.alpha, a.rho, Eigen::Matrix2d::Zero()},
                                                       {b.alpha, b.rho, Eigen::Matrix2d::Zero()})
                                           .p;
        const Eigen::Vector2d end = end_on_line(p.points[static_cast<size_t>(a.run.last)], fit_a);
        const Eigen::Vector2d start = end_on_line(p.points[static_cast<size_t>(b.run.first)], fit_b);
        if (out.decisions.below((corner - end).norm(), corner_reach) &&
            out.decisions.below((corner - start).norm(), corner_reach) &&
            ends_at_corner(fit_a, fit_b, end, start, b.first - a.last, corner, out.decisions)) {
            out.corners.push_back(static_cast<int>(k));
        }
    }
}

} // namespace

Extraction extract(const ScanPoints &valid, const ExtractionSettings &settings)
{
    Extraction out;
    Prepared p = prepare(valid, settings, out.decisions);
    const std::vector<Run> runs =
        improved_runs(p, settings, searched_runs(p, settings, out.decisions), out.decisions);
    const auto beams_of = [&](const Run &run) {
        return Run{p.points[static_cast<size_t>(run.first)].beam,
                   p.points[static_cast<size_t>(run.last)].beam, run.curved};
    };
    for (const Run &found : runs) {
        if (found.curved) {
            out.curves.push_back(beams_of(found));
            continue;
        }
        if (!is_wall(p, settings, found, out.decisions)) {
            continue;
        }
        const Run run = trimmed_run(p.points, p.noise, found, settings.least_points, out.decisions);
        const Run beams = beams_of(run);
        const RunFit fit = fit_run(p.points, p.noise, run.first, run.last);
        if (is_line(p, settings, run, fit, out.decisions)) {
            out.lines.push_back({beams.first, beams.last, fit.alpha, fit.rho, run});
        }
    }
    find_corners(p, out);
    for (ExtractedLine &line : out.lines) {
        line.alpha += p.frame;
    }
    out.noise = p.noise;
    return out;
}

} // namespace reference
