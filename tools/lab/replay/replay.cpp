#include "lab/replay/replay.h"

#include <memory>
#include <optional>

#include "common/command_line/wrong_use.h"
#include "common/export/map_image.h"
#include "common/export/scan_cloud.h"
#include "common/log/core_object.h"
#include "common/log/robot_config.h"
#include "lab/replay/features_file.h"
#include "lab/replay/loops.h"
#include "lab/replay/map_pieces.h"
#include "lab/replay/poses_file.h"
#include "lab/replay/summary.h"
#include "lab/replay/timing.h"

extern "C" {
#include "store/map_file.h"
}

namespace ale
{

namespace
{

template <class T> void open_if_named(std::optional<T> &file, const std::string &path)
{
    if (!path.empty()) {
        file.emplace(path);
    }
}

class Replay
{
  public:
    explicit Replay(const ReplayOptions &options);
    void run();

  private:
    void begin(const char *recorded_config);
    void take(const ale_log_event_t &event);
    void take_scan(const ale_scan_t &recorded);
    void take_odometry(const ale_odometry_t &sample);
    void extract(const ale_scan_t &scan);
    void track(const ale_scan_t &scan);
    void lose(int64_t stamp_us);
    void put_results(int64_t stamp_us, const ale_features_t *features);
    void put_estimate(const ale_estimate_t &estimate);
    ale_pose_t framed(const ale_pose_t &robot) const;
    bool wants_map() const;
    void load_map();
    void close_loops();
    void finish();
    void draw_maps();

    const ReplayOptions &options_;
    LogReader log_;
    ale_config_t config_{};
    CoreObject<ale_pipeline_t> pipeline_;
    CoreObject<ale_extractor_t> extractor_;
    bool begun_ = false;

    std::optional<FeaturesFile> features_file_;
    std::optional<PosesFile> poses_file_;
    std::optional<TextFile> live_file_;
    std::optional<TextFile> trajectory_file_;
    std::optional<TimingFile> timing_file_;

