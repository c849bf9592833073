// Keyframes as the estimate task hands them out: ray-cast scans of the corridor around a block, with drifting
// poses.
#ifndef TESTS_GRAPH_DRIFTING_KEYFRAMES_HPP
#define TESTS_GRAPH_DRIFTING_KEYFRAMES_HPP

#include <memory>
#include <vector>

#include "lib/motion/room.h"
#include "ring_corridor.hpp"

extern "C" {
#include "track/keyframe.h"
}

namespace drifting_keyframes
{

using Keyframe = std::unique_ptr<ale_keyframe_t>;

inline std::vector<room::Wall> walls()
{
    std::vector<room::Wall> out;
    for (const ring_corridor::Wall &w : ring_corridor::walls()) {
        out.push_back({w.a.x(), w.a.y(), w.b.x(), w.b.y()});
    }
    return out;
}

// `laps` around the block; a keyframe every half metre, ten scans apart.
inline std::vector<Keyframe> walk(double laps, double bend_rad_m, unsigned seed)
{
    const std::vector<ale::Pose> truth = ring_corridor::truth(laps);
    const std::vector<ale::Pose> tracked = ring_corridor::drifting_poses(truth, bend_rad_m, seed);
    const std::vector<room::Wall> corridor = walls();
    std::mt19937 rng(seed);
    room::Sensor sensor;
    sensor.beam_time_ns = 0;
    sensor.noise = 0.004;
    std::vector<Keyframe> keyframes;
    for (size_t k = 0; k < truth.size(); k++) {
        const auto here = [&](double) { return reference::Pose(truth[k].x, truth[k].y, truth[k].theta); };
        Keyframe keyframe = std::make_unique<ale_keyframe_t>();
        keyframe->epoch = 1;
        keyframe->scan = static_cast<uint32_t>(10 * k);
        keyframe->smooth = keyframe->map = ale::to_core(tracked[k]);
        keyframe->taken = room::scan_at(corridor, sensor, here, 0.5 * static_cast<double>(k), rng);
        keyframes.push_back(std::move(keyframe));
    }
    return keyframes;
}

// The walls of the corridor as a map that was saved.
inline std::unique_ptr<ale_map_t> corridor_map()
{
    auto map = std::make_unique<ale_map_t>();
    for (const ring_corridor::Wall &w : ring_corridor::walls()) {
        ale_map_line_t &line = map->line[map->line_count++];
        line.start = {convert::um(w.a.x()), convert::um(w.a.y())};
        line.end = {convert::um(w.b.x()), convert::um(w.b.y())};
        line.seen = 50;
    }
    return map;
}

} // namespace drifting_keyframes

#endif
