/* A recorded log as a scanner and its robot: scans and odometry go out as recorded, paced by the log's
 * stamps. A step of the stamps back, or of more than two seconds, is played as a tenth of a second.
 *
 * Whoever's scanner it was answers PP with its own values. */
#ifndef ALE_LAB_SIM_LOG_SOURCE_H
#define ALE_LAB_SIM_LOG_SOURCE_H

#include <deque>
#include <memory>
#include <string>

#include "common/log/log_reader.h"
#include "lab/sim/source.h"

namespace sim
{

/* Throws std::runtime_error when the log cannot be read or holds no scan. */
class LogSource : public Source
{
  public:
    LogSource(const std::string &path, bool once);

    const Scanner &scanner() const override
    {
        return scanner_;
    }
    std::optional<int64_t> due_us() override;
    Event next() override;
    std::optional<Pose> truth(int64_t) override
    {
        return std::nullopt;
    }
    /* Where the robot itself is in the scanner's way, as far as the log's reader knows. */
    const std::vector<BlindSector> &blind() const
    {
        return blind_;
    }
    const ale_log_info_t &info() const
    {
        return log_.info();
    }

  private:
    void read_ahead();
    void take_scan(const ale_scan_t &scan);
    void stay();
    int64_t play_time(int64_t stamp_us);

    bool once_;
    std::string path_;
    ale::LogReader log_;
    std::unique_ptr<ale_log_event_t> event_;
    Scanner scanner_;
    std::vector<BlindSector> blind_;
    std::deque<Turn> turns_;
    std::deque<OdometryReport> odometry_;
    std::deque<ale_odometry_t> unplaced_; /* read before the scan that says where the stamps stand */
    bool at_end_ = false;
    uint32_t scans_ = 0;
    int64_t offset_us_ = 0; /* stamp of the log minus time of play */
    int64_t last_start_us_ = 0;
    Turn last_turn_;
};

} // namespace sim

#endif
