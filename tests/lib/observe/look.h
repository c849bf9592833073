// The line observations of a scan of a made world.
#pragma once

#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "lib/motion/room.h"

extern "C" {
#include "extract/extract.h"
#include "observe/seen.h"
}

namespace room
{
struct Look {
    std::unique_ptr<ale_scan_t> scan = std::make_unique<ale_scan_t>();
    std::vector<ale_observation_t> observations = std::vector<ale_observation_t>(ALE_MAX_OBSERVATIONS);
    ale_seen_t seen = {};

    // What the scanner shows at `from`, for a robot that believes to be at `believed`.
    Look(const std::vector<Wall> &walls, const reference::Pose &from, const reference::Pose &believed)
    {
        std::mt19937 rng(3);
        Sensor sensor;
        sensor.beam_time_ns = 0;
        sensor.noise = 0.003;
        *scan = scan_at(
            walls, sensor, [&](double) { return from; }, 1, rng);
        std::unique_ptr<ale_extractor_t, void (*)(void *)> extractor(
            static_cast<ale_extractor_t *>(::operator new(ale_extractor_size())),
            [](void *p) { ::operator delete(p); });
        const ale_extract_config_t config = ale_extract_default_config();
        EXPECT_EQ(ale_extractor_init(extractor.get(), &config), 0);
        const auto features = std::make_unique<ale_features_t>();
        ale_extract_scan(extractor.get(), scan.get(), nullptr, features.get());
        const ale_pose_t pose = convert::pose(believed);
        const uint32_t count =
            ale_observe_lines(features.get(), scan.get(), {0, 0, 0}, 0, observations.data());
        seen = {{scan.get(), nullptr, pose}, pose, observations.data(), count};
    }
};
} // namespace room
