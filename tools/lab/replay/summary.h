/* What a replay says about itself on the standard error. */
#ifndef ALE_LAB_REPLAY_SUMMARY_H
#define ALE_LAB_REPLAY_SUMMARY_H

#include <chrono>
#include <cstdint>

#include "common/log/log_reader.h"

extern "C" {
#include "graph/mapper.h"
}

namespace ale
{

/* A bar on a terminal, for work of more than two seconds. */
class Progress
{
  public:
    Progress();
    ~Progress();
    Progress(const Progress &) = delete;
    Progress &operator=(const Progress &) = delete;
    void show(const LogReader &log);

  private:
    using Clock = std::chrono::steady_clock;
    bool terminal_;
    bool shown_ = false;
    Clock::time_point next_;
};

struct ReplayCounts {
    uint64_t scans = 0;
    uint64_t dropped = 0; /* that nobody could read */
    uint64_t weak = 0;    /* poses that rest on the prediction, */
    uint64_t lost = 0;    /* and of a robot that does not know where it is */
    uint32_t maps = 1;    /* not joined, after the last scan */
    uint32_t wheel_faults = 0;
    uint64_t lines = 0;
    uint64_t corners = 0;
    int64_t cpu_ns = 0;
    int64_t worst_ns = 0;
};

void print_summary(const std::string &path, const LogReader &log, const ReplayCounts &counts);

/* Which walls of the map that was drawn are in maps that are not joined with the first; nothing when none is.
 */
void print_pieces(const ale_map_t &map);

/* What came of the places that were seen again, and of maps begun anew; nothing when there were none. */
void print_loops(const ale_mapper_statistics_t &loops, int64_t longest_ns);

} // namespace ale

#endif
