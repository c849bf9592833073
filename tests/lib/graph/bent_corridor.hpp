// A corridor whose second half may be bent, driven once along its middle: nodes with its walls, and the
// truth.
#ifndef TESTS_GRAPH_BENT_CORRIDOR_HPP
#define TESTS_GRAPH_BENT_CORRIDOR_HPP

#include <random>
#include <vector>

#include "graph/optimise/node.h"
#include "ring_corridor.hpp"

namespace bent_corridor
{

constexpr double half_m = 12;
constexpr double end_m = 22;

// The point this far along the corridor and to its left.
inline Eigen::Vector2d at(double along_m, double left_m, double bend_rad)
{
    const double turned = along_m > half_m ? bend_rad : 0;
    return Eigen::Vector2d(half_m, 0) + ale::rotation(turned) * Eigen::Vector2d(along_m - half_m, left_m);
}

// Two metres wide, with recesses of different width in both walls.
inline std::vector<ring_corridor::Wall> walls(double bend_rad)
{
    std::vector<ring_corridor::Wall> walls;
    const auto add = [&](double from_m, double from_left, double to_m, double to_left) {
        walls.push_back({at(from_m, from_left, bend_rad), at(to_m, to_left, bend_rad)});
    };
    double along_m = 0;
    for (int k = 0; along_m < end_m; k++) {
        const double wall_m = k % 3 == 0 ? 1.6 : 2;
        const double recess_m = k % 2 == 0 ? 0.9 : 0.6;
        const double next_m = along_m + wall_m + recess_m;
        const double edge_m = along_m + wall_m;
        add(along_m, -1, edge_m, -1);
        add(edge_m, -1, edge_m, -1.4);
        add(edge_m, -1.4, next_m, -1.4);
        add(next_m, -1.4, next_m, -1);
        add(edge_m, 1, along_m, 1);
        add(edge_m, 1.3, edge_m, 1);
        add(next_m, 1.3, edge_m, 1.3);
        add(next_m, 1, next_m, 1.3);
        along_m = next_m;
    }
    return walls;
}

inline std::vector<ale::Pose> truth(double bend_rad)
{
    std::vector<ale::Pose> poses;
    for (double along_m = 1; along_m < end_m - 1; along_m += 0.5) {
        const Eigen::Vector2d p = at(along_m, 0, bend_rad);
        poses.push_back({p.x(), p.y(), along_m > half_m ? bend_rad : 0});
    }
    return poses;
}

// A node with the points and lines of the corridor seen from a pose.
inline ale::Node node_at(const std::vector<ring_corridor::Wall> &walls, const ale::Pose &pose,
                         std::mt19937 *random)
{
    ale::Node node = ring_corridor::seen_from(walls, pose, random);
    const Eigen::Vector2d sensor(pose.x, pose.y);
    for (const ring_corridor::Wall &wall : walls) {
        const Eigen::Vector2d n = ring_corridor::normal_of(wall);
        if (((wall.a + wall.b) / 2 - sensor).norm() < 4 && n.dot(sensor - wall.a) > 0.1) {
            node.walls.push_back(
                {ale::wrapped(std::atan2(n.y(), n.x()) - pose.theta), (wall.b - wall.a).norm()});
        }
    }
    return node;
}

// Nodes with the poses of a tracker whose heading drifts.
inline std::vector<ale::Node> nodes(double bend_rad, double drift_rad_m, unsigned seed)
{
    std::mt19937 random(seed);
    const std::vector<ring_corridor::Wall> corridor = walls(bend_rad);
    const std::vector<ale::Pose> true_poses = truth(bend_rad);
    const std::vector<ale::Pose> tracked = ring_corridor::drifting_poses(true_poses, drift_rad_m, seed);
    std::vector<ale::Node> nodes;
    for (size_t k = 0; k < true_poses.size(); k++) {
        nodes.push_back(node_at(corridor, true_poses[k], &random));
        nodes.back().scan = static_cast<uint32_t>(k);
        nodes.back().smooth = tracked[k];
        nodes.back().path_m = 0.5 * static_cast<double>(k);
    }
    return nodes;
}

} // namespace bent_corridor

#endif
