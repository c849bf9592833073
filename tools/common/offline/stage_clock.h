/* Thread CPU time of the stages of a scan, told by the core's stage hook. */
#ifndef ALE_COMMON_OFFLINE_STAGE_CLOCK_H
#define ALE_COMMON_OFFLINE_STAGE_CLOCK_H

#include <array>
#include <cstdint>

extern "C" {
#include "base/stage.h"
}

namespace ale
{

class StageClock
{
  public:
    /* The hook keeps a pointer to this object. */
    ale_stage_hook_t hook();
    void begin_scan();
    void end_scan();
    int64_t stage_ns(ale_stage_t stage) const
    {
        return stage_ns_[stage];
    }
    /* From begin_scan to end_scan. */
    int64_t total_ns() const
    {
        return total_ns_;
    }

  private:
    static void end_of(void *user, ale_stage_t stage);

    int64_t begin_ns_ = 0;
    int64_t last_ns_ = 0;
    int64_t total_ns_ = 0;
    std::array<int64_t, ALE_STAGES> stage_ns_{};
};

} // namespace ale

#endif
