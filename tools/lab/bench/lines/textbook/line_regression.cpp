// K. O. Arras, R. Siegwart, "Feature extraction and scene interpretation for map-based navigation and map
// building", SPIE Mobile Robotics XII, 1997: a line through every window of neighbouring points is a point in
// model space; where neighbouring windows agree (by the Mahalanobis distance of their parameters) there is a
// wall; overlapping walls that agree are merged, the most alike first.
#include <Eigen/LU>
#include <limits>

#include "lab/bench/lines/textbook/textbook.hpp"

namespace bench::textbook
{
namespace
{

constexpr std::size_t window = 7;
constexpr double alike = 3; // Mahalanobis distance of neighbours, squared, summed over three windows
constexpr double same_wall = 12;

struct Model {
    NormalForm line;
    Eigen::Matrix2d information;
};

Model model_of(const Cluster &cluster, const Run &run, const Setting &setting)
{
    Model model{fit(cluster, run), Eigen::Matrix2d::Zero()};
    const Point tangent = model.line.tangent();
    for (std::size_t k = run.first; k <= run.last; k++) {
        const Eigen::Vector2d jacobian(tangent.dot(cluster[k].p), -1);
        const double sigma = setting.allowed(cluster[k].p) / 3; // what strays farther is no noise
        model.information += jacobian * jacobian.transpose() / (sigma * sigma);
    }
    return model;
}

// Squared Mahalanobis distance of two models.
double difference(const Model &a, const Model &b)
{
    const bool turned = std::abs(wrapped(b.line.alpha - a.line.alpha)) > pi / 2;
    const NormalForm other = turned ? NormalForm{b.line.alpha + pi, -b.line.rho} : b.line;
    const Eigen::Vector2d d(wrapped(other.alpha - a.line.alpha), other.rho - a.line.rho);
    const Eigen::Matrix2d covariance = a.information.inverse() + b.information.inverse();
    return d.dot(covariance.inverse() * d);
}

// Runs of windows whose neighbours are alike, as runs of points.
std::vector<Run> alike_windows(const Cluster &cluster, const Setting &setting)
{
    std::vector<Model> models;
    for (std::size_t k = 0; k + window <= cluster.size(); k++) {
        models.push_back(model_of(cluster, {k, k + window - 1}, setting));
    }
    std::vector<Run> runs;
    bool open = false;
    for (std::size_t k = 1; k + 1 < models.size(); k++) {
        if (difference(models[k - 1], models[k]) + difference(models[k], models[k + 1]) > alike) {
            open = false;
            continue;
        }
        if (!open) {
            runs.push_back({k, k + window - 1});
            open = true;
        }
        runs.back().last = k + window - 1;
    }
    return runs;
}

// Agglomerative: the two neighbours most alike become one, until none are alike enough.
void merge(const Cluster &cluster, const Setting &setting, std::vector<Run> &runs)
{
    while (runs.size() > 1) {
        std::size_t best = 0;
        double least = std::numeric_limits<double>::max();
        for (std::size_t k = 0; k + 1 < runs.size(); k++) {
            const double d =
                difference(model_of(cluster, runs[k], setting), model_of(cluster, runs[k + 1], setting));
            if (d < least) {
                least = d;
                best = k;
            }
        }
        if (least > same_wall) {
            return;
        }
        runs[best].last = std::max(runs[best].last, runs[best + 1].last);
        runs.erase(runs.begin() + static_cast<std::ptrdiff_t>(best) + 1);
    }
}

// Windows overlap at corners: each of the points between two walls goes to the one it is nearer to.
void share_overlaps(const Cluster &cluster, std::vector<Run> &runs)
{
    for (std::size_t k = 0; k + 1 < runs.size(); k++) {
        Run &a = runs[k];
        Run &b = runs[k + 1];
        if (a.last < b.first) {
            continue;
        }
        const NormalForm line_a = fit(cluster, a);
        const NormalForm line_b = fit(cluster, b);
        std::size_t cut = b.first;
        while (cut < a.last &&
               std::abs(line_a.distance(cluster[cut].p)) <= std::abs(line_b.distance(cluster[cut].p))) {
            cut++;
        }
        a.last = cut > a.first ? cut - 1 : a.first;
        b.first = cut;
    }
}

} // namespace

std::vector<Line> line_regression(const ale_scan_t &scan, const Setting &setting)
{
    std::vector<Line> lines;
    for (const Cluster &cluster : cut_at_jumps(scan, setting)) {
        std::vector<Run> runs = alike_windows(cluster, setting);
        merge(cluster, setting, runs);
        share_overlaps(cluster, runs);
        for (const Run &run : runs) {
            add_line(lines, cluster, run, setting);
        }
    }
    return lines;
}

} // namespace bench::textbook
