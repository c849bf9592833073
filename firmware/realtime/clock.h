/* The robot's clock: microseconds of the monotonic clock, times a scale when a simulator runs faster.
 *
 *   inside:      now  = monotonic * scale
 *   in messages: utime = now + offset,   offset taken once at start so that utime = (time since 1970) * scale
 *
 * A simulator that follows the same rule agrees with it without any exchange. Setting the computer's date
 * while the robot runs does not disturb it; utime then goes on from the date of the start, and senders that
 * follow the new date are followed by their own clocks (lcm/sender_clock.h). Integers throughout; any thread.
 */
#ifndef ALE_FIRMWARE_REALTIME_CLOCK_H
#define ALE_FIRMWARE_REALTIME_CLOCK_H

#include <stdint.h>

#define ALE_CLOCK_REAL 1000000 /* scale_ppm of real time */

typedef struct {
    int32_t scale_ppm;
    int64_t offset_us;
} ale_clock_t;

/* scale_ppm 10^4 to 10^8. Reads both clocks. */
ale_clock_t ale_clock_start(int32_t scale_ppm);

int64_t ale_clock_now_us(const ale_clock_t *clock);

/* A moment of the clock inside to the one in messages, and back. */
int64_t ale_clock_to_utime(const ale_clock_t *clock, int64_t now_us);
int64_t ale_clock_from_utime(const ale_clock_t *clock, int64_t utime);

/* A span of the robot's clock in real nanoseconds. |span| up to a day. */
int64_t ale_clock_real_ns(const ale_clock_t *clock, int64_t span_us);

/* us * scale_ppm / 10^6, exact to one microsecond for any time until the year 2200. */
int64_t ale_clock_scaled(int64_t us, int32_t scale_ppm);

#endif
