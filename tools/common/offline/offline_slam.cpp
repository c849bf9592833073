#include "common/offline/offline_slam.h"

#include <stdexcept>

#include "common/offline/map_pieces.h"

namespace ale
{

OfflineSlam::OfflineSlam(const ale_pipeline_config_t &config, Options options)
    : config_(config), pipeline_(core_object<ale_pipeline_t>(ale_pipeline_size()))
{
    if (ale_pipeline_init(pipeline_.get(), &config_) < 0) {
        throw std::invalid_argument("the configuration has a value that the core refuses");
    }
    const ale_stage_hook_t hook = clock_.hook();
    ale_pipeline_set_hook(pipeline_.get(), &hook);
    if (options.close_loops) {
        loops_.emplace();
        if (options.rebuilds_map) {
            record_.emplace();
        }
    }
}

void OfflineSlam::load_map(const ale_map_t &map, const std::optional<ale_pose_t> &start)
{
    ale_pipeline_load_map(pipeline_.get(), &map, 1, start.value_or(ale_pose_t{}), start.has_value());
    if (loops_) {
        loops_->know(map);
    }
    known_ = std::make_unique<ale_map_t>(map);
}

void OfflineSlam::load_tiles(const std::string &path, const std::optional<ale_pose_t> &start)
{
    tiles_.emplace(path);
    ale_pipeline_load_tiles(pipeline_.get(), start.value_or(ale_pose_t{}), start.has_value());
    record_.reset(); /* a drawing would be of a part: the map is the tracker's */
}

void OfflineSlam::odometry(const ale_odometry_t &sample)
{
    if (config_.use_odometry) {
        ale_pipeline_odometry(pipeline_.get(), &sample);
    }
}

const ale_estimate_t &OfflineSlam::scan(const ale_scan_t &scan)
{
    before_scan();
    clock_.begin_scan();
    ale_pipeline_scan(pipeline_.get(), &scan, &estimate_);
    clock_.end_scan();
    take_answer();
    return estimate_;
}

/* What is due; in the order of the firmware's estimate task. */
void OfflineSlam::before_scan()
{
    if (loops_) {
        loops_->before_scan(pipeline_.get());
    }
    if (tiles_) {
        tiles_->before_scan(pipeline_.get());
    }
}

const ale_estimate_t &OfflineSlam::dropped(int64_t stamp_us)
{
    ale_pipeline_dropped(pipeline_.get(), stamp_us, &estimate_);
    take_answer();
    return estimate_;
}

void OfflineSlam::take_answer()
{
    if (loops_) {
        loops_->after_scan(pipeline_.get(), estimate_);
    }
    if (tiles_) {
        tiles_->after_scan(pipeline_.get(), loops_ ? &*loops_ : nullptr);
    }
    if (record_ && ale_pipeline_scan_observation(pipeline_.get(), observation_.get())) {
        if (known_) {
            record_->set_prior_map(observation_->epoch, *known_);
            known_.reset();
        }
        record_->add(*observation_);
    }
    trajectory_.push_back({estimate_.stamp_us, estimate_.map, estimate_.velocity_x_um_s,
                           estimate_.velocity_y_um_s, estimate_.velocity_theta_urad_s, !estimate_.predicted});
}

void OfflineSlam::finish()
{
    finished_ = true;
    if (!loops_) {
        return;
    }
    loops_->finish(pipeline_.get());
    for (size_t scan = 0; scan < trajectory_.size(); scan++) {
        trajectory_[scan].robot = loops_->corrected(static_cast<uint32_t>(scan));
    }
}

void OfflineSlam::copy_map(ale_map_t *out) const
{
    ale_pipeline_copy_map(pipeline_.get(), out);
    if (finished_ && record_ && record_->epoch() != 0) {
        rebuild_pieces(
            *record_, [this](const RecordedScan &scan) { return trajectory_[scan.scan].robot; },
            [this](uint32_t scan) { return loops_->map_of(scan); }, out);
    }
}

} // namespace ale
