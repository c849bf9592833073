#include "graph/loops/place_search.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

namespace ale
{

namespace
{

constexpr int step_log2 = 1;
constexpr int step_cells = 1 << step_log2;
constexpr int block_log2 = step_log2 + 1; // two positions along each axis
constexpr int block_cells = 1 << block_log2;
constexpr int blocks_each_way = 16;
static_assert(blocks_each_way * block_cells * LikelihoodField::cell_m > PlaceSearch::half_m - 1e-9,
              "half_m is searched");
constexpr int side = 2 * blocks_each_way + 1;
constexpr int headings = 180;
constexpr double heading_step = 2 * pi / headings;
constexpr size_t searched_headings = 40; // the four of a room, each with some beside it
constexpr size_t searched_blocks = 2000;
constexpr size_t scored_positions = 400;
constexpr size_t coarse_points = 32; // thinned() keeps up to twice as many
static_assert(2 * coarse_points <= PositionGrid::most_points, "their sums fit");
constexpr size_t scored_points = 120;

// How far along each axis.
int displacement(int k)
{
    return (k - blocks_each_way) * block_cells;
}

// How many normals point which way; each counts beside its own direction, too.
std::vector<double> histogram_of(const std::vector<SurfacePoint> &points)
{
    std::vector<double> histogram(headings, 0);
    for (const SurfacePoint &point : points) {
        if (point.normal.isZero()) {
            continue;
        }
        const int bin = static_cast<int>(std::floor(angle_of(point.normal) / heading_step + headings));
        for (int k = -1; k <= 1; k++) {
            histogram[static_cast<size_t>((bin + k) % headings)] += k == 0 ? 2 : 1;
        }
    }
    return histogram;
}

// Indices of the `count` best sums, ascending; of equals the first.
std::vector<size_t> best_sums(const std::vector<uint16_t> &sums, size_t count)
{
    std::vector<size_t> of_sum(size_t{UINT16_MAX} + 1, 0);
    for (const uint16_t sum : sums) {
        of_sum[sum]++;
    }
    size_t least = UINT16_MAX;
    size_t above = 0; // sums above the least
    while (least > 0 && above + of_sum[least] < count) {
        above += of_sum[least--];
    }
    size_t equal_left = count - std::min(count, above);
    std::vector<size_t> best;
    for (size_t k = 0; k < sums.size(); k++) {
        if (sums[k] > least || (sums[k] == least && equal_left > 0)) {
            equal_left -= sums[k] == least;
            best.push_back(k);
        }
    }
    return best;
}

// The best that are different places.
std::vector<Pose> first_distinct(const std::vector<Pose> &poses, const std::vector<double> &scores)
{
    std::vector<Pose> distinct;
    for (const size_t k : best_of(scores, scores.size())) {
        const bool is_new = std::all_of(distinct.begin(), distinct.end(),
                                        [&](const Pose &other) { return are_distinct(poses[k], other); });
        if (is_new && distinct.size() < PlaceSearch::most_found) {
            distinct.push_back(poses[k]);
        }
    }
    return distinct;
}

} // namespace

PlaceSearch::PlaceSearch(const Place &place)
    : field_(place.field()), blocks_(field_, block_log2, step_cells), positions_(field_, step_log2, 0),
      normals_(histogram_of(place.points()))
{
}

// The turns that bring the normals of the points best onto those of the place.
std::vector<size_t> PlaceSearch::best_turns(const std::vector<SurfacePoint> &points) const
{
    const std::vector<double> seen = histogram_of(points);
    std::vector<double> scores(headings, 0);
    for (size_t turn = 0; turn < headings; turn++) {
        for (size_t k = 0; k < headings; k++) {
            scores[turn] += seen[k] * normals_[(k + turn) % headings];
        }
    }
    return best_of(scores, searched_headings);
}

PlaceSearch::Turned PlaceSearch::turned(const std::vector<SurfacePoint> &few,
                                        const std::vector<size_t> &turns) const
{
    Turned all;
    for (const size_t turn : turns) {
        const Eigen::Matrix2d r = rotation(wrapped(static_cast<double>(turn) * heading_step));
        std::vector<LikelihoodField::Cell> cells;
        cells.reserve(few.size());
        for (const SurfacePoint &point : few) {
            cells.push_back(field_.cell_at(r * point.p));
        }
        all.push_back(std::move(cells));
    }
    return all;
}

std::vector<PlaceSearch::Position> PlaceSearch::best_blocks(const Turned &points) const
{
    constexpr size_t places = static_cast<size_t>(side) * side;
    constexpr int first = -blocks_each_way * block_cells;
    std::vector<uint16_t> sums(points.size() * places, 0);
    for (size_t turn = 0; turn < points.size(); turn++) {
        for (const LikelihoodField::Cell &cell : points[turn]) {
            blocks_.add({cell.column + first, cell.row + first}, side, &sums[turn * places]);
        }
    }
    std::vector<Position> blocks;
    for (const size_t k : best_sums(sums, searched_blocks)) {
        const int place = static_cast<int>(k % places);
        blocks.push_back({k / places, displacement(place % side), displacement(place / side)});
    }
    return blocks;
}

std::vector<PlaceSearch::Position> PlaceSearch::best_positions(const Turned &points,
                                                               const std::vector<Position> &blocks) const
{
    std::vector<uint16_t> sums(4 * blocks.size(), 0);
    for (size_t k = 0; k < blocks.size(); k++) {
        for (const LikelihoodField::Cell &cell : points[blocks[k].turn]) {
            positions_.add({cell.column + blocks[k].x, cell.row + blocks[k].y}, 2, &sums[4 * k]);
        }
    }
    std::vector<Position> best;
    for (const size_t k : best_sums(sums, scored_positions)) {
        const Position &block = blocks[k / 4];
        const int along = static_cast<int>(k % 4);
        best.push_back({block.turn, block.x + along % 2 * step_cells, block.y + along / 2 * step_cells});
    }
    return best;
}

std::vector<LoopMatch> PlaceSearch::find(const std::vector<SurfacePoint> &points) const
{
    const std::vector<size_t> turns = best_turns(points);
    const Turned few = turned(thinned(points, coarse_points), turns);
    const std::vector<SurfacePoint> more = thinned(points, scored_points);
    std::vector<Pose> poses;
    std::vector<double> scores;
    for (const Position &position : best_positions(few, best_blocks(few))) {
        poses.push_back({position.x * LikelihoodField::cell_m, position.y * LikelihoodField::cell_m,
                         wrapped(static_cast<double>(turns[position.turn]) * heading_step)});
        scores.push_back(score_of(poses.back(), more, field_));
    }
    std::vector<LoopMatch> found;
    for (const Pose &pose : first_distinct(poses, scores)) {
        const LoopMatch match = match_locally(points, field_, pose);
        const bool is_new = std::all_of(found.begin(), found.end(), [&](const LoopMatch &other) {
            return are_distinct(match.pose, other.pose);
        });
        if (is_new) {
            found.push_back(match);
        }
    }
    return found;
}

} // namespace ale
