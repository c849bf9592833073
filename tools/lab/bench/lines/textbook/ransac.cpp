// M. A. Fischler, R. C. Bolles, "Random sample consensus", Comm. ACM 24(6), 1981: within each cluster the
// line of two random points that most others agree with, again and again on what is left.
#include "lab/bench/lines/textbook/textbook.hpp"
#include "lab/bench/random.hpp"

namespace bench::textbook
{
namespace
{

constexpr int tries = 60;
constexpr int most_lines_a_cluster = 30;

Run longest(const std::vector<Run> &runs)
{
    Run best{1, 0};
    for (const Run &run : runs) {
        if (best.last < best.first || run.last - run.first > best.last - best.first) {
            best = run;
        }
    }
    return best;
}

// The longest run that any of the tried lines has.
Run best_consensus(const Cluster &cluster, const std::vector<bool> &taken,
                   const std::vector<std::size_t> &left, Random &random, const Setting &setting)
{
    Run best{1, 0};
    const int most = static_cast<int>(left.size()) - 1;
    for (int attempt = 0; attempt < tries; attempt++) {
        // The partner comes from nearby: two far points rarely lie on one wall.
        const int i = random.integer(0, most);
        const int j = std::min(most, std::max(0, i + random.integer(-30, 30)));
        const Point &a = cluster[left[static_cast<std::size_t>(i)]].p;
        const Point &b = cluster[left[static_cast<std::size_t>(j)]].p;
        if ((a - b).norm() < 1e-3) {
            continue;
        }
        const Run run = longest(runs_along(cluster, taken, line_through(a, b), setting));
        if (run.last >= run.first &&
            (best.last < best.first || run.last - run.first > best.last - best.first)) {
            best = run;
        }
    }
    return best;
}

std::vector<std::size_t> not_taken(const std::vector<bool> &taken)
{
    std::vector<std::size_t> left;
    for (std::size_t k = 0; k < taken.size(); k++) {
        if (!taken[k]) {
            left.push_back(k);
        }
    }
    return left;
}

void extract_from(const Cluster &cluster, Random &random, const Setting &setting, std::vector<Line> &lines)
{
    std::vector<bool> taken(cluster.size(), false);
    for (int found = 0; found < most_lines_a_cluster; found++) {
        const std::vector<std::size_t> left = not_taken(taken);
        if (static_cast<int>(left.size()) < setting.min_points) {
            return;
        }
        Run run = best_consensus(cluster, taken, left, random, setting);
        if (run.last < run.first || static_cast<int>(run.last - run.first) + 1 < setting.min_points) {
            return;
        }
        // Fitted to all that agree, once more those that agree with the fit.
        const Run refined = longest(runs_along(cluster, taken, fit(cluster, run), setting));
        run = refined.last >= refined.first ? refined : run;
        add_line(lines, cluster, run, setting);
        std::fill(taken.begin() + static_cast<std::ptrdiff_t>(run.first),
                  taken.begin() + static_cast<std::ptrdiff_t>(run.last) + 1, true);
    }
}

} // namespace

std::vector<Line> ransac(const ale_scan_t &scan, const Setting &setting)
{
    Random random(1); // every call draws the same numbers: the benchmark repeats
    std::vector<Line> lines;
    for (const Cluster &cluster : cut_at_jumps(scan, setting)) {
        extract_from(cluster, random, setting, lines);
    }
    in_beam_order(lines);
    return lines;
}

} // namespace bench::textbook
