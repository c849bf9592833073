#include "lab/replay/replay.h"

#include <memory>
#include <optional>

#include "common/command_line/wrong_use.h"
#include "common/export/map_image.h"
#include "common/export/scan_cloud.h"
#include "common/log/robot_config.h"
#include "common/offline/core_object.h"
#include "common/offline/offline_slam.h"
#include "lab/replay/bag.h"
#include "lab/replay/features_file.h"
#include "lab/replay/lcm_file.h"
#include "lab/replay/poses_file.h"
#include "lab/replay/summary.h"
#include "lab/replay/timing_file.h"

extern "C" {
#include "store/map_file.h"
#include "store/tile_file.h"
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
    void begin_extractor();
    void begin_slam();
    void take(const ale_log_event_t &event);
    void take_scan(const ale_scan_t &recorded);
    void take_odometry(const ale_odometry_t &sample);
    void extract(const ale_scan_t &scan);
    void track(const ale_scan_t &scan);
    void lose(int64_t stamp_us);
    void put_results(int64_t stamp_us, const ale_features_t *features, const StageClock &clock);
    void put_estimate(const ale_estimate_t &estimate);
    void put_lcm(const ale_scan_t &scan, const ale_features_t &features);
    ale_pose_t framed(const ale_pose_t &robot) const;
    bool wants_map() const;
    void load_map();
    void finish();
    void draw_maps();

    const ReplayOptions &options_;
    LogFile file_;
    LogReader log_;
    ale_config_t config_{};
    std::optional<OfflineSlam> slam_;       /* unless */
    CoreObject<ale_extractor_t> extractor_; /* only lines are asked for */
    bool begun_ = false;

    std::optional<FeaturesFile> features_file_;
    std::optional<PosesFile> poses_file_;
    std::optional<TextFile> live_file_;
    std::optional<TextFile> trajectory_file_;
    std::optional<TimingFile> timing_file_;
    std::optional<LcmFile> lcm_file_;

    StageClock clock_; /* of the extractor */
    ReplayCounts counts_;
    ale_scan_t scan_{};
    ale_features_t features_{};
};

Replay::Replay(const ReplayOptions &options) : options_(options), file_(options.log), log_(file_.path())
{
    open_if_named(features_file_, options.features);
    open_if_named(poses_file_, options.poses);
    open_if_named(live_file_, options.trajectory_live);
    open_if_named(trajectory_file_, options.trajectory);
    open_if_named(timing_file_, options.timing);
    open_if_named(lcm_file_, options.lcm);
}

/* Sets the core up, once it is known what with: before the first scan or odometry. */
void Replay::begin(const char *recorded_config)
{
    begun_ = true;
    config_ = robot_config(options_, log_.info(), recorded_config);
    if (options_.lines_only) {
        begin_extractor();
    } else {
        begin_slam();
    }
}

constexpr char refused_config[] = "the configuration has a value that the core refuses";

void Replay::begin_extractor()
{
    const ale_stage_hook_t hook = clock_.hook();
    extractor_ = core_object<ale_extractor_t>(ale_extractor_size());
    if (ale_extractor_init(extractor_.get(), &config_.pipeline.extract) < 0) {
        throw cli::WrongUse(refused_config);
    }
    ale_extractor_set_hook(extractor_.get(), &hook);
}

