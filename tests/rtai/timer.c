/* Timer and time. Counts run 2.4 times as fast as nanoseconds and RTAI's clock is 1000 s ahead of
 * CLOCK_MONOTONIC: what mixes them up fails. */
#include <errno.h>

#include "emulation.h"
#include "internal.h"

#define NS_PER_S 1000000000LL
#define AHEAD_NS (1000 * NS_PER_S)

static bool timer_runs;

void rt_set_oneshot_mode(void)
{
    timer_runs = false;
}

void rt_set_periodic_mode(void)
{
    timer_runs = false;
}

RTIME start_rt_timer(int period)
{
    timer_runs = true;
    return period;
}

void stop_rt_timer(void)
{
    timer_runs = false;
}

int rt_is_hard_timer_running(void)
{
    return timer_runs;
}

RTIME nano2count(RTIME nanoseconds)
{
    return nanoseconds * 12 / 5;
}

RTIME count2nano(RTIME counts)
{
    return counts * 5 / 12;
}

RTIME rt_get_time_ns(void)
{
    struct timespec now;
    rtai_enter();
    clock_gettime(CLOCK_MONOTONIC, &now);
    rtai_leave();
    return now.tv_sec * NS_PER_S + now.tv_nsec + AHEAD_NS;
}

RTIME rt_get_time(void)
{
    return nano2count(rt_get_time_ns());
}

struct timespec rtai_wake_time(RTIME counts)
{
    if (!timer_runs) {
        rtai_misuse("a wait for a moment while RTAI's timer does not run");
    }
    const RTIME ns = count2nano(counts) - AHEAD_NS;
    return (struct timespec){.tv_sec = ns > 0 ? ns / NS_PER_S : 0, .tv_nsec = ns > 0 ? ns % NS_PER_S : 0};
}

void rtai_sleep_until(RTIME counts)
{
    const struct timespec until = rtai_wake_time(counts);
    while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, NULL) == EINTR) {
    }
}

int rt_sleep(RTIME delay)
{
    if (!rt_agent()) {
        rtai_misuse("a thread that is no task wants to sleep");
    }
    if (delay <= 0) {
        return RTE_TMROVRN;
    }
    const RTIME until = rt_get_time() + delay;
    rtai_enter();
    rtai_sleep_until(until);
    rtai_leave();
    return 0;
}

void rtai_emulated_timer(bool running)
{
    timer_runs = running;
}
