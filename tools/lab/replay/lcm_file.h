/* --lcm: what the robot would have sent over LCM, as an event log (lcm-logger's format) by the times of the
 * log that is replayed: ALE_SCAN, ALE_ODOMETRY, ALE_POSE, ALE_TRACKING, ALE_FEATURES, ALE_MAP, ALE_GRAPH. */
#ifndef ALE_LAB_REPLAY_LCM_FILE_H
#define ALE_LAB_REPLAY_LCM_FILE_H

#include <cstdint>
#include <memory>
#include <string>

#include "common/offline/offline_slam.h"

extern "C" {
#include "lcm/bus.h"
}

namespace ale
{

class LcmFile
{
  public:
    /* Throws std::runtime_error when it cannot be written, as close() does. */
    explicit LcmFile(const std::string &path);

    void put_scan(const ale_scan_t &scan, uint32_t number, const ale_pose_t &sensor);
    void put_odometry(const ale_odometry_t &sample);
    void put_estimate(const ale_estimate_t &estimate);
    void put_features(const ale_features_t &features, int64_t stamp_us, uint32_t number,
                      const ale_pose_t &sensor);
    /* Sent when it has changed, and once in ten scans at most. */
    void put_map(const OfflineSlam &slam, int64_t stamp_us);
    /* Sent when it has changed, once a second at most; the same every ten seconds. */
    void put_graph(const OfflineSlam &slam, int64_t stamp_us);

    /* After finish(): the graph as it stands in the end. */
    void close(const OfflineSlam &slam);

  private:
    void took(int result);
    [[noreturn]] void fail() const;
    void send_graph(const Loops &loops, int64_t stamp_us);

    std::string path_;
    std::unique_ptr<ale_bus_t, decltype(&ale_bus_close)> bus_;
    std::unique_ptr<ale_map_t> map_ = std::make_unique<ale_map_t>();
    uint64_t sent_ = 0; /* messages */
    uint32_t sent_version_ = 0;
    uint32_t scans_without_map_ = 0;
    std::unique_ptr<ale_mapper_graph_t> graph_ = std::make_unique<ale_mapper_graph_t>();
    uint32_t sent_graph_ = 0; /* its version; 0: none was sent */
    int64_t graph_sent_us_ = 0;
};

} // namespace ale

#endif
