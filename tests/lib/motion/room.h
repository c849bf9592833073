// A made world for tests: walls, and a scanner that sweeps while it moves. No noise unless asked for.
#pragma once

#include <cmath>
#include <random>
#include <vector>

#include "convert.h"

extern "C" {
#include "base/scan.h"
}

namespace room
{
struct Wall {
    double x1, y1, x2, y2;
};

// An L-shaped room of 6 m by 5 m with a cupboard and a short wall: no direction is open anywhere in it.
inline std::vector<Wall> l_shape()
{
    return {{-1, -2, 5, -2},      {5, -2, 5, 1},        {5, 1, 2.5, 1},         {2.5, 1, 2.5, 3},
            {2.5, 3, -1, 3},      {-1, 3, -1, -2},      {3.6, -2, 3.6, -1.5},   {3.6, -1.5, 4.4, -1.5},
            {4.4, -1.5, 4.4, -2}, {-1, 1.2, -0.4, 1.2}, {-0.4, 1.2, -0.4, 1.8}, {-0.4, 1.8, -1, 1.8}};
}

inline double distance(const std::vector<Wall> &walls, double x, double y, double a)
{
    double best = 1e9;
    const double dx = std::cos(a);
    const double dy = std::sin(a);
    for (const Wall &w : walls) {
        const double ex = w.x2 - w.x1;
        const double ey = w.y2 - w.y1;
        const double det = dx * ey - dy * ex;
        if (std::abs(det) < 1e-12) {
            continue;
        }
        const double r = ((w.x1 - x) * ey - (w.y1 - y) * ex) / det;
        const double u = ((w.x1 - x) * dy - (w.y1 - y) * dx) / det;
        if (r > 0 && u >= 0 && u <= 1) {
            best = std::min(best, r);
        }
    }
    return best;
}

// The robot drives a figure that turns both ways; pose and body velocity at a time.
inline reference::Pose path(double t)
{
    const double s = 0.35 * t;
    return {0.2 + 1.3 * (1 - std::cos(s)), -0.4 + 0.9 * std::sin(s),
            reference::pi / 2 - s + 0.5 * std::sin(1.1 * t)};
}

struct Sensor {
    int beams = 682;
    double first = -340 * 2 * reference::pi / 1024;
    double step = 2 * reference::pi / 1024;
    int32_t beam_time_ns = 97656;
    double noise = 0;
    double reach = 5.6;
    reference::Pose mounting{0, 0, 0};
};

template <typename Path>
ale_scan_t scan_at(const std::vector<Wall> &walls, const Sensor &s, Path path_of, double t, std::mt19937 &rng)
{
    std::normal_distribution<double> normal;
    ale_scan_t scan = {};
    scan.stamp_us = std::llround(t * 1e6);
    scan.stamp_beam = s.beams / 2;
    scan.beam_time_ns = s.beam_time_ns;
    scan.first_bearing_bam = convert::bam(s.first);
    scan.step_bam = static_cast<int32_t>(convert::bam(s.step));
    scan.range_min_um = 20000;
    scan.range_max_um = convert::um(s.reach);
    scan.beams = static_cast<uint16_t>(s.beams);
    for (int k = 0; k < s.beams; k++) {
        const double tk = t + (k - s.beams / 2) * s.beam_time_ns * 1e-9;
        const reference::Pose p = reference::compose(path_of(tk), s.mounting);
        const double r = distance(walls, p[0], p[1], p[2] + s.first + k * s.step);
        ale_scan_set_range(&scan, static_cast<uint16_t>(k),
                           r > s.reach - 0.1 ? 0 : convert::um(r + s.noise * normal(rng)));
    }
    return scan;
}

// A bend at 0.4 m/s and 0.8 rad/s; the robot stops after drives_s.
inline reference::Pose bend(double t, double drives_s)
{
    const double driven_s = std::min(t, drives_s);
    return {0.4 * driven_s, 0, 0.8 * driven_s};
}

// The pose in the frame of the robot's first pose.
inline reference::Pose since_start(const reference::Pose &start, const reference::Pose &p)
{
    return reference::compose(reference::inverse(start), p);
}
} // namespace room
