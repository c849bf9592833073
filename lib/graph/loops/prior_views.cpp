#include "graph/loops/prior_views.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>
#include <utility>

extern "C" {
#include "map/atlas.h"
}

namespace ale
{

namespace
{

constexpr int beams = 360;
constexpr double beam_step = 2 * pi / beams;
constexpr double range_m = 12.0;      // a likelihood field about the place holds little more
constexpr int near_cells = 8;         // of the grid: farther from all walls a robot sees little of the map
constexpr size_t most_places = 16384; // of the grid: more than 140 m by 140 m
// Of the beams that meet a wall, those that meet it from behind: more of them, and the place is outside.
constexpr double most_from_behind = 0.25;
constexpr double least_seen = 0.1; // of the beams
constexpr double clear_m = 0.1;    // of any wall is where a robot may be

// The first beam at this bearing or after it; beam k points to (k + 0.5) * beam_step.
int beam_after(double bearing)
{
    return static_cast<int>(std::ceil(bearing / beam_step - 0.5));
}

double cross(const Eigen::Vector2d &a, const Eigen::Vector2d &b)
{
    return a.x() * b.y() - a.y() * b.x();
}

} // namespace

std::vector<PriorViews::Segment> PriorViews::segments_of(const std::vector<ale_wall_t> &walls)
{
    std::vector<Segment> segments;
    for (const ale_wall_t &wall : walls) {
        const Eigen::Vector2d start = to_metres(ale_wall_point(&wall, wall.start_um));
        const Eigen::Vector2d end = to_metres(ale_wall_point(&wall, wall.end_um));
        segments.push_back({start, end - start, {wall.normal_x_q30 / one_q30, wall.normal_y_q30 / one_q30}});
    }
    return segments;
}

PriorViews::PriorViews(const std::vector<ale_wall_t> &walls) : segments_(segments_of(walls))
{
    const std::vector<Pose> grid = grid_near_walls();
    std::copy_if(grid.begin(), grid.end(), std::back_inserter(poses_), [this](const Pose &place) {
        return is_inside({place.x, place.y});
    });
}

std::vector<Pose> PriorViews::grid_near_walls() const
{
    std::set<std::pair<int, int>> on_walls;
    const auto cell = [](double metres) { return static_cast<int>(std::nearbyint(metres / apart_m)); };
    for (const Segment &segment : segments_) {
        const int steps = static_cast<int>(segment.along.norm() / apart_m) + 1;
        for (int k = 0; k <= steps && on_walls.size() < most_places; k++) {
            const Eigen::Vector2d p = segment.start + segment.along * k / steps;
            on_walls.insert({cell(p.x()), cell(p.y())});
        }
    }
    std::set<std::pair<int, int>> near;
    for (const auto &[x, y] : on_walls) {
        for (int dx = -near_cells; dx <= near_cells; dx++) {
            for (int dy = -near_cells; dy <= near_cells; dy++) {
                if (near.size() < most_places) {
                    near.insert({x + dx, y + dy});
                }
            }
        }
    }
    std::vector<Pose> grid;
    std::transform(near.begin(), near.end(), std::back_inserter(grid), [](const std::pair<int, int> &at) {
        return Pose{at.first * apart_m, at.second * apart_m, 0};
    });
    return grid;
}

// One for each beam. A segment is met by the beams between the bearings of its ends.
std::vector<PriorViews::Hit> PriorViews::hits_from(const Eigen::Vector2d &place) const
{
    std::vector<Hit> hits(beams, {range_m, nullptr});
    for (const Segment &segment : segments_) {
        const Eigen::Vector2d start = segment.start - place;
        const Eigen::Vector2d end = start + segment.along;
        const double beside_m = std::abs(segment.normal.dot(start));
        if (beside_m > range_m || std::min(start.norm(), end.norm()) > range_m + segment.along.norm()) {
            continue;
        }
        const double from = angle_of(start);
        const double turn = wrapped(angle_of(end) - from);
        const int last = beam_after(std::max(from, from + turn));
        for (int k = beam_after(std::min(from, from + turn)); k < last; k++) {
            const Eigen::Vector2d beam = rotation(wrapped((k + 0.5) * beam_step)).col(0);
            const double range = cross(start, segment.along) / cross(beam, segment.along);
            Hit &hit = hits[static_cast<size_t>((k + beams) % beams)];
            hit = range > 0 && range < hit.range_m ? Hit{range, &segment} : hit;
        }
    }
    return hits;
}

bool PriorViews::is_inside(const Eigen::Vector2d &place) const
{
    const auto is_on = [&place](const Segment &segment) {
        const double part = (place - segment.start).dot(segment.along) / segment.along.squaredNorm();
        return (segment.start + std::clamp(part, 0.0, 1.0) * segment.along - place).norm() < clear_m;
    };
    if (std::any_of(segments_.begin(), segments_.end(), is_on)) {
        return false;
    }
    int met = 0;
    int behind = 0;
    const std::vector<Hit> hits = hits_from(place);
    for (int k = 0; k < beams; k++) {
        const Segment *segment = ale::at(hits, k).segment;
        met += segment != nullptr;
        behind += segment && segment->normal.dot(place - segment->start) <= 0;
    }
    return behind <= most_from_behind * met && met - behind >= least_seen * beams;
}

Node PriorViews::at(size_t k) const
{
    Node node{};
    node.smooth = node.tracked = poses_[k];
    node.broken = true;
    node.map_id = ALE_FIRST_MAP;
    const Eigen::Vector2d place(poses_[k].x, poses_[k].y);
    const std::vector<Hit> hits = hits_from(place);
    for (int beam = 0; beam < beams; beam++) {
        const auto &[range, segment] = ale::at(hits, beam);
        if (segment && segment->normal.dot(place - segment->start) > 0) {
            node.points.push_back(
                {range * rotation(wrapped((beam + 0.5) * beam_step)).col(0), segment->normal});
        }
    }
    return node;
}

} // namespace ale
