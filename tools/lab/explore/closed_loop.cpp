#include "lab/explore/closed_loop.h"

#include <cmath>
#include <cstring>
#include <new>

#include "common/command_line/wrong_use.h"
#include "lab/explore/scan_of_turn.h"
#include "lab/sim/units.h"

extern "C" {
#include "base/trig.h"
}

namespace explore
{

namespace
{

ale_pipeline_t *new_pipeline(const ale_pipeline_config_t &config)
{
    void *memory = ::operator new(ale_pipeline_size());
    std::memset(memory, 0, ale_pipeline_size());
    auto *pipeline = static_cast<ale_pipeline_t *>(memory);
    if (ale_pipeline_init(pipeline, &config) < 0) {
        ::operator delete(memory);
        throw cli::WrongUse("the configuration is refused by the core");
    }
    return pipeline;
}

sim::World mounted(sim::World world, const ale_pose_t &sensor)
{
    world.sensor = {sim::metres(sensor.x_um), sim::metres(sensor.y_um), sim::radians(sensor.theta_bam)};
    return world;
}

} // namespace

Place said_of(const ale_grid_t &grid, sim::Point p)
{
    const ale_cell_t cell = ale_grid_cell(&grid, {sim::micrometres(p.x), sim::micrometres(p.y)});
    if (cell == ALE_GRID_NONE || ale_grid_is_unknown(&grid, cell)) {
        return Place::unseen;
    }
    return ale_grid_is_free(&grid, cell) ? Place::free : Place::occupied;
}

ClosedLoop::ClosedLoop(const sim::World &world, const sim::WorldSource::Options &options,
                       const ale_config_t &config)
    : commands_{{0, {}}},
      source_(mounted(world, config.pipeline.sensor), options,
              [this](const sim::Robot &, int64_t play_us) { return command_at(play_us); }),
      pipeline_(new_pipeline(config.pipeline)), explorer_(std::make_unique<ale_explorer_t>())
{
    const ale_explorer_config_t explorer = ale_config_explorer(&config);
    ale_explorer_init(explorer_.get(), &explorer);
    ale_explorer_request(explorer_.get(), true);
}

std::optional<sim::Twist> ClosedLoop::command_at(int64_t play_us) const
{
    size_t k = commands_.size() - 1;
    while (k > 0 && commands_[k].from_us > play_us) {
        k--;
    }
    return commands_[k].twist;
}

void ClosedLoop::take_turn(const sim::Turn &turn, const Watcher &each_scan)
{
    const ale_scan_t scan = scan_of_turn(turn, source_.scanner());
    ale_estimate_t estimate;
    loops_.before_scan(pipeline_.get(), [this](const ale_correction_t &correction) {
        ale_explorer_correct(explorer_.get(), &correction);
    });
    ale_pipeline_scan(pipeline_.get(), &scan, &estimate);
    loops_.after_scan(pipeline_.get(), estimate);
    const int64_t effect_us = now_us_ + latency_us;
    const ale_velocity_t velocity = ale_explorer_step(explorer_.get(), &scan, &estimate, effect_us);
    commands_.push_back({effect_us, {velocity.speed_um_s * 1e-6, velocity.turn_urad_s * 1e-6}});
    trajectory_.push_back({estimate.stamp_us, estimate.map});
    truth_.push_back(source_.truth(estimate.stamp_us).value_or(sim::Pose{}));
    if (each_scan) {
        each_scan(scan, estimate);
    }
}

void ClosedLoop::run(double longest_s, const Watcher &each_scan)
{
    for (auto due = source_.due_us(); due && seconds() < longest_s && !finished(); due = source_.due_us()) {
        now_us_ = *due;
        const sim::Event event = source_.next();
        if (const auto *turn = std::get_if<sim::Turn>(&event)) {
            take_turn(*turn, each_scan);
        } else {
            const auto &report = std::get<sim::OdometryReport>(event);
            const ale_odometry_t sample = {report.stamp_us, sim::core_pose(report.pose)};
            ale_pipeline_odometry(pipeline_.get(), &sample);
        }
    }
}

std::unique_ptr<ale_map_t> ClosedLoop::map() const
{
    auto map = std::make_unique<ale_map_t>();
    ale_pipeline_copy_map(pipeline_.get(), map.get());
    return map;
}

double ClosedLoop::driven() const
{
    double metres = 0;
    for (size_t k = 1; k < truth_.size(); k++) {
        metres += sim::distance({truth_[k].x, truth_[k].y}, {truth_[k - 1].x, truth_[k - 1].y});
    }
    return metres;
}

} // namespace explore
