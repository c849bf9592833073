#include "graph/loops/place_search.h"

#include <algorithm>
#include <cmath>

namespace ale
{

namespace
{

constexpr int step_cells = 2;
constexpr double step_m = step_cells * LikelihoodField::cell_m;
constexpr int block_cells = 2 * step_cells; // two positions along each axis
constexpr double block_m = block_cells * LikelihoodField::cell_m;
constexpr int blocks_each_way = static_cast<int>(PlaceSearch::half_m / block_m + 0.5);
constexpr int side = 2 * blocks_each_way + 1;
constexpr int headings = 180;
constexpr double heading_step = 2 * pi / headings;
constexpr size_t searched_headings = 40; // the four of a room, each with some beside it
constexpr size_t searched_blocks = 2000;
constexpr size_t scored_positions = 400;
constexpr size_t coarse_points = 32;
constexpr size_t scored_points = 120;

// Positions are whole cells apart, so that the bound of a block holds.
Pose block_pose(size_t k, const std::vector<size_t> &turns)
{
    const auto places = static_cast<size_t>(side) * side;
    const int place = static_cast<int>(k % places);
    return {(place % side - blocks_each_way) * block_m, (place / side - blocks_each_way) * block_m,
            wrapped(static_cast<double>(turns[k / places]) * heading_step)};
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

std::vector<Pose> chosen(const std::vector<Pose> &poses, const std::vector<double> &scores, size_t count)
{
    std::vector<Pose> best;
    for (const size_t k : best_of(scores, count)) {
        best.push_back(poses[k]);
    }
    return best;
}

// The first poses that are different places.
std::vector<Pose> first_distinct(const std::vector<Pose> &poses)
{
    std::vector<Pose> distinct;
    for (const Pose &pose : poses) {
        const bool is_new = std::all_of(distinct.begin(), distinct.end(),
                                        [&](const Pose &other) { return are_distinct(pose, other); });
        if (is_new && distinct.size() < PlaceSearch::most_found) {
            distinct.push_back(pose);
        }
    }
    return distinct;
}

} // namespace

PlaceSearch::PlaceSearch(const Place &place)
    : field_(place.field()), pooled_(field_.pooled(step_cells)), normals_(histogram_of(place.points()))
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

std::vector<Pose> PlaceSearch::best_blocks(const std::vector<SurfacePoint> &few,
                                           const std::vector<size_t> &turns) const
{
    std::vector<double> scores;
    scores.reserve(turns.size() * side * side);
    std::vector<double> sums;
    for (const size_t turn : turns) {
        const Eigen::Matrix2d r = rotation(wrapped(static_cast<double>(turn) * heading_step));
        sums.assign(static_cast<size_t>(side) * side, 0);
        for (const SurfacePoint &point : few) {
            pooled_.add_likelihoods_around(r * point.p, blocks_each_way, block_cells, &sums);
        }
        scores.insert(scores.end(), sums.begin(), sums.end());
    }
    std::vector<Pose> blocks;
    for (const size_t k : best_of(scores, searched_blocks)) {
        blocks.push_back(block_pose(k, turns));
    }
    return blocks;
}

std::vector<Pose> PlaceSearch::best_positions(const std::vector<SurfacePoint> &few,
                                              const std::vector<Pose> &blocks) const
{
    std::vector<Pose> poses;
    std::vector<double> scores;
    for (const Pose &block : blocks) {
        for (int k = 0; k < 4; k++) {
            poses.push_back({block.x + (k % 2) * step_m, block.y + (k / 2) * step_m, block.theta});
            scores.push_back(score_of(poses.back(), few, field_));
        }
    }
    return chosen(poses, scores, scored_positions);
}

std::vector<LoopMatch> PlaceSearch::find(const std::vector<SurfacePoint> &points) const
{
    const std::vector<SurfacePoint> few = thinned(points, coarse_points);
    const std::vector<SurfacePoint> more = thinned(points, scored_points);
    const std::vector<Pose> positions = best_positions(few, best_blocks(few, best_turns(points)));
    std::vector<double> scores;
    for (const Pose &pose : positions) {
        scores.push_back(score_of(pose, more, field_));
    }
    std::vector<LoopMatch> found;
    for (const Pose &pose : first_distinct(chosen(positions, scores, positions.size()))) {
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
