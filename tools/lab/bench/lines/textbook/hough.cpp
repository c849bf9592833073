// R. O. Duda, P. E. Hart, "Use of the Hough transformation to detect lines and curves in pictures", Comm. ACM
// 15(1), 1972: every point votes for all lines through it; the line with most votes is taken with its
// points, whose votes are withdrawn, and so on.
#include "lab/bench/lines/textbook/textbook.hpp"

namespace bench::textbook
{
namespace
{

constexpr int angles = 180; // over half a turn: 1 degree
constexpr double cell = 0.02;
constexpr double farthest = 6;
constexpr int cells = static_cast<int>(2 * farthest / cell);
constexpr int most_lines = 60;

class Accumulator
{
  public:
    Accumulator() : votes(static_cast<std::size_t>(angles) * cells, 0)
    {
        for (int a = 0; a < angles; a++) {
            normals.push_back(direction(pi * a / angles));
        }
    }
    void vote(const Point &p, int weight)
    {
        for (int a = 0; a < angles; a++) {
            const double rho = normals[static_cast<std::size_t>(a)].dot(p);
            const int c = static_cast<int>((rho + farthest) / cell);
            if (c >= 0 && c < cells) {
                votes[static_cast<std::size_t>(a) * cells + static_cast<std::size_t>(c)] += weight;
            }
        }
    }
    int strongest(NormalForm &line) const
    {
        std::size_t best = 0;
        for (std::size_t k = 1; k < votes.size(); k++) {
            if (votes[k] > votes[best]) {
                best = k;
            }
        }
        const std::size_t angle = best / cells;
        line.alpha = pi * static_cast<double>(angle) / angles;
        line.rho = (static_cast<double>(best % cells) + 0.5) * cell - farthest;
        return votes[best];
    }

  private:
    std::vector<int> votes;
    std::vector<Point> normals;
};

// A cell of the accumulator is coarser than the wall is flat: points are gathered from half a cell more.
Setting gathering(const Setting &setting)
{
    Setting wide = setting;
    wide.threshold += cell / 2;
    return wide;
}

// Takes the points of the line from every cluster; runs long enough become lines. False: none was.
bool take_line(const std::vector<Cluster> &clusters, std::vector<std::vector<bool>> &taken,
               const NormalForm &line, Accumulator &accumulator, const Setting &setting,
               std::vector<Line> &lines)
{
    bool any = false;
    for (std::size_t c = 0; c < clusters.size(); c++) {
        for (const Run &coarse : runs_along(clusters[c], taken[c], line, gathering(setting))) {
            if (static_cast<int>(coarse.last - coarse.first) + 1 < setting.min_points) {
                continue;
            }
            for (const Run &run : runs_along(clusters[c], taken[c], fit(clusters[c], coarse), setting)) {
                if (run.last < coarse.first || run.first > coarse.last) {
                    continue;
                }
                add_line(lines, clusters[c], run, setting);
                for (std::size_t k = run.first; k <= run.last; k++) {
                    if (!taken[c][k]) {
                        accumulator.vote(clusters[c][k].p, -1);
                        taken[c][k] = true;
                        any = true;
                    }
                }
            }
        }
    }
    return any;
}

// A peak whose points do not lie together is voted down, so that the next one comes up.
void withdraw(const std::vector<Cluster> &clusters, std::vector<std::vector<bool>> &taken,
              const NormalForm &line, Accumulator &accumulator, const Setting &setting)
{
    for (std::size_t c = 0; c < clusters.size(); c++) {
        for (std::size_t k = 0; k < clusters[c].size(); k++) {
            if (!taken[c][k] &&
                std::abs(line.distance(clusters[c][k].p)) <= setting.allowed(clusters[c][k].p)) {
                accumulator.vote(clusters[c][k].p, -1);
                taken[c][k] = true;
            }
        }
    }
}

} // namespace

std::vector<Line> hough(const ale_scan_t &scan, const Setting &setting)
{
    const std::vector<Cluster> clusters = cut_at_jumps(scan, setting);
    Accumulator accumulator;
    std::vector<std::vector<bool>> taken;
    for (const Cluster &cluster : clusters) {
        taken.emplace_back(cluster.size(), false);
        for (const Beam &beam : cluster) {
            accumulator.vote(beam.p, 1);
        }
    }
    std::vector<Line> lines;
    for (int found = 0; found < most_lines; found++) {
        NormalForm line;
        if (accumulator.strongest(line) < setting.min_points) {
            break;
        }
        if (!take_line(clusters, taken, line, accumulator, setting, lines)) {
            withdraw(clusters, taken, line, accumulator, setting);
        }
    }
    in_beam_order(lines);
    return lines;
}

} // namespace bench::textbook
