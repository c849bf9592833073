/* A recorded log as a scanner and its robot: scans and odometry go out as recorded and in the order of the
 * log, paced by the log's stamps. A clock that was set back, and a long pause, are played as three seconds.
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

/* From the stamps of a log's scans to the time of play. */
class Timeline
{
  public:
    /* Begins with a scan that is to be at this time of play. */
    void begin(int64_t stamp_us, int64_t play_us)
    {
        offset_us_ = stamp_us - play_us;
        last_us_ = play_us;
    }
    /* Time of play of the next scan, which may lie before that of the last; never the same. */
    int64_t take(int64_t stamp_us);
    int64_t at(int64_t stamp_us) const
    {
        return stamp_us - offset_us_;
    }
    /* Of the last scan. */
    int64_t last_us() const
    {
        return last_us_;
    }

  private:
    int64_t offset_us_ = 0;
    int64_t last_us_ = 0;
};

/* Throws std::runtime_error when the log cannot be read or holds no scan. */
class LogSource : public Source
{
  public:
    /* speed: of the play, against the host's time. */
    LogSource(const std::string &path, bool once, double speed = 1);

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
    const ale_log_info_t &info() const
    {
        return log_.info();
    }

  private:
    struct Due {
        int64_t at_us;
        Event event;
    };

    void read_ahead();
    void begin(const ale_scan_t &scan);
    void take_scan(const ale_scan_t &scan);
    Turn turn_of(const ale_scan_t &scan, int32_t first_step) const;
    void send_odometry(const Timeline &before, int64_t scan_due_us);
    void stay();

    bool once_;
    double speed_;
    std::string path_;
    ale::LogReader log_;
    std::unique_ptr<ale_log_event_t> event_;
    Scanner scanner_;
    int64_t distance_us_ = 0;             /* least one of a frame from the odometry before and after it */
    std::deque<Due> due_;                 /* in the order of the log */
    std::deque<ale_odometry_t> unplaced_; /* read before the scan that says where the stamps stand */
    bool at_end_ = false;
    uint32_t scans_ = 0;
    Timeline timeline_;
    int64_t last_due_us_ = 0; /* of a scan or of odometry */
    Turn last_turn_;
};

} // namespace sim

#endif
