#include "lab/merge/read_drive.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <stdexcept>

#include <sys/stat.h>

#include "common/command_line/wrong_use.h"
#include "common/offline/core_object.h"
#include "common/offline/loops.h"
#include "graph/optimise/scan_node.h"
#include "lab/merge/whole_text.h"
#include "lab/replay/summary.h"

namespace merge
{

namespace
{

constexpr int64_t million = 1000000;
constexpr int64_t year_2000_s = 946684800; /* earlier stamps count from some start, and not from 1970 */

class DriveReader
{
  public:
    DriveReader(const std::string &path, const ale::RobotOptions &robot)
        : robot_(robot), path_(path), log_(path)
    {
    }
    Drive read(const std::vector<ScanPlace> *places);

  private:
    void begin(const char *recorded_config);
    void take(const ale_log_event_t &event);
    void take_scan(const ale_scan_t &recorded);
    void lose(int64_t stamp_us);
    void put(const ale_estimate_t &estimate);
    void put_node(const ale_keyframe_t &keyframe);
    std::vector<ScanPlace> own_places();
    void place(const std::vector<ScanPlace> &places);

    const ale::RobotOptions &robot_;
    std::string path_;
    ale::LogReader log_;
    ale_config_t config_{};
    ale::CoreObject<ale_pipeline_t> pipeline_;
    ale::Loops loops_;
    std::unique_ptr<ale_scan_observation_t> observation_ = std::make_unique<ale_scan_observation_t>();
    Drive drive_{};
};

void DriveReader::begin(const char *recorded_config)
{
    config_ = ale::robot_config(robot_, log_.info(), recorded_config);
    pipeline_ = ale::core_object<ale_pipeline_t>(ale_pipeline_size());
    if (ale_pipeline_init(pipeline_.get(), &config_.pipeline) < 0) {
        throw cli::WrongUse("the configuration has a value that the core refuses");
    }
}

void DriveReader::take(const ale_log_event_t &event)
{
    if (!pipeline_ && event.kind != ALE_LOG_COMMAND) {
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
        if (config_.pipeline.use_odometry) {
            ale_pipeline_odometry(pipeline_.get(), &event.odometry);
        }
        break;
    case ALE_LOG_COMMAND:
    case ALE_LOG_CONFIG:
        break;
    }
}

void DriveReader::take_scan(const ale_scan_t &recorded)
{
    const ale_scan_t scan = ale::mounted(recorded, config_.reversed && log_.info().raw_device);
    loops_.before_scan(pipeline_.get());
    ale_estimate_t estimate;
    ale_pipeline_scan(pipeline_.get(), &scan, &estimate);
    put(estimate);
}

/* A scan that the device sent and nobody could read: answered by prediction. */
void DriveReader::lose(int64_t stamp_us)
{
    ale_estimate_t estimate;
    ale_pipeline_dropped(pipeline_.get(), stamp_us, &estimate);
    put(estimate);
}

void DriveReader::put(const ale_estimate_t &estimate)
{
    loops_.after_scan(pipeline_.get(), estimate);
    ale_seen_t seen;
    const bool sees = ale_pipeline_seen(pipeline_.get(), &seen);
    const ale_features_t *features = ale_pipeline_features(pipeline_.get());
    drive_.scans.push_back({estimate.stamp_us,
                            {},
                            0,
                            !drive_.scans.empty(),
                            sees ? ale::surface_of(seen, *features) : std::vector<ale::SurfacePoint>()});
    if (loops_.keyframe()) {
        put_node(*loops_.keyframe());
    } else if (sees && !drive_.nodes.empty()) {
        const ale_pose_t sensor = ale_pose_between(seen.robot, seen.posed.sensor);
        ale::add_later_walls(ale::from_core(estimate.smooth),
                             ale::walls_of(*features, ale::from_core(sensor)), &drive_.nodes.back());
    }
    if (ale_pipeline_scan_observation(pipeline_.get(), observation_.get())) {
        drive_.record.add(*observation_);
    }
}

void DriveReader::put_node(const ale_keyframe_t &keyframe)
{
    drive_.nodes.push_back(ale::node_of(keyframe));
    if (keyframe.broken) {
        drive_.scans[keyframe.tied_from].follows = false;
    }
}

/* Where the mapper puts every scan; its maps become frames, in the order of the drive. */
std::vector<ScanPlace> DriveReader::own_places()
{
    loops_.finish(pipeline_.get());
    std::map<uint32_t, uint32_t> frames;
    std::vector<ScanPlace> places;
    for (uint32_t k = 0; k < drive_.scans.size(); k++) {
        const auto next = static_cast<uint32_t>(frames.size());
        places.push_back({loops_.corrected(k), frames.emplace(loops_.map_of(k), next).first->second});
    }
    return places;
}

void DriveReader::place(const std::vector<ScanPlace> &places)
{
    for (size_t k = 0; k < drive_.scans.size(); k++) {
        drive_.scans[k].pose = ale::from_core(places[k].pose);
        drive_.scans[k].frame = places[k].frame;
    }
    for (ale::Node &node : drive_.nodes) {
        node.tracked = drive_.scans[node.scan].pose;
        node.map_id = drive_.scans[node.scan].frame;
    }
}

Drive DriveReader::read(const std::vector<ScanPlace> *places)
{
    auto event = std::make_unique<ale_log_event_t>();
    ale::Progress progress;
    while (log_.next(*event)) {
        take(*event);
        progress.show(log_);
    }
    if (!places && !drive_.scans.empty()) {
        place(own_places());
    } else if (places && places->size() == drive_.scans.size()) {
        place(*places);
    } else if (places) {
        throw std::runtime_error(path_ + ": its poses are those of another drive");
    }
    drive_.sensor = config_.pipeline.sensor;
    return std::move(drive_);
}

int64_t date_of(const std::string &path, int64_t stamp_us)
{
    if (stamp_us / million >= year_2000_s) {
        return stamp_us / million;
    }
    struct stat status {
    };
    return stat(path.c_str(), &status) == 0 ? int64_t{status.st_mtime} : 0;
}

} // namespace

Drive read_drive(const std::string &path, const ale::RobotOptions &robot,
                 const std::vector<ScanPlace> *places)
{
    Drive drive = DriveReader(path, robot).read(places);
    if (drive.nodes.empty()) {
        throw std::runtime_error(path + ": no scan that a map could begin with");
    }
    drive.name = std::filesystem::path(path).filename();
    drive.date_s = date_of(path, drive.scans.front().stamp_us);
    drive.checksum = checksum_of_file(path);
    return drive;
}

} // namespace merge
