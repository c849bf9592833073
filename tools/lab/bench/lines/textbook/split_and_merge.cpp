// T. Pavlidis, S. L. Horowitz, "Segmentation of plane curves", IEEE Trans. Computers C-23(8), 1974, in the
// form of G. A. Borges, M.-J. Aldon (2004).
#include <vector>

#include "lab/bench/lines/textbook/textbook.hpp"

namespace bench::textbook
{
namespace
{

// A run that strays from its fitted line is split where it strays farthest from the chord between its ends.
void split(const Cluster &cluster, const Run &run, const Setting &setting, std::vector<Run> &pieces)
{
    if (static_cast<int>(run.last - run.first) + 1 < setting.min_points || is_line(cluster, run, setting)) {
        pieces.push_back(run);
        return;
    }
    const NormalForm chord = line_through(cluster[run.first].p, cluster[run.last].p);
    const std::size_t farthest = farthest_point(cluster, run, chord, setting).at;
    const std::size_t at = std::min(std::max(farthest, run.first + 1), run.last);
    split(cluster, {run.first, at - 1}, setting, pieces);
    split(cluster, {at, run.last}, setting, pieces);
}

// Neighbours become one where all of their points lie near the common line.
std::vector<Run> merge(const Cluster &cluster, const std::vector<Run> &pieces, const Setting &setting)
{
    std::vector<Run> merged;
    for (const Run &piece : pieces) {
        if (!merged.empty()) {
            const Run joined{merged.back().first, piece.last};
            if (is_line(cluster, joined, setting)) {
                merged.back() = joined;
                continue;
            }
        }
        merged.push_back(piece);
    }
    return merged;
}

} // namespace

std::vector<Line> split_and_merge(const ale_scan_t &scan, const Setting &setting)
{
    std::vector<Line> lines;
    for (const Cluster &cluster : cut_at_jumps(scan, setting)) {
        std::vector<Run> pieces;
        split(cluster, {0, cluster.size() - 1}, setting, pieces);
        for (const Run &run : merge(cluster, pieces, setting)) {
            add_line(lines, cluster, run, setting);
        }
    }
    return lines;
}

} // namespace bench::textbook
