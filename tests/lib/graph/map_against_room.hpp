// Lines of a map against the walls of a synthetic room, metres.
#ifndef TESTS_GRAPH_MAP_AGAINST_ROOM_HPP
#define TESTS_GRAPH_MAP_AGAINST_ROOM_HPP

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Core>

#include "lib/motion/room.h"

extern "C" {
#include "map/line_map.h"
}

namespace map_against_room
{

inline double distance_m(const room::Wall &w, ale_point_t p)
{
    const Eigen::Vector2d a(w.x1, w.y1);
    const Eigen::Vector2d d = Eigen::Vector2d(w.x2, w.y2) - a;
    const Eigen::Vector2d q = Eigen::Vector2d(p.x_um, p.y_um) * 1e-6 - a;
    const double u = std::min(1.0, std::max(0.0, q.dot(d) / d.squaredNorm()));
    return (q - u * d).norm();
}

inline double distance_m(const std::vector<room::Wall> &walls, ale_point_t p)
{
    double least = 1e9;
    for (const room::Wall &wall : walls) {
        least = std::min(least, distance_m(wall, p));
    }
    return least;
}

inline double length_m(const ale_map_line_t &line)
{
    return std::hypot(line.end.x_um - line.start.x_um, line.end.y_um - line.start.y_um) * 1e-6;
}

inline double length_m(const ale_map_t &map)
{
    double sum = 0;
    for (int k = 0; k < map.line_count; k++) {
        sum += length_m(map.line[k]);
    }
    return sum;
}

} // namespace map_against_room

#endif
