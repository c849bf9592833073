#include "realtime/clock.h"

#include <time.h>

#include "realtime/rt.h"

#define US_PER_S 1000000

enum { READINGS = 5 };

int64_t ale_clock_scaled(int64_t us, int32_t scale_ppm)
{
    const int64_t seconds = us / US_PER_S;
    const int64_t rest = us % US_PER_S;
    return seconds * scale_ppm + rest * scale_ppm / US_PER_S;
}

int64_t ale_clock_now_us(const ale_clock_t *clock)
{
    return ale_clock_scaled(ale_rt_now_ns() / 1000, clock->scale_ppm);
}

static int64_t since_1970_us(void)
{
    struct timespec now;
    clock_gettime(CLOCK_REALTIME, &now);
    return (int64_t)now.tv_sec * US_PER_S + now.tv_nsec / 1000;
}

/* The two clocks are read one after the other: of some readings the one that was held up least counts. */
ale_clock_t ale_clock_start(int32_t scale_ppm)
{
    ale_clock_t clock = {.scale_ppm = scale_ppm};
    int64_t least_ns = INT64_MAX;
    for (int k = 0; k < READINGS; k++) {
        const int64_t before_ns = ale_rt_now_ns();
        const int64_t real_us = since_1970_us();
        const int64_t spent_ns = ale_rt_now_ns() - before_ns;
        if (spent_ns < least_ns) {
            least_ns = spent_ns;
            clock.offset_us =
                ale_clock_scaled(real_us, scale_ppm) - ale_clock_scaled(before_ns / 1000, scale_ppm);
        }
    }
    return clock;
}

int64_t ale_clock_to_utime(const ale_clock_t *clock, int64_t now_us)
{
    return now_us + clock->offset_us;
}

int64_t ale_clock_from_utime(const ale_clock_t *clock, int64_t utime)
{
    return utime - clock->offset_us;
}

int64_t ale_clock_real_ns(const ale_clock_t *clock, int64_t span_us)
{
    return span_us * 1000 * 1000 / (clock->scale_ppm / 1000);
}
