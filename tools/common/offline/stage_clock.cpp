#include "common/offline/stage_clock.h"

#include <ctime>

namespace ale
{

namespace
{

int64_t thread_cpu_ns()
{
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<int64_t>(now.tv_sec) * 1000000000 + now.tv_nsec;
}

} // namespace

ale_stage_hook_t StageClock::hook()
{
    return {end_of, this};
}

void StageClock::begin_scan()
{
    stage_ns_.fill(0);
    begin_ns_ = last_ns_ = thread_cpu_ns();
}

void StageClock::end_scan()
{
    total_ns_ = thread_cpu_ns() - begin_ns_;
}

void StageClock::end_of(void *user, ale_stage_t stage)
{
    auto *clock = static_cast<StageClock *>(user);
    const int64_t now_ns = thread_cpu_ns();
    clock->stage_ns_[stage] += now_ns - clock->last_ns_;
    clock->last_ns_ = now_ns;
}

} // namespace ale
