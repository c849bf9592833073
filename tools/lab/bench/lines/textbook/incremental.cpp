// Incremental, also called line tracking: points are added while the line stays good.
#include "lab/bench/lines/textbook/textbook.hpp"

namespace bench::textbook
{
namespace
{

constexpr std::size_t points_at_once = 3; // several points at a time make it less sensitive to noise

// The longest run from `first` on, grown step by step, the last step point by point.
Run grow(const Cluster &cluster, std::size_t first, const Setting &setting)
{
    Run run{first, first};
    std::size_t step = points_at_once;
    while (run.last + 1 < cluster.size()) {
        const Run longer{first, std::min(run.last + step, cluster.size() - 1)};
        if (is_line(cluster, longer, setting)) {
            run = longer;
        } else if (step > 1) {
            step = 1;
        } else {
            break;
        }
    }
    return run;
}

} // namespace

std::vector<Line> incremental(const ale_scan_t &scan, const Setting &setting)
{
    std::vector<Line> lines;
    for (const Cluster &cluster : cut_at_jumps(scan, setting)) {
        std::size_t first = 0;
        while (first < cluster.size()) {
            const Run run = grow(cluster, first, setting);
            add_line(lines, cluster, run, setting);
            first = run.last + 1;
        }
    }
    return lines;
}

} // namespace bench::textbook
