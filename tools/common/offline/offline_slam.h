/* Tracker and mapper in line, without threads: scans and odometry in, poses, lines and map out. What the same
 * scans give is the same, byte for byte, whoever hands them over: ale-replay a log, Python its arrays.
 *
 *   OfflineSlam slam(config, {});
 *   slam.odometry(sample);                     whenever there is one, before the scans after it
 *   const ale_estimate_t &now = slam.scan(scan);
 *   slam.finish();                             no scan after it
 *   slam.copy_map(&map);
 *
 * Allocates; one thread at a time. */
#ifndef ALE_COMMON_OFFLINE_OFFLINE_SLAM_H
#define ALE_COMMON_OFFLINE_OFFLINE_SLAM_H

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/offline/core_object.h"
#include "common/offline/loops.h"
#include "common/offline/scan_pose.h"
#include "common/offline/stage_clock.h"
#include "common/offline/tiles.h"
#include "graph/walls/observation_record.h"

extern "C" {
#include "track/pipeline.h"
#include "track/scan_observation.h"
}

namespace ale
{

class OfflineSlam
{
  public:
    struct Options {
        bool close_loops = true;
        bool rebuilds_map = true; /* at the end, from all scans (only with loops); else the tracker's */
    };

    /* Throws std::invalid_argument when the core refuses the configuration. */
    OfflineSlam(const ale_pipeline_config_t &config, Options options);

    /* Before the first scan: starts in this map, lost until found: at `start`, if that is known. */
    void load_map(const ale_map_t &map, const std::optional<ale_pose_t> &start = std::nullopt);

    /* The same for a map of tiles, of which as much is in work as lies around the robot. Throws
     * std::runtime_error with one line. */
    void load_tiles(const std::string &path, const std::optional<ale_pose_t> &start);

    void odometry(const ale_odometry_t &sample);

    /* Until the next call; the same for a scan that was lost on its way, answered by prediction. */
    const ale_estimate_t &scan(const ale_scan_t &scan);
    const ale_estimate_t &dropped(int64_t stamp_us);

    /* Of the scan handed over last: sensor frame at its stamp. */
    const ale_features_t &features() const
    {
        return *ale_pipeline_features(pipeline_.get());
    }
    const StageClock &clock() const
    {
        return clock_;
    }

    /* After the last scan: every pose of the trajectory is corrected by all loops. */
    void finish();

    /* By scan: as tracked, and after finish() as corrected. */
    const std::vector<ScanPose> &trajectory() const
    {
        return trajectory_;
    }
    /* The map as it stands; after finish() built anew where it was to be. */
    void copy_map(ale_map_t *out) const;

    /* The mapper, if there is one. */
    const Loops *loops() const
    {
        return loops_ ? &*loops_ : nullptr;
    }

  private:
    void before_scan();
    void take_answer();

    ale_pipeline_config_t config_;
    CoreObject<ale_pipeline_t> pipeline_;
    std::optional<Loops> loops_;
    std::optional<Tiles> tiles_;
    std::optional<ObservationRecord> record_;
    std::unique_ptr<ale_map_t> known_; /* loaded; until the record knows it */
    std::unique_ptr<ale_scan_observation_t> observation_ = std::make_unique<ale_scan_observation_t>();
    std::vector<ScanPose> trajectory_;
    StageClock clock_;
    ale_estimate_t estimate_{};
    bool finished_ = false;
};

} // namespace ale

#endif
