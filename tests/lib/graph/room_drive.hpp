// A drive through a synthetic room: observations of its scans, their true poses, and its keyframes.
#ifndef TESTS_GRAPH_ROOM_DRIVE_HPP
#define TESTS_GRAPH_ROOM_DRIVE_HPP

#include <memory>
#include <vector>

#include "lib/track/room_pipeline.h"

extern "C" {
#include "graph/mapper.h"
#include "track/scan_observation.h"
}

struct RoomDrive {
    std::vector<std::unique_ptr<ale_scan_observation_t>> observations; // of every scan
    std::vector<ale_pose_t> truth;                                     // by scan, in the frame of the room
    std::unique_ptr<ale_mapper_poses_t> keyframes =
        std::make_unique<ale_mapper_poses_t>(); // at their true poses

    // `walls_at`: the walls at a scan; `pose_at`: the pose of the robot at a time in seconds.
    template <typename WallsAt, typename PoseAt> RoomDrive(int scans, WallsAt walls_at, PoseAt pose_at)
    {
        std::mt19937 rng(7);
        room::Sensor sensor;
        sensor.noise = 0.008;
        const ale_pipeline_config_t config = ale_pipeline_default_config();
        const room::Pipeline pipeline = room::make(config);
        const auto keyframe = std::make_unique<ale_keyframe_t>();
        for (int k = 0; k < scans; k++) {
            const double t = 1 + 0.1 * k;
            const ale_scan_t scan = room::scan_at(walls_at(k), sensor, pose_at, t, rng);
            ale_estimate_t estimate;
            ale_pipeline_scan(pipeline.get(), &scan, &estimate);
            truth.push_back(convert::pose(pose_at(t)));
            if (ale_pipeline_keyframe(pipeline.get(), keyframe.get())) {
                keyframes->epoch = keyframe->epoch;
                keyframes->pose[keyframes->count++] = {keyframe->scan, keyframe->smooth, truth.back(),
                                                       keyframe->map_id};
            }
            observations.push_back(std::make_unique<ale_scan_observation_t>());
            EXPECT_TRUE(ale_pipeline_scan_observation(pipeline.get(), observations.back().get()));
        }
    }
    template <typename WallsAt>
    RoomDrive(int scans, WallsAt walls_at) : RoomDrive(scans, walls_at, room::path)
    {
    }
};

#endif
