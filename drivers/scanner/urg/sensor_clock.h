/* The sensor's 24-bit millisecond counter in host time.
 *
 * The counter wraps after 4 h 39 min; modular differences unwrap it. Every scan gives one sample
 *     arrival of the reply's first byte - latency - stamp  =  offset + delay on the way,   delay >= 0
 * where latency is the turn that the sensor finishes before it sends. Delays are one-sided, so the least
 * sample of a block is the best one, and the line under the blocks' least samples is the clock: its slope is
 * the rate of the sensor's quartz against the host's, its height the offset.
 *
 * The estimate steps down at once (a byte cannot arrive before it was sent) and up slowly, so that the
 * distance between two stamps is never falsified by more than ALE_CLOCK_SLEW_US plus what is evident.
 *
 * Integers only: the same samples give the same times. O(ALE_CLOCK_BLOCKS) a sample. No clock is read. */
#ifndef ALE_SCANNER_URG_SENSOR_CLOCK_H
#define ALE_SCANNER_URG_SENSOR_CLOCK_H

#include <stdbool.h>
#include <stdint.h>

enum {
    ALE_CLOCK_BLOCKS = 16,        /* window of the estimate */
    ALE_CLOCK_BLOCK_US = 4000000, /* length of a block, sensor time */
    ALE_CLOCK_RATE_BLOCKS = 6,    /* full blocks before a rate is believed */
    ALE_CLOCK_RATE_PPB = 500000,  /* quartz clocks differ by tens of ppm; what is more is a wrong estimate */
    ALE_CLOCK_SLEW_US = 100       /* most upward correction a sample */
};

typedef struct {
    int64_t time_us;   /* sensor time of the block's least sample */
    int64_t offset_us; /* that sample */
} ale_clock_block_t;

/* Fields are private, but for reading. */
typedef struct {
    bool started;
    int64_t sensor_us;  /* unwrapped time of the last stamp; 0 at the first */
    uint32_t stamp_ms;  /* last stamp as it came */
    int64_t arrival_us; /* of the last sample */
    int64_t latency_us;
    int64_t offset_us; /* host time of a stamp minus unwrapped sensor time, at the last stamp */
    int32_t rate_ppb;  /* by which the sensor's second is longer than the host's */
    uint64_t blocks_seen;
    int64_t block_begin_us;
    ale_clock_block_t block[ALE_CLOCK_BLOCKS]; /* ring; the newest is blocks_seen - 1 */
} ale_sensor_clock_t;

/* How a stamp follows the last one. */
typedef enum {
    ALE_STAMP_NEW,
    ALE_STAMP_REPEATED, /* the same again, or up to 2 s older while hardly any time has passed */
    ALE_STAMP_JUMPED    /* sensor and host disagree on what passed by over 500 ms: the counter was set */
} ale_stamp_kind_t;

/* Forgets everything: a new origin. latency_us: from the stamp to the first byte of the reply. */
void ale_sensor_clock_reset(ale_sensor_clock_t *clock, int64_t latency_us);

/* Says how a stamp (24 bits) that arrived at arrival_us follows the last one; changes nothing. The first
 * is NEW. */
ale_stamp_kind_t ale_sensor_clock_judge(const ale_sensor_clock_t *clock, uint32_t stamp_ms,
                                        int64_t arrival_us);

/* Takes a stamp and returns its host time. A stamp that jumped must be preceded by a reset. */
int64_t ale_sensor_clock_update(ale_sensor_clock_t *clock, uint32_t stamp_ms, int64_t arrival_us);

/* Host time of a stamp near the last one, by the present estimate; changes nothing. */
int64_t ale_sensor_clock_host_us(const ale_sensor_clock_t *clock, uint32_t stamp_ms);

/* Modular difference of two stamps, later - earlier, milliseconds, -2^23 .. 2^23-1. */
int32_t ale_stamp_difference_ms(uint32_t later_ms, uint32_t earlier_ms);

#endif
