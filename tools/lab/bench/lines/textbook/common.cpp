#include <algorithm>

#include "lab/bench/lines/textbook/textbook.hpp"
#include "lab/bench/simulate.hpp"

namespace bench::textbook
{
namespace
{

constexpr double um = 1e-6;
constexpr double radians_per_bam = 2 * pi / 4294967296.0;

Point point_of(const ale_scan_t &scan, int beam)
{
    const double bearing = ale_scan_bearing(&scan, beam) * radians_per_bam;
    return scan.range_um[beam] * um * direction(bearing);
}

// The adaptive break point detector of Borges and Aldon (2004): the largest distance that a wall may have
// between two beams at the steepest incidence allowed.
bool begins_cluster(const Beam &before, const Beam &now, double step, const Setting &setting)
{
    const double turned = (now.index - before.index) * std::abs(step);
    const double steepest = std::max(setting.jump_angle, turned * 2);
    const double on_slant = before.p.norm() * std::sin(turned) / std::sin(steepest - turned);
    return (now.p - before.p).norm() > on_slant + setting.jump;
}

Cluster points_of(const ale_scan_t &scan)
{
    Cluster points;
    for (int k = 0; k < scan.beams; k++) {
        if (scan.flag[k] == ALE_BEAM_VALID) {
            points.push_back({k, point_of(scan, k)});
        }
    }
    return points;
}

// A point is stray when the distance jumps before and after it: it would cut a wall in two.
Cluster without_stray_points(const Cluster &points, double step, const Setting &setting)
{
    Cluster kept;
    for (std::size_t k = 0; k < points.size(); k++) {
        const bool jumps_before = k == 0 || begins_cluster(points[k - 1], points[k], step, setting);
        const bool jumps_after =
            k + 1 == points.size() || begins_cluster(points[k], points[k + 1], step, setting);
        if (!jumps_before || !jumps_after) {
            kept.push_back(points[k]);
        }
    }
    return kept;
}

} // namespace

std::vector<Cluster> cut_at_jumps(const ale_scan_t &scan, const Setting &setting)
{
    const double step = scan.step_bam * radians_per_bam;
    std::vector<Cluster> clusters;
    for (const Beam &beam : without_stray_points(points_of(scan), step, setting)) {
        if (clusters.empty() || begins_cluster(clusters.back().back(), beam, step, setting)) {
            clusters.emplace_back();
        }
        clusters.back().push_back(beam);
    }
    return clusters;
}

NormalForm fit(const Cluster &cluster, const Run &run)
{
    const double n = static_cast<double>(run.last - run.first + 1);
    Point sum = Point::Zero();
    double xx = 0;
    double xy = 0;
    double yy = 0;
    for (std::size_t k = run.first; k <= run.last; k++) {
        const Point &p = cluster[k].p;
        sum += p;
        xx += p.x() * p.x();
        xy += p.x() * p.y();
        yy += p.y() * p.y();
    }
    const Point mean = sum / n;
    const double sxx = xx - n * mean.x() * mean.x();
    const double sxy = xy - n * mean.x() * mean.y();
    const double syy = yy - n * mean.y() * mean.y();
    const double along = 0.5 * std::atan2(2 * sxy, sxx - syy);
    return line_through(mean, mean + direction(along));
}

void add_line(std::vector<Line> &lines, const Cluster &cluster, const Run &run, const Setting &setting)
{
    if (run.last < run.first || static_cast<int>(run.last - run.first) + 1 < setting.min_points) {
        return;
    }
    Line line;
    line.first = cluster[run.first].index;
    line.last = cluster[run.last].index;
    line.form = fit(cluster, run);
    line.start = line.form.foot(cluster[run.first].p);
    line.end = line.form.foot(cluster[run.last].p);
    if ((line.end - line.start).norm() >= setting.min_length) {
        lines.push_back(line);
    }
}

void in_beam_order(std::vector<Line> &lines)
{
    std::sort(lines.begin(), lines.end(), [](const Line &a, const Line &b) { return a.first < b.first; });
}

Farthest farthest_point(const Cluster &cluster, const Run &run, const NormalForm &line,
                        const Setting &setting)
{
    Farthest found{run.first, 0};
    for (std::size_t k = run.first; k <= run.last; k++) {
        const double strays = std::abs(line.distance(cluster[k].p)) / setting.allowed(cluster[k].p);
        if (strays > found.strays) {
            found = {k, strays};
        }
    }
    return found;
}

bool is_line(const Cluster &cluster, const Run &run, const Setting &setting)
{
    return farthest_point(cluster, run, fit(cluster, run), setting).strays <= 1;
}

std::vector<Run> runs_along(const Cluster &cluster, const std::vector<bool> &taken, const NormalForm &line,
                            const Setting &setting)
{
    constexpr int largest_gap_beams = 3;
    std::vector<Run> runs;
    for (std::size_t k = 0; k < cluster.size(); k++) {
        if (taken[k] || std::abs(line.distance(cluster[k].p)) > setting.allowed(cluster[k].p)) {
            continue;
        }
        if (runs.empty() || cluster[k].index - cluster[runs.back().last].index > largest_gap_beams) {
            runs.push_back({k, k});
        }
        runs.back().last = k;
    }
    return runs;
}

} // namespace bench::textbook
