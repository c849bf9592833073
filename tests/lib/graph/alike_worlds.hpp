// Worlds in which places look alike, and keyframes of a robot that drives through them.
#ifndef TESTS_GRAPH_ALIKE_WORLDS_HPP
#define TESTS_GRAPH_ALIKE_WORLDS_HPP

#include <memory>
#include <random>
#include <vector>

#include "lib/motion/room.h"
#include "maps_drive.hpp"

namespace alike_worlds
{

using Walls = std::vector<room::Wall>;
using Path = std::vector<ale::Pose>;

inline void add_box(Walls *walls, double x1, double y1, double x2, double y2)
{
    walls->insert(walls->end(), {{x1, y1, x2, y1}, {x2, y1, x2, y2}, {x2, y2, x1, y2}, {x1, y2, x1, y1}});
}

// A room of 5 m by 4 m above the corridor, its door at x + 2 .. x + 3, with two cupboards.
inline void add_room(Walls *walls, double x)
{
    walls->insert(
        walls->end(),
        {{x, 2, x + 2, 2}, {x + 3, 2, x + 5, 2}, {x, 2, x, 6}, {x + 5, 2, x + 5, 6}, {x, 6, x + 5, 6}});
    add_box(walls, x, 4.5, x + 0.6, 5.6);
    add_box(walls, x + 3.2, 5.4, x + 4.6, 6);
}

// Two equal rooms at 0 and 8 m along a corridor of 0..13 m, 2 m wide. A niche beside each door: `niche` the
// depth of that of the second room, the first has 0.4 m.
inline Walls two_rooms(double niche)
{
    Walls walls;
    add_room(&walls, 0);
    add_room(&walls, 8);
    const auto lower = [&walls](double x, double deep) {
        walls.insert(
            walls.end(),
            {{x + 1.5, 0, x + 1.5, -deep}, {x + 1.5, -deep, x + 2.7, -deep}, {x + 2.7, -deep, x + 2.7, 0}});
    };
    lower(0, 0.4);
    lower(8, niche);
    walls.insert(walls.end(), {{-4, 0, 1.5, 0},
                               {2.7, 0, 9.5, 0},
                               {10.7, 0, 17, 0},
                               {-4, 0, -4, 2},
                               {17, 0, 17, 2},
                               {-4, 2, 0, 2},
                               {5, 2, 8, 2},
                               {13, 2, 17, 2}});
    return walls;
}

// A corridor of 16 m with boxes, the same after half a turn about its middle; `extra`: the depth of one more
// box.
inline Walls turned_corridor(double extra)
{
    Walls walls = {{-8, -1, 8, -1}, {8, -1, 8, 1}, {8, 1, -8, 1}, {-8, 1, -8, -1}};
    const double boxes[][3] = {{-6.5, 0.8, 0.3}, {-4.2, 0.5, 0.45}, {-1.5, 1.1, 0.25}};
    for (const auto &box : boxes) {
        add_box(&walls, box[0], -1, box[0] + box[1], -1 + box[2]);
        add_box(&walls, -box[0] - box[1], 1 - box[2], -box[0], 1);
    }
    if (extra > 0) {
        add_box(&walls, 5.5, -1, 6.2, -1 + extra);
    }
    return walls;
}

// From point to point, a pose every 0.4 m, heading along the way; on the spot it turns in steps of 0.5 rad.
inline Path path_through(const std::vector<Eigen::Vector2d> &points)
{
    Path path;
    for (size_t k = 0; k + 1 < points.size(); k++) {
        const Eigen::Vector2d way = points[k + 1] - points[k];
        const double heading = std::atan2(way.y(), way.x());
        if (!path.empty()) {
            const double turn = ale::wrapped(heading - path.back().theta);
            const int turns = static_cast<int>(std::abs(turn) / 0.5);
            for (int i = 1; i <= turns; i++) {
                path.push_back(
                    {points[k].x(), points[k].y(), ale::wrapped(heading - turn + turn * i / (turns + 1))});
            }
        }
        const int steps = static_cast<int>(way.norm() / 0.4);
        for (int i = 0; i < steps; i++) {
            const Eigen::Vector2d p = points[k] + way * i / steps;
            path.push_back({p.x(), p.y(), heading});
        }
    }
    return path;
}

// Whether the middle of the wall is seen from that pose, from the left of the wall's way.
inline bool is_seen(const Walls &walls, const room::Wall &wall, const ale::Pose &from)
{
    const double x = (wall.x1 + wall.x2) / 2 - from.x;
    const double y = (wall.y1 + wall.y2) / 2 - from.y;
    const bool is_left = (wall.x2 - wall.x1) * y - (wall.y2 - wall.y1) * x < 0;
    return is_left && room::distance(walls, from.x, from.y, std::atan2(y, x)) > std::hypot(x, y) - 0.01;
}

// The map of a drive along that path: of each wall the side that was seen, of a panel of 1 cm.
inline std::unique_ptr<ale_map_t> map_of(const Walls &walls, const Path &path)
{
    auto map = std::make_unique<ale_map_t>();
    const auto add = [&](const room::Wall &wall) {
        if (std::none_of(path.begin(), path.end(),
                         [&](const ale::Pose &pose) { return is_seen(walls, wall, pose); })) {
            return;
        }
        const Eigen::Vector2d normal =
            0.005 * Eigen::Vector2d(wall.y1 - wall.y2, wall.x2 - wall.x1).normalized();
        ale_map_line_t &line = map->line[map->line_count++];
        line.start = {convert::um(wall.x1 + normal.x()), convert::um(wall.y1 + normal.y())};
        line.end = {convert::um(wall.x2 + normal.x()), convert::um(wall.y2 + normal.y())};
        line.seen = 50;
    };
    for (const room::Wall &wall : walls) {
        add(wall);
        add({wall.x2, wall.y2, wall.x1, wall.y1});
    }
    return map;
}

// Keyframes along a path, ten scans apart, at their true poses but for some millimetres of drift.
inline maps_drive::Keyframes keyframes_along(const Walls &walls, const Path &truth, unsigned seed)
{
    const Path tracked = ring_corridor::drifting_poses(truth, 0.0001, seed);
    std::mt19937 rng(seed);
    room::Sensor sensor;
    sensor.beam_time_ns = 0;
    sensor.noise = 0.006;
    maps_drive::Keyframes keyframes;
    for (size_t k = 0; k < truth.size(); k++) {
        const auto here = [&](double) { return reference::Pose(truth[k].x, truth[k].y, truth[k].theta); };
        auto keyframe = std::make_unique<ale_keyframe_t>();
        keyframe->epoch = 1;
        keyframe->scan = static_cast<uint32_t>(10 * k);
        keyframe->smooth = keyframe->map = ale::to_core(tracked[k]);
        keyframe->taken = room::scan_at(walls, sensor, here, 0.5 * static_cast<double>(k), rng);
        keyframes.push_back(std::move(keyframe));
    }
    return keyframes;
}

} // namespace alike_worlds

#endif
