// M. Yaghobi, M. Jadalaha, J. Zolghadr, M. Norouzi, "Adaptive line extraction algorithm for SLAM
// application": its binary search for the end of a line, with the threshold of the RMSE held at one value as
// plain split and merge would have it. The listing's errors are corrected: after a rejection the search goes
// on, the line ends at the last guess that was accepted, and where none was only one point is left out.
#include "lab/bench/lines/textbook/textbook.hpp"

namespace bench::textbook
{
namespace
{

constexpr std::size_t shortest_run = 5;

// RMSE along the normal, metres.
double rmse(const Cluster &cluster, const Run &run)
{
    const NormalForm line = fit(cluster, run);
    double sum = 0;
    for (std::size_t k = run.first; k <= run.last; k++) {
        sum += std::pow(line.distance(cluster[k].p), 2);
    }
    return std::sqrt(sum / static_cast<double>(run.last - run.first + 1));
}

bool acceptable(const Cluster &cluster, const Run &run, const Setting &setting)
{
    const Beam &middle = cluster[(run.first + run.last) / 2];
    return rmse(cluster, run) <= setting.allowed(middle.p);
}

// The last point of the line that begins at `first`; `first` itself when there is none.
std::size_t search_end(const Cluster &cluster, std::size_t first, const Setting &setting)
{
    std::size_t left = first + shortest_run - 1;
    std::size_t right = cluster.size();
    if (left >= right || !acceptable(cluster, {first, left}, setting)) {
        return first;
    }
    while (right - left > 1) {
        const std::size_t guess = (left + right) / 2;
        (acceptable(cluster, {first, guess}, setting) ? left : right) = guess;
    }
    return left;
}

} // namespace

std::vector<Line> static_ale(const ale_scan_t &scan, const Setting &setting)
{
    std::vector<Line> lines;
    for (const Cluster &cluster : cut_at_jumps(scan, setting)) {
        std::size_t first = 0;
        while (first + shortest_run <= cluster.size()) {
            const std::size_t last = search_end(cluster, first, setting);
            add_line(lines, cluster, {first, last}, setting);
            first = last + 1;
        }
    }
    return lines;
}

} // namespace bench::textbook
