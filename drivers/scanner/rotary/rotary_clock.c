#include "scanner/rotary/rotary_clock.h"

#include "base/fixed.h"

enum { MILLION = 1000000 };

static void start(ale_rotary_clock_t *clock, int64_t sensor_us, int64_t host_us)
{
    clock->started = true;
    clock->sensor_us = clock->window_sensor_us = sensor_us;
    clock->host_us = clock->window_host_us = host_us;
}

static void measure_slope(ale_rotary_clock_t *clock)
{
    const int64_t sensor_us = clock->sensor_us - clock->window_sensor_us;
    if (sensor_us < ALE_ROTARY_CLOCK_WINDOW_US) {
        return;
    }
    /* more than the window is more than the slope may be, too */
    const int64_t longer_us = ale_clamp64(clock->host_us - clock->window_host_us - sensor_us,
                                          -ALE_ROTARY_CLOCK_WINDOW_US, ALE_ROTARY_CLOCK_WINDOW_US);
    const int64_t slope_ppm = ale_round_div(longer_us * MILLION, sensor_us);
    clock->slope_ppm =
        (int32_t)ale_clamp64(slope_ppm, -ALE_ROTARY_CLOCK_RISE_NEW_PPM, ALE_ROTARY_CLOCK_RISE_NEW_PPM);
    clock->sloped = true;
    clock->window_sensor_us = clock->sensor_us;
    clock->window_host_us = clock->host_us;
}

int64_t ale_rotary_clock_take(ale_rotary_clock_t *clock, int64_t sensor_us, int64_t arrival_us)
{
    const int64_t passed_us = sensor_us - clock->sensor_us;
    if (!clock->started || passed_us < 0 || passed_us > ALE_ROTARY_CLOCK_WINDOW_US) {
        clock->jumps += clock->started;
        start(clock, sensor_us, arrival_us);
        return arrival_us;
    }
    const int64_t due_us = clock->host_us + passed_us + ale_round_div(passed_us * clock->slope_ppm, MILLION);
    const int64_t late_us = arrival_us - due_us;
    if (late_us < -ALE_ROTARY_CLOCK_JUMP_US || late_us > ALE_ROTARY_CLOCK_JUMP_US) {
        clock->jumps++;
        start(clock, sensor_us, arrival_us);
        return arrival_us;
    }
    const int64_t rise_ppm = clock->sloped ? ALE_ROTARY_CLOCK_RISE_PPM : ALE_ROTARY_CLOCK_RISE_NEW_PPM;
    clock->sensor_us = sensor_us;
    clock->host_us = arrival_us - ale_max64(late_us - passed_us * rise_ppm / MILLION, 0);
    measure_slope(clock);
    return clock->host_us;
}
