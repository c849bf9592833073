// Recordings of a simulated scanner with a known noise model, at rest or on a way.
#ifndef TESTS_TOOLS_ROBOT_CALIBRATE_SIMULATED_RECORDING_HPP
#define TESTS_TOOLS_ROBOT_CALIBRATE_SIMULATED_RECORDING_HPP

#include <cmath>
#include <functional>
#include <limits>

#include "lab/bench/simulate.hpp"
#include "robot/calibrate/noise_fit.h"

namespace simulated
{

constexpr double not_a_value = std::numeric_limits<double>::quiet_NaN();

struct Truth {
    ale_noise_t noise;
    double mixed;
};

/* A room of many walls, near and far, seen flat and slanted, with a box in it for depth edges. */
inline bench::World room_of_many_walls()
{
    bench::World world;
    const std::vector<bench::Point> corners{{-0.6, -0.5}, {0.3, -0.7}, {1.1, -0.8}, {2.2, -2.4},
                                            {3.6, -2.2},  {3.9, 0.2},  {3.0, 1.8},  {1.2, 1.6},
                                            {0.2, 3.4},   {-2.2, 2.6}, {-2.6, 0.3}};
    for (std::size_t k = 0; k < corners.size(); k++) {
        world.walls.push_back({corners[k], corners[(k + 1) % corners.size()]});
    }
    const std::vector<bench::Point> box{{1.3, -0.6}, {1.6, -0.5}, {1.5, -0.2}, {1.2, -0.3}};
    for (std::size_t k = 0; k < box.size(); k++) {
        world.walls.push_back({box[k], box[(k + 1) % box.size()]});
    }
    return world;
}

/* Three walls seen under the widest angles that 240 degrees allow. */
inline bench::World triangle()
{
    bench::World world;
    world.walls = {{{-1.2, -1}, {2.4, -0.9}}, {{2.4, -0.9}, {-0.4, 1.6}}, {{-0.4, 1.6}, {-1.2, -1}}};
    world.heading = 0.5;
    return world;
}

inline bool at_edge(const bench::Hit &a, const bench::Hit &b)
{
    return a.surface != b.surface && std::abs(a.range - b.range) > 0.2;
}

struct Simulation {
    bench::World world;
    Truth truth;
    std::vector<double> bias;

    double own_sigma(double d) const
    {
        return std::hypot(truth.noise.own_um * 1e-6, truth.noise.own_ppm * 1e-6 * d);
    }
    double shared_sigma(double d) const
    {
        return std::hypot(truth.noise.shared_um * 1e-6, truth.noise.shared_ppm * 1e-6 * d);
    }
    /* moved: x, y, heading from where it began. */
    std::vector<double> scan(bench::Random &random, const Eigen::Vector3d &moved) const
    {
        const double keep = std::exp(-1.0 / truth.noise.shared_beams);
        double shared = random.normal();
        std::vector<double> ranges(bench::urg_beams, not_a_value);
        std::vector<bench::Hit> exact;
        bench::World at = world;
        at.sensor += moved.head<2>();
        at.heading += moved.z();
        for (int k = 0; k < bench::urg_beams; k++) {
            exact.push_back(bench::cast(at, bench::urg_bearing(k)));
            const double jitter = truth.noise.bearing_nrad * 1e-9 * random.normal();
            const bench::Hit hit = bench::cast(at, bench::urg_bearing(k) + jitter);
            const double range = hit.range + bias[static_cast<std::size_t>(hit.surface)] +
                                 own_sigma(hit.range) * random.normal() + shared_sigma(hit.range) * shared;
            ranges[static_cast<std::size_t>(k)] = std::round(range * 1000) / 1000;
            shared = keep * shared + std::sqrt(1 - keep * keep) * random.normal();
        }
        for (std::size_t k = 0; k + 1 < exact.size(); k++) {
            if (at_edge(exact[k], exact[k + 1]) && random.chance(truth.mixed)) {
                ranges[k] = random.uniform(exact[k].range, exact[k + 1].range);
            }
        }
        return ranges;
    }
};

inline Simulation simulation(const Truth &truth, const bench::World &world = room_of_many_walls())
{
    Simulation s{world, truth, {}};
    bench::Random random(77);
    double square = 0;
    for (std::size_t k = 0; k < s.world.walls.size(); k++) {
        s.bias.push_back(random.normal());
        square += s.bias.back() * s.bias.back() / static_cast<double>(s.world.walls.size());
    }
    for (double &b : s.bias) {
        b *= truth.noise.surface_um * 1e-6 / std::sqrt(square);
    }
    return s;
}

/* Where the scanner stands at a time in seconds, from where it began. */
using Way = std::function<Eigen::Vector3d(double)>;

inline Eigen::Vector3d at_rest(double)
{
    return Eigen::Vector3d::Zero();
}

inline calibrate::Recording recording_of(const Simulation &s, int scans, const Way &way = at_rest)
{
    calibrate::Recording recording;
    bench::Random random(5);
    recording.range.resize(scans, bench::urg_beams);
    for (int k = 0; k < scans; k++) {
        std::vector<double> ranges = s.scan(random, way(0.1 * k));
        recording.range.row(k) = Eigen::Map<Eigen::RowVectorXd>(ranges.data(), bench::urg_beams);
        recording.time_s.push_back(0.1 * k);
    }
    recording.first_bearing = bench::urg_bearing(0);
    recording.step = bench::urg_step;
    bench::Random other(1);
    recording.geometry = std::move(bench::simulate(s.world, bench::noise_kind("3mm"), other).scan);
    return recording;
}

const Truth usual{{1500, 800, 2000, 2000, 12, 6000, 872665}, 0.3};

} // namespace simulated

#endif
