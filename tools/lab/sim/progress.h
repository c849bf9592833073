/* How far it is, on a terminal, for work of more than two seconds. */
#ifndef ALE_LAB_SIM_PROGRESS_H
#define ALE_LAB_SIM_PROGRESS_H

#include <chrono>
#include <cinttypes>
#include <cstdint>
#include <cstdio>

#include <unistd.h>

namespace sim
{

class Progress
{
  public:
    Progress() : next_(Time::now() + std::chrono::seconds(2)), terminal_(isatty(STDERR_FILENO) != 0)
    {
    }
    ~Progress()
    {
        if (shown_) {
            std::fputs("\n", stderr);
        }
    }
    Progress(const Progress &) = delete;
    Progress &operator=(const Progress &) = delete;

    void show(int64_t play_us, uint64_t scans)
    {
        if (terminal_ && Time::now() >= next_) {
            std::fprintf(stderr, "\rale-sim: %.1f s, %" PRIu64 " scans ", static_cast<double>(play_us) / 1e6,
                         scans);
            shown_ = true;
            next_ = Time::now() + std::chrono::milliseconds(200);
        }
    }

  private:
    using Time = std::chrono::steady_clock;
    Time::time_point next_;
    bool terminal_;
    bool shown_ = false;
};

} // namespace sim

#endif
