#include "clock.h"

#include <time.h>

#include "realtime/rt.h"

#define US_PER_S 1000000

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

ale_clock_t ale_clock_start(int32_t scale_ppm)
{
    ale_clock_t clock = {.scale_ppm = scale_ppm};
    struct timespec since_1970;
    clock_gettime(CLOCK_REALTIME, &since_1970);
    const int64_t real_us = (int64_t)since_1970.tv_sec * US_PER_S + since_1970.tv_nsec / 1000;
    clock.offset_us = ale_clock_scaled(real_us, scale_ppm) - ale_clock_now_us(&clock);
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
