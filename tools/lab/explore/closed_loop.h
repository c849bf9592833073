/* Exploration in a closed loop, without lines, threads and clocks: world, robot and scanner of the simulator,
 * the pipeline, mapper and explorer of the robot, in lock step, so that minutes pass in seconds and a seed
 * decides all. */
#ifndef ALE_LAB_EXPLORE_CLOSED_LOOP_H
#define ALE_LAB_EXPLORE_CLOSED_LOOP_H

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "common/export/trajectory.h"
#include "common/offline/loops.h"
#include "lab/explore/score.h"
#include "lab/sim/world/world_source.h"

extern "C" {
#include "config/config.h"
#include "plan/explorer.h"
#include "track/pipeline.h"
}

namespace explore
{

/* From the arrival of a scan until the wheels obey what follows from it: computing, messages, the drive's
 * period. */
constexpr int64_t latency_us = 60000;

/* What the robot's grid says of a place, in the frame of its start. */
Place said_of(const ale_grid_t &grid, sim::Point p);

class ClosedLoop
{
  public:
    using Watcher = std::function<void(const ale_scan_t &, const ale_estimate_t &)>;

    /* The scanner is mounted as the configuration says, whatever the world's file says. */
    ClosedLoop(const sim::World &world, const sim::WorldSource::Options &options, const ale_config_t &config);

    /* Goes on until the exploration is over or the time is up; `each_scan` may look. */
    void run(double longest_s, const Watcher &each_scan = {});

    bool finished() const
    {
        return explorer_->state == ALE_EXPLORER_FINISHED;
    }
    const ale_explorer_t &explorer() const
    {
        return *explorer_;
    }
    /* As estimated; and the truth. */
    const ale::Trajectory &trajectory() const
    {
        return trajectory_;
    }
    const std::vector<sim::Pose> &truth() const
    {
        return truth_;
    }
    std::unique_ptr<ale_map_t> map() const;
    /* The mapper's: how many loops it believed, and so on. */
    ale_mapper_statistics_t mapper() const
    {
        return loops_.statistics();
    }
    double seconds() const
    {
        return static_cast<double>(now_us_) * 1e-6;
    }
    /* Metres, along the true way. */
    double driven() const;
    uint32_t collisions() const
    {
        return source_.collisions();
    }

  private:
    struct Command {
        int64_t from_us;
        sim::Twist twist;
    };
    struct FreePipeline {
        void operator()(ale_pipeline_t *pipeline) const
        {
            ::operator delete(pipeline);
        }
    };

    std::optional<sim::Twist> command_at(int64_t play_us) const;
    void take_turn(const sim::Turn &turn, const Watcher &each_scan);

    std::vector<Command> commands_;
    sim::WorldSource source_;
    std::unique_ptr<ale_pipeline_t, FreePipeline> pipeline_;
    ale::Loops loops_;
    std::unique_ptr<ale_explorer_t> explorer_;
    ale::Trajectory trajectory_;
    std::vector<sim::Pose> truth_;
    int64_t now_us_ = 0;
};

} // namespace explore

#endif