    std::optional<Loops> loops_;
    std::optional<ObservationRecord> record_; /* when a map is asked for that may be drawn anew */
    std::unique_ptr<ale_map_t> known_;        /* loaded; until the record knows it */
    std::unique_ptr<ale_scan_observation_t> observation_ = std::make_unique<ale_scan_observation_t>();
    std::vector<ScanPose> track_;
    StageClock clock_;
    ReplayCounts counts_;
    ale_scan_t scan_{};
    ale_features_t features_{};
    ale_estimate_t estimate_{};
};

Replay::Replay(const ReplayOptions &options) : options_(options), log_(options.log)
{
    open_if_named(features_file_, options.features);
    open_if_named(poses_file_, options.poses);
    open_if_named(live_file_, options.trajectory_live);
    open_if_named(trajectory_file_, options.trajectory);
    open_if_named(timing_file_, options.timing);
}

/* Sets the core up, once it is known what with: before the first scan or odometry. */
void Replay::begin(const char *recorded_config)
{
    begun_ = true;
    config_ = robot_config(options_, log_.info(), recorded_config);
    const ale_stage_hook_t hook = clock_.hook();
    int status = 0;
    if (options_.lines_only) {
        extractor_ = core_object<ale_extractor_t>(ale_extractor_size());
        status = ale_extractor_init(extractor_.get(), &config_.pipeline.extract);
        ale_extractor_set_hook(extractor_.get(), &hook);
    } else {
        pipeline_ = core_object<ale_pipeline_t>(ale_pipeline_size());
        status = ale_pipeline_init(pipeline_.get(), &config_.pipeline);
        ale_pipeline_set_hook(pipeline_.get(), &hook);
        if (options_.close_loops) {
            loops_.emplace();
        }
        if (loops_ && wants_map()) {
            record_.emplace();
        }
    }
    if (status < 0) {
        throw cli::WrongUse("the configuration has a value that the core refuses");
    }
    if (!options_.load_map.empty()) {
        load_map();
    }
}

bool Replay::wants_map() const
{
    return !options_.maps.empty() || !options_.save_map.empty();
}

void Replay::load_map()
{
    auto map = std::make_unique<ale_map_t>();
    char error[ALE_MAP_FILE_ERROR];
    if (ale_map_file_load(options_.load_map.c_str(), map.get(), error) < 0) {
        throw std::runtime_error(error);
    }
    ale_pipeline_load_map(pipeline_.get(), map.get(), 1, ale_pose_t{}, false);
    if (loops_) {
        loops_->know(*map);
    }
    known_ = std::move(map);
}

void Replay::extract(const ale_scan_t &scan)
{
    scan_ = scan;
    clock_.begin_scan();
    ale_scan_mask(&scan_, config_.pipeline.blind, config_.pipeline.blind_count);
    ale_extract_scan(extractor_.get(), &scan_, nullptr, &features_);
    clock_.end_scan();
    put_results(scan.stamp_us, &features_);
}

void Replay::track(const ale_scan_t &scan)
{
    if (loops_) {
        loops_->before_scan(pipeline_.get());
    }
    clock_.begin_scan();
    ale_pipeline_scan(pipeline_.get(), &scan, &estimate_);
    clock_.end_scan();
    put_estimate(estimate_);
    put_results(scan.stamp_us, ale_pipeline_features(pipeline_.get()));
}

/* A scan that the device sent and nobody could read: answered by prediction. */
void Replay::lose(int64_t stamp_us)
{
    if (pipeline_) {
        ale_pipeline_dropped(pipeline_.get(), stamp_us, &estimate_);
        put_estimate(estimate_);
    }
    counts_.dropped++;
    put_results(stamp_us, nullptr);
}

void Replay::put_results(int64_t stamp_us, const ale_features_t *features)
{
    const auto scan = static_cast<uint32_t>(counts_.scans++);
    if (features_file_) {
        features_file_->put(scan, stamp_us, features);
    }
    if (!features) {
        return;
    }
    if (timing_file_) {
        timing_file_->put(scan, clock_);
    }
    counts_.lines += features->line_count;
    counts_.corners += features->corner_count;
    counts_.cpu_ns += clock_.total_ns();
    counts_.worst_ns = std::max(counts_.worst_ns, clock_.total_ns());
}

ale_pose_t Replay::framed(const ale_pose_t &robot) const
{
    return options_.laser_frame ? ale_pose_compose(robot, config_.pipeline.sensor) : robot;
}

void Replay::put_estimate(const ale_estimate_t &estimate)
{
    if (loops_) {
        loops_->after_scan(pipeline_.get(), estimate);
    }
    if (record_ && ale_pipeline_scan_observation(pipeline_.get(), observation_.get())) {
        if (known_) {
            record_->set_prior_map(observation_->epoch, *known_);
            known_.reset();
        }
        record_->add(*observation_);
    }
    counts_.maps = estimate.maps;
    counts_.wheel_faults = estimate.wheel_faults;
    counts_.weak += estimate.state == ALE_STATE_WEAK;
    counts_.lost += estimate.state == ALE_STATE_LOST;
    track_.push_back({estimate.stamp_us, estimate.map, estimate.velocity_x_um_s, estimate.velocity_y_um_s,
                      estimate.velocity_theta_urad_s, !estimate.predicted});
    if (poses_file_) {
        poses_file_->put(estimate);
    }
    if (live_file_) {
        put_tum_line(*live_file_, {estimate.stamp_us, framed(estimate.map)});
    }
}

void Replay::take_scan(const ale_scan_t &recorded)
{
    const ale_scan_t scan = mounted(recorded, config_.reversed && log_.info().raw_device);
    options_.lines_only ? extract(scan) : track(scan);
}

void Replay::take_odometry(const ale_odometry_t &sample)
{
    if (pipeline_ && config_.pipeline.use_odometry) {
        ale_pipeline_odometry(pipeline_.get(), &sample);
    }
}

void Replay::take(const ale_log_event_t &event)
{
    if (!begun_ && event.kind != ALE_LOG_COMMAND) {
        begin(event.kind == ALE_LOG_CONFIG ? event.text : nullptr);
    }
    switch (event.kind) {
    case ALE_LOG_SCAN:
        take_scan(event.scan);
        break;
    case ALE_LOG_SCAN_LOST:
        lose(event.stamp_us);
        break;
    case ALE_LOG_ODOMETRY:
        take_odometry(event.odometry);
        break;
    case ALE_LOG_COMMAND:
    case ALE_LOG_CONFIG:
        break;
    }
}

/* The points are read from the log once more: by then the corrected poses are known. */
ScanCloud gather_points(const ReplayOptions &options, const ale_config_t &config,
                        const std::vector<ScanPose> &track)
{
    ScanCloud cloud;
    LogReader log(options.log);
    auto event = std::make_unique<ale_log_event_t>();
    size_t next = 0;
    while (log.next(*event) && next < track.size()) {
        if (event->kind == ALE_LOG_SCAN) {
            ale_scan_t scan = mounted(event->scan, config.reversed && log.info().raw_device);
            ale_scan_mask(&scan, config.pipeline.blind, config.pipeline.blind_count);
            cloud.add(scan, track[next], config.pipeline.sensor);
        }
        next += event->kind == ALE_LOG_SCAN || event->kind == ALE_LOG_SCAN_LOST;
    }
    return cloud;
}

void Replay::draw_maps()
{
    auto map = std::make_unique<ale_map_t>();
    ale_pipeline_copy_map(pipeline_.get(), map.get());
    if (record_ && record_->epoch() != 0) {
        rebuild_pieces(
            *record_, [this](const RecordedScan &scan) { return track_[scan.scan].robot; },
            [this](uint32_t scan) { return loops_->map_of(scan); }, map.get());
    }
    if (!options_.save_map.empty()) {
        char error[ALE_MAP_FILE_ERROR];
        if (ale_map_file_save(options_.save_map.c_str(), map.get(), error) < 0) {
            throw std::runtime_error(error);
        }
    }
    if (options_.maps.empty()) {
        return;
    }
    const ScanCloud cloud = gather_points(options_, config_, track_);
    MapScene scene;
    scene.map = map.get();
    scene.cloud = &cloud;
    scene.draw_points = options_.points;
    for (const ScanPose &pose : track_) {
        scene.trajectory.push_back({pose.stamp_us, pose.robot});
    }
    print_pieces(*map);
    for (const std::string &path : options_.maps) {
        write_map_image(path, scene);
    }
}

/* From here on the track is the one that all loops have corrected. */
void Replay::close_loops()
{
    loops_->finish(pipeline_.get());
    for (size_t scan = 0; scan < track_.size(); scan++) {
        track_[scan].robot = loops_->corrected(static_cast<uint32_t>(scan));
    }
    print_loops(loops_->statistics(), loops_->longest_ns());
}

void Replay::finish()
{
    if (loops_) {
        close_loops();
    }
    if (trajectory_file_) {
        for (const ScanPose &pose : track_) {
            put_tum_line(*trajectory_file_, {pose.stamp_us, framed(pose.robot)});
        }
        trajectory_file_->close();
    }
    if (features_file_) {
        features_file_->close();
    }
    if (poses_file_) {
        poses_file_->close();
    }
    if (live_file_) {
        live_file_->close();
    }
    if (timing_file_) {
        timing_file_->close();
    }
    if (pipeline_) {
        draw_maps();
    }
}

void Replay::run()
{
    auto event = std::make_unique<ale_log_event_t>();
    {
        Progress progress;
        while (log_.next(*event)) {
            take(*event);
            progress.show(log_);
        }
    }
    if (counts_.scans == 0) {
        const std::string last = log_.last_error();
        throw std::runtime_error(options_.log + ": " + log_.info().format + " log without a scan" +
                                 (last.empty() ? "" : "; " + last));
    }
    finish();
    print_summary(options_.log, log_, counts_);
}

} // namespace

void replay(const ReplayOptions &options)
{
    std::make_unique<Replay>(options)->run();
}

} // namespace ale