void Replay::begin_slam()
{
    try {
        slam_.emplace(config_.pipeline, OfflineSlam::Options{options_.close_loops, wants_map()});
    } catch (const std::invalid_argument &) {
        throw cli::WrongUse(refused_config);
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
    if (ale_tile_file_is(options_.load_map.c_str())) {
        slam_->load_tiles(options_.load_map, options_.start);
        return;
    }
    auto map = std::make_unique<ale_map_t>();
    char error[ALE_MAP_FILE_ERROR];
    if (ale_map_file_load(options_.load_map.c_str(), map.get(), error) < 0) {
        throw std::runtime_error(error);
    }
    slam_->load_map(*map, options_.start);
}

void Replay::extract(const ale_scan_t &scan)
{
    scan_ = scan;
    clock_.begin_scan();
    ale_scan_mask(&scan_, config_.pipeline.blind, config_.pipeline.blind_count);
    ale_extract_scan(extractor_.get(), &scan_, nullptr, &features_);
    clock_.end_scan();
    put_results(scan.stamp_us, &features_, clock_);
}

void Replay::track(const ale_scan_t &scan)
{
    put_estimate(slam_->scan(scan));
    if (lcm_file_) {
        put_lcm(scan, slam_->features());
    }
    put_results(scan.stamp_us, &slam_->features(), slam_->clock());
}

void Replay::put_lcm(const ale_scan_t &scan, const ale_features_t &features)
{
    const auto number = static_cast<uint32_t>(counts_.scans);
    lcm_file_->put_scan(scan, number, config_.pipeline.sensor);
    lcm_file_->put_features(features, scan.stamp_us, number, config_.pipeline.sensor);
    lcm_file_->put_map(*slam_, scan.stamp_us);
    lcm_file_->put_graph(*slam_, scan.stamp_us);
}

/* A scan that the device sent and nobody could read: answered by prediction. */
void Replay::lose(int64_t stamp_us)
{
    if (slam_) {
        put_estimate(slam_->dropped(stamp_us));
    }
    counts_.dropped++;
    put_results(stamp_us, nullptr, clock_);
}

/* features == nullptr: the scan was lost on its way. */
void Replay::put_results(int64_t stamp_us, const ale_features_t *features, const StageClock &clock)
{
    const auto scan = static_cast<uint32_t>(counts_.scans++);
    if (features_file_) {
        features_file_->put(scan, stamp_us, features);
    }
    if (!features) {
        return;
    }
    if (timing_file_) {
        timing_file_->put(scan, clock);
    }
    counts_.lines += features->line_count;
    counts_.corners += features->corner_count;
    counts_.cpu_ns += clock.total_ns();
    counts_.worst_ns = std::max(counts_.worst_ns, clock.total_ns());
}

ale_pose_t Replay::framed(const ale_pose_t &robot) const
{
    return options_.laser_frame ? ale_pose_compose(robot, config_.pipeline.sensor) : robot;
}

void Replay::put_estimate(const ale_estimate_t &estimate)
{
    counts_.maps = estimate.maps;
    counts_.wheel_faults = estimate.wheel_faults;
    counts_.weak += estimate.state == ALE_STATE_WEAK;
    counts_.lost += estimate.state == ALE_STATE_LOST;
    if (poses_file_) {
        poses_file_->put(estimate);
    }
    if (lcm_file_) {
        lcm_file_->put_estimate(estimate);
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
    if (slam_) {
        slam_->odometry(sample);
    }
    if (lcm_file_) {
        lcm_file_->put_odometry(sample);
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
ScanCloud gather_points(const std::string &path, int32_t cell_um, const ale_config_t &config,
                        const std::vector<ScanPose> &track)
{
    ScanCloud cloud(cell_um);
    LogReader log(path);
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
    slam_->copy_map(map.get());
    if (!options_.save_map.empty()) {
        char error[ALE_MAP_FILE_ERROR];
        if (ale_map_file_save(options_.save_map.c_str(), map.get(), error) < 0) {
            throw std::runtime_error(error);
        }
    }
    if (options_.maps.empty()) {
        return;
    }
    const ScanCloud cloud = gather_points(file_.path(), options_.map_cell_um, config_, slam_->trajectory());
    MapScene scene;
    scene.map = map.get();
    scene.cloud = &cloud;
    scene.draw_points = options_.points;
    for (const ScanPose &pose : slam_->trajectory()) {
        scene.trajectory.push_back({pose.stamp_us, pose.robot});
    }
    print_pieces(*map);
    for (const std::string &path : options_.maps) {
        write_map_image(path, scene);
    }
}

void Replay::finish()
{
    if (slam_) {
        slam_->finish();
    }
    if (slam_ && slam_->loops()) {
        print_loops(slam_->loops()->statistics(), slam_->loops()->longest_ns());
    }
    if (trajectory_file_) {
        for (const ScanPose &pose : slam_->trajectory()) {
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
    if (lcm_file_) {
        lcm_file_->close(*slam_);
    }
    if (slam_) {
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
