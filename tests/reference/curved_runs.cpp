#include "reference/curved_runs.h"

#include <Eigen/Dense>

#include "reference/joint_break.h"
#include "reference/line_search.h"
#include "reference/run_fit.h"
#include "reference/surface_segments.h"

namespace reference
{
namespace
{

constexpr int least_points = 6;
constexpr int widest_gap = 6; // points between runs of a chain
constexpr double suspect_bulge = 3;
constexpr size_t most_suspects = 12;
constexpr double bulge_of_each = 0.5; // deviations that every run of a chain must bring,
constexpr double bulge_of_all = 0;    // and the chain beyond that
constexpr double chi_of_a_line = 20;  // that a circle may lose for each line beyond two it replaces
constexpr double shared_in_bulge = 0.6;
constexpr double largest_radius = 10000;

Eigen::Vector2d mean_of(const ScanPoints &points, int first, int last)
{
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    for (int i = first; i <= last; i++) {
        sum += Eigen::Vector2d(points[static_cast<size_t>(i)].x, points[static_cast<size_t>(i)].y);
    }
    return sum / (last - first + 1);
}

struct Shape {
    Eigen::Vector2d along = Eigen::Vector2d::Zero();
    double bulge = 0;
};

double cross(const Eigen::Vector2d &a, const Eigen::Vector2d &b)
{
    return a.x() * b.y() - a.y() * b.x();
}

Shape shape_of(const ScanPoints &points, const NoiseOfScan &noise, Run run)
{
    const int n = run.points();
    if (n < least_points) {
        return {};
    }
    const int third = n / 3;
    const Eigen::Vector2d start = mean_of(points, run.first, run.first + third - 1);
    const Eigen::Vector2d middle = mean_of(points, run.first + third, run.last - third);
    const Eigen::Vector2d end = mean_of(points, run.last - third + 1, run.last);
    const RunFit fit = fit_run(points, noise, run.first, run.last);
    const double var = fit.var / (n - 2 * third) + fit.var / (2 * third) + fit.shared * shared_in_bulge;
    const Eigen::Vector2d along = end - start;
    return {along, cross(along, middle - start) / (along.norm() * std::sqrt(var))};
}

double chi_about_circle(const ScanPoints &points, const Circle &circle, Run run, double var)
{
    double sum = 0;
    for (int i = run.first; i <= run.last; i++) {
        const ScanPoint &p = points[static_cast<size_t>(i)];
        const double d =
            (std::pow(p.x - circle.x, 2) + std::pow(p.y - circle.y, 2) - circle.radius * circle.radius) /
            (2 * circle.radius);
        sum += d * d / var;
    }
    return sum;
}

// Chi square of the runs first..last about one circle, less that about their own lines.
double circle_excess(const ScanPoints &points, const NoiseOfScan &noise, const std::vector<Run> &runs,
                     size_t first, size_t last, Decisions &decisions)
{
    const Circle circle = circle_through(points, runs[first].first, runs[last].last);
    decisions.spend((runs[last].last + 1 - runs[first].first) * 3 /
                    4); // a point costs so much of a run's sum
    if (circle.radius == 0) {
        return HUGE_VAL;
    }
    double excess = 0;
    for (size_t k = first; k <= last; k++) {
        const RunFit fit = fit_run(points, noise, runs[k].first, runs[k].last);
        excess += chi_about_circle(points, circle, runs[k], fit.var) - fit.chi();
    }
    return excess;
}

// A single run is curved when a circle fits better than the line, and better than two lines.
bool is_arc(const ScanPoints &points, const NoiseOfScan &noise, const std::vector<Run> &runs, size_t k,
            Decisions &decisions)
{
    const double excess = circle_excess(points, noise, runs, k, k, decisions);
    if (!decisions.below(excess, 0)) {
        return false;
    }
    Decisions ignored;
    const CoarseBreak two =
        coarse_break(points, runs[k], reading_direction(points, runs[k].first, runs[k].last), ignored);
    decisions.spend(ignored.spent());
    const RunFit one = fit_run(points, noise, runs[k].first, runs[k].last);
    return decisions.below(excess, two.split < 0 ? 0 : (two.sse - one.sse) / one.var);
}

// Of many suspects only the strongest are tried.
double least_suspect_bulge(const std::vector<Run> &runs, const std::vector<Shape> &shape, size_t most)
{
    const auto suspects = [&](double limit) {
        size_t count = 0;
        for (size_t k = 0; k < runs.size(); k++) {
            count += !runs[k].curved && !runs[k].no_arc && std::fabs(shape[k].bulge) > limit ? 1 : 0;
        }
        return count;
    };
    double limit = suspect_bulge;
    while (suspects(limit) > most) {
        limit *= 2;
    }
    return limit;
}

// +1 or -1 for a turn of 3 to 50 degrees (tangents 1/19 and 6/5), 0 for any other.
int turn_between(const Shape &a, const Shape &b, Decisions &decisions)
{
    const double turn = cross(a.along, b.along);
    const double onward = a.along.dot(b.along);
    if (turn == 0 || !decisions.below(std::fabs(turn) * 5, onward * 6) ||
        decisions.below(std::fabs(turn) * 19, onward)) {
        return 0;
    }
    return turn > 0 ? 1 : -1;
}

bool adjoin(const std::vector<Run> &segments, Run a, Run b)
{
    return !a.curved && !b.curved && b.first - a.last <= widest_gap &&
           on_one_surface(segments, a.last, b.first);
}

struct Chain {
    size_t last;
    int sign;
};

Chain chain_from(const std::vector<Run> &segments, const std::vector<Run> &runs,
                 const std::vector<Shape> &shape, size_t first, Decisions &decisions)
{
    Chain chain = {first, 0};
    while (chain.last + 1 < runs.size() && adjoin(segments, runs[chain.last], runs[chain.last + 1])) {
        const int turn = turn_between(shape[chain.last], shape[chain.last + 1], decisions);
        if (turn == 0 || turn == -chain.sign) {
            break;
        }
        chain.sign = turn;
        chain.last++;
    }
    return chain;
}

struct Stretch {
    size_t first = 0;
    size_t last = 0; // no farther than first: none
    double strength = bulge_of_all;
};

// The part of a chain, of two runs at least, with the largest sum of bulges to the outside of its turn.
Stretch strongest_stretch(const std::vector<Shape> &shape, size_t first, const Chain &chain,
                          Decisions &decisions)
{
    Stretch best;
    for (size_t from = first; from < chain.last; from++) {
        for (size_t to = from + 1; to <= chain.last; to++) {
            double sum = 0;
            for (size_t k = from; k <= to; k++) {
                sum += -chain.sign * shape[k].bulge - bulge_of_each;
            }
            if (!decisions.below(sum, best.strength)) {
                best = {from, to, sum};
            }
        }
    }
    return best;
}

// Whether one circle explains a stretch as well as its lines do.
bool on_a_circle(const ScanPoints &points, const NoiseOfScan &noise, const std::vector<Run> &runs,
                 size_t first, size_t last, Decisions &decisions)
{
    return decisions.below(circle_excess(points, noise, runs, first, last, decisions),
                           chi_of_a_line * static_cast<double>(last - first - 1));
}

std::vector<Run> joined(const std::vector<Run> &runs, const std::vector<int> &curve_of)
{
    std::vector<Run> result;
    for (size_t k = 0; k < runs.size(); k++) {
        if (k > 0 && curve_of[k] != 0 && curve_of[k] == curve_of[k - 1]) {
            result.back() = {result.back().first, runs[k].last, true};
        } else {
            result.push_back(runs[k]);
            result.back().curved = runs[k].curved || curve_of[k] != 0;
        }
    }
    return result;
}

} // namespace

Circle circle_through(const ScanPoints &points, int first, int last)
{
    const Eigen::Vector2d mean = mean_of(points, first, last);
    Eigen::MatrixX3d rows(last - first + 1, 3);
    Eigen::VectorXd right(last - first + 1);
    for (int i = first; i <= last; i++) {
        const double u = points[static_cast<size_t>(i)].x - mean.x();
        const double v = points[static_cast<size_t>(i)].y - mean.y();
        rows.row(i - first) << 2 * u, 2 * v, 1;
        right(i - first) = u * u + v * v;
    }
    const Eigen::Vector3d abc = rows.colPivHouseholderQr().solve(right);
    const double radius = std::sqrt(std::max(abc(2) + abc.head<2>().squaredNorm(), 0.0));
    const bool exists = std::fabs(abc(0)) <= largest_radius && std::fabs(abc(1)) <= largest_radius;
    return {mean.x() + abc(0), mean.y() + abc(1), exists && radius <= largest_radius ? radius : 0};
}

double bulge_of(const ScanPoints &points, const NoiseOfScan &noise, Run run)
{
    return shape_of(points, noise, run).bulge;
}

std::vector<Run> with_curves(const ScanPoints &points, const NoiseOfScan &noise,
                             const std::vector<Run> &segments, std::vector<Run> runs, bool again,
                             Decisions &decisions)
{
    std::vector<Shape> shape;
    std::vector<int> curve_of(runs.size(), 0);
    std::vector<double> strength(runs.size(), 0); // of the chain that a run belongs to
    int curves = 0;
    for (const Run &run : runs) {
        shape.push_back(shape_of(points, noise, run));
    }
    const size_t most = again || noise.costly ? most_suspects / 3 : most_suspects;
    const double least_bulge = least_suspect_bulge(runs, shape, most);
    for (size_t k = 0; k < runs.size(); k++) {
        if (runs[k].curved || runs[k].no_arc || decisions.below(std::fabs(shape[k].bulge), least_bulge)) {
            continue;
        }
        runs[k].no_arc = !is_arc(points, noise, runs, k, decisions);
        curve_of[k] = runs[k].no_arc ? 0 : ++curves;
    }
    for (size_t first = 0; first < runs.size();) {
        const Chain chain = chain_from(segments, runs, shape, first, decisions);
        Stretch stretch = strongest_stretch(shape, first, chain, decisions);
        const auto holds = [&](size_t from, size_t to) {
            return on_a_circle(points, noise, runs, from, to, decisions);
        };
        if (stretch.first < stretch.last && holds(stretch.first, stretch.last)) {
            stretch.last += stretch.last < chain.last && holds(stretch.first, stretch.last + 1) ? 1 : 0;
            stretch.first -= stretch.first > first && holds(stretch.first - 1, stretch.last) ? 1 : 0;
            curves++;
            for (size_t k = stretch.first; k <= stretch.last; k++) {
                if (stretch.strength > strength[k]) {
                    strength[k] = stretch.strength;
                    curve_of[k] = curves;
                }
            }
        }
        first = std::max(chain.last, first + 1);
    }
    return joined(runs, curve_of);
}

} // namespace reference
