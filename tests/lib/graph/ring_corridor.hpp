// A corridor around a square block, driven several times: nodes with drifting poses, and the truth.
#ifndef TESTS_GRAPH_RING_CORRIDOR_HPP
#define TESTS_GRAPH_RING_CORRIDOR_HPP

#include <random>
#include <vector>

#include "graph/optimise/node.h"

namespace ring_corridor
{

struct Wall {
    Eigen::Vector2d a;
    Eigen::Vector2d b;
};

// The normal of a wall, on the left of a -> b: the side of the corridor.
inline Eigen::Vector2d normal_of(const Wall &wall)
{
    const Eigen::Vector2d d = (wall.b - wall.a).normalized();
    return {-d.y(), d.x()};
}

inline void add_room(std::vector<Wall> *walls, double low, double high, bool inwards)
{
    const Eigen::Vector2d c[4] = {{low, low}, {high, low}, {high, high}, {low, high}};
    for (int k = 0; k < 4; k++) {
        const Wall wall{c[k], c[(k + 1) % 4]};
        walls->push_back(inwards ? wall : Wall{wall.b, wall.a});
    }
}

// Outer walls 0..20 m, the block 2..18 m, and alcoves of different depths, so that places differ.
inline std::vector<Wall> walls()
{
    std::vector<Wall> w;
    add_room(&w, 0, 20, true);
    add_room(&w, 2, 18, false);
    const double alcoves[][2] = {{3, 0.3}, {7.5, 0.5}, {9, 0.2}, {14, 0.4}, {16.5, 0.25}};
    for (const auto &alcove : alcoves) {
        const double at = alcove[0];
        const double deep = alcove[1];
        w.push_back({{at + deep, deep}, {at, deep}});
        w.push_back({{20 - deep, at}, {20 - deep, at + 1.4 * deep}});
        w.push_back({{20 - at - deep, 20 - deep}, {20 - at, 20 - deep}});
        w.push_back({{deep, 20 - at}, {deep, 20 - at - 0.7 * deep}});
    }
    return w;
}

inline double largest_error_m(const std::vector<ale::Pose> &truth, const std::vector<ale::Pose> &poses)
{
    double largest = 0;
    for (size_t k = 0; k < truth.size(); k++) {
        largest = std::max(largest, ale::length(truth[k].x - poses[k].x, truth[k].y - poses[k].y));
    }
    return largest;
}

// The truth: along the middle of the corridor, `laps` times, a node every 0.5 m.
inline std::vector<ale::Pose> truth(double laps)
{
    std::vector<ale::Pose> poses;
    const double side = 18;
    for (double s = 0; s < laps * 4 * side; s += 0.5) {
        const int k = static_cast<int>(s / side) % 4;
        const double u = 1 + s - side * std::floor(s / side);
        const ale::Pose on_side[4] = {
            {u, 1, 0}, {19, u, ale::pi / 2}, {20 - u, 19, ale::pi}, {1, 20 - u, -ale::pi / 2}};
        poses.push_back(on_side[k]);
    }
    return poses;
}

inline ale::Node seen_from(const std::vector<Wall> &walls, const ale::Pose &pose, std::mt19937 *random)
{
    std::normal_distribution<double> noise(0, 0.004);
    ale::Node node = {};
    const ale::Pose to_robot = ale::inverse(pose);
    const Eigen::Vector2d sensor(pose.x, pose.y);
    for (const Wall &wall : walls) {
        const Eigen::Vector2d n = normal_of(wall);
        const double length = (wall.b - wall.a).norm();
        for (double u = 0.02; u < length; u += 0.08) {
            const double x = wall.a.x() + (wall.b.x() - wall.a.x()) / length * u - sensor.x();
            const double y = wall.a.y() + (wall.b.y() - wall.a.y()) / length * u - sensor.y();
            if (x * x + y * y > 16) {
                continue;
            }
            const Eigen::Vector2d p = sensor + Eigen::Vector2d(x, y) + n * noise(*random);
            if (n.dot(sensor - p) > 0.1) {
                node.points.push_back({ale::apply(to_robot, p), ale::rotation(-pose.theta) * n});
            }
        }
    }
    return node;
}

// Poses as tracked: with a scale error, heading drift and noise.
inline std::vector<ale::Pose> drifting_poses(const std::vector<ale::Pose> &truth, double bend_rad_m,
                                             unsigned seed)
{
    std::mt19937 random(seed);
    std::normal_distribution<double> noise(0, 1);
    std::vector<ale::Pose> tracked = {truth[0]};
    for (size_t k = 1; k < truth.size(); k++) {
        ale::Pose motion = ale::between(truth[k - 1], truth[k]);
        const double d = std::hypot(motion.x, motion.y);
        motion.x *= 1.004;
        motion.x += 0.002 * noise(random);
        motion.y += 0.002 * noise(random);
        motion.theta += bend_rad_m * d + 0.001 * noise(random);
        tracked.push_back(ale::compose(tracked.back(), motion));
    }
    return tracked;
}

// Nodes with such poses.
inline std::vector<ale::Node> drifting(const std::vector<ale::Pose> &truth, double bend_rad_m, unsigned seed)
{
    std::mt19937 random(seed + 1000);
    const std::vector<ale::Pose> tracked = drifting_poses(truth, bend_rad_m, seed);
    std::vector<ale::Node> nodes;
    for (size_t k = 0; k < truth.size(); k++) {
        ale::Node node = seen_from(walls(), truth[k], &random);
        node.scan = static_cast<uint32_t>(k);
        node.smooth = tracked[k];
        node.path_m = 0.5 * static_cast<double>(k);
        nodes.push_back(node);
    }
    return nodes;
}

} // namespace ring_corridor

#endif
