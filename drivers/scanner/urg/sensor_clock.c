#include "scanner/urg/sensor_clock.h"

#include <string.h>

#include "base/fixed.h"

enum {
    STAMP_BITS = 24,
    STAMP_RANGE = 1 << STAMP_BITS,
    JUMP_US = 500000,
    LATE_US = 2000000,
    OLD_REPLY_MS = 2000,
    PPB = 1000000000,
    /* Of a window of the estimate, so that 16 blocks of it squared fit 64 bits: stamps that follow one
     * another are 2.3 hours apart at most, and quartz clocks 67 seconds after 37 hours of it. */
    MOST_WINDOW_MS = 1 << 27,
    MOST_DRIFT_US = 1 << 26
};

int32_t ale_stamp_difference_ms(uint32_t later_ms, uint32_t earlier_ms)
{
    const int32_t modular = (int32_t)((later_ms - earlier_ms) & (STAMP_RANGE - 1));
    return modular < STAMP_RANGE / 2 ? modular : modular - STAMP_RANGE;
}

void ale_sensor_clock_reset(ale_sensor_clock_t *clock, int64_t latency_us)
{
    memset(clock, 0, sizeof *clock);
    clock->latency_us = latency_us;
}

ale_stamp_kind_t ale_sensor_clock_judge(const ale_sensor_clock_t *clock, uint32_t stamp_ms,
                                        int64_t arrival_us)
{
    if (!clock->started) {
        return ALE_STAMP_NEW;
    }
    const int32_t sensor_ms = ale_stamp_difference_ms(stamp_ms, clock->stamp_ms);
    const int64_t host_us = arrival_us - clock->arrival_us;
    if (sensor_ms == 0 || (sensor_ms < 0 && sensor_ms > -OLD_REPLY_MS && host_us < JUMP_US)) {
        return ALE_STAMP_REPEATED;
    }
    const int64_t late_us = host_us - (int64_t)sensor_ms * 1000;
    /* A late arrival (a busy host), and one in time after it, says nothing against a stamp that continues the
     * series. */
    const bool continues = sensor_ms > 0 && sensor_ms < JUMP_US / 1000 && ale_abs64(late_us) < LATE_US;
    return continues || ale_abs64(late_us) < JUMP_US ? ALE_STAMP_NEW : ALE_STAMP_JUMPED;
}

static ale_clock_block_t *block_at(ale_sensor_clock_t *clock, uint64_t number)
{
    return &clock->block[number % ALE_CLOCK_BLOCKS];
}

static int64_t blocks_held(const ale_sensor_clock_t *clock)
{
    return clock->blocks_seen < ALE_CLOCK_BLOCKS ? (int64_t)clock->blocks_seen : ALE_CLOCK_BLOCKS;
}

/* The oldest of those held is 0. */
static ale_clock_block_t *held_block(ale_sensor_clock_t *clock, int64_t rank)
{
    return block_at(clock, clock->blocks_seen - (uint64_t)(blocks_held(clock) - rank));
}

static void add_sample(ale_sensor_clock_t *clock, int64_t sample_us)
{
    const bool full = clock->sensor_us - clock->block_begin_us >= ALE_CLOCK_BLOCK_US;
    if (clock->blocks_seen == 0 || full) {
        clock->block_begin_us = clock->sensor_us;
        *block_at(clock, clock->blocks_seen++) = (ale_clock_block_t){clock->sensor_us, sample_us};
        return;
    }
    ale_clock_block_t *block = block_at(clock, clock->blocks_seen - 1);
    if (sample_us <= block->offset_us) {
        *block = (ale_clock_block_t){clock->sensor_us, sample_us};
    }
}

/* Slope of the full blocks' least samples by least squares; the block that has just begun holds one sample
 * that nothing speaks for. What is farther off than clocks can be, as in a recording whose time runs
 * backwards, counts as that far off. */
static void estimate_rate(ale_sensor_clock_t *clock)
{
    const int64_t n = blocks_held(clock) - 1;
    if (n < ALE_CLOCK_RATE_BLOCKS) {
        return;
    }
    const ale_clock_block_t origin = *held_block(clock, 0);
    int64_t st = 0;
    int64_t so = 0;
    int64_t stt = 0;
    int64_t sto = 0;
    for (int64_t k = 0; k < n; k++) {
        const ale_clock_block_t *b = held_block(clock, k);
        const int64_t t_ms =
            ale_clamp64((b->time_us - origin.time_us) / 1000, -MOST_WINDOW_MS, MOST_WINDOW_MS);
        const int64_t o_us = ale_clamp64(b->offset_us - origin.offset_us, -MOST_DRIFT_US, MOST_DRIFT_US);
        st += t_ms;
        so += o_us;
        stt += t_ms * t_ms;
        sto += t_ms * o_us;
    }
    const int64_t scatter = n * stt - st * st;
    if (scatter > 0) {
        const int64_t slope_ppb = ale_mul_div(n * sto - st * so, PPB / 1000, scatter);
        clock->rate_ppb = (int32_t)ale_clamp64(slope_ppb, -ALE_CLOCK_RATE_PPB, ALE_CLOCK_RATE_PPB);
    }
}

/* Height of the line with the estimated slope that touches the samples from below, at the last stamp. */
static int64_t lower_line(ale_sensor_clock_t *clock)
{
    int64_t least = INT64_MAX;
    for (int64_t k = 0; k < blocks_held(clock); k++) {
        const ale_clock_block_t *b = held_block(clock, k);
        const int64_t drift_us = ale_mul_div(clock->sensor_us - b->time_us, clock->rate_ppb, PPB);
        least = ale_min64(least, b->offset_us + drift_us);
    }
    return least;
}

int64_t ale_sensor_clock_update(ale_sensor_clock_t *clock, uint32_t stamp_ms, int64_t arrival_us)
{
    const bool first = !clock->started;
    const int64_t passed_us = first ? 0 : (int64_t)ale_stamp_difference_ms(stamp_ms, clock->stamp_ms) * 1000;
    clock->started = true;
    clock->sensor_us += passed_us;
    clock->stamp_ms = stamp_ms;
    clock->arrival_us = arrival_us;

    const uint64_t blocks_before = clock->blocks_seen;
    add_sample(clock, arrival_us - clock->latency_us - clock->sensor_us);
    if (clock->blocks_seen != blocks_before) {
        estimate_rate(clock);
    }
    const int64_t target_us = lower_line(clock);
    const int64_t expected_us = clock->offset_us + ale_mul_div(passed_us, clock->rate_ppb, PPB);
    clock->offset_us = first ? target_us : ale_min64(target_us, expected_us + ALE_CLOCK_SLEW_US);
    return clock->sensor_us + clock->offset_us;
}

int64_t ale_sensor_clock_host_us(const ale_sensor_clock_t *clock, uint32_t stamp_ms)
{
    const int64_t passed_us = (int64_t)ale_stamp_difference_ms(stamp_ms, clock->stamp_ms) * 1000;
    return clock->sensor_us + passed_us + clock->offset_us;
}
