/* A URG of which nothing is known but what its headers say of the fields. */
#ifndef ALE_PROOFS_EVA_UNKNOWN_URG_H
#define ALE_PROOFS_EVA_UNKNOWN_URG_H

#include "base/limits.h"
#include "scanner/urg/identity.h"
#include "scanner/urg/urg_stream.h"
#include "unknown.h"

/* The longest period of a turn; the longest that two stamps are apart; 17 years of the sensor's clock since
 * it was forgotten; what comes of these and of a stamp at the end of all time. */
#define MOST_PERIOD_US 60000000
#define MOST_TURN_US INT64_C(8388608000)
#define MOST_SENSOR_US (INT64_C(1) << 49)
#define MOST_SAMPLE_US (ALE_MAX_STAMP_US + MOST_SENSOR_US + (INT64_C(1) << 34))
#define MOST_OFFSET_US (ALE_MAX_STAMP_US + 2 * MOST_SENSOR_US)
#define MOST_STREAM_US (ALE_MAX_STAMP_US + (INT64_C(1) << 51))
#define MOST_GAP_US (MOST_STREAM_US + (INT64_C(1) << 40))

static inline ale_scip_request_t unknown_request(void)
{
    return (ale_scip_request_t){
        .first_step = (uint16_t)unknown(0, 9999),
        .last_step = (uint16_t)unknown(0, 9999),
        .cluster = (uint8_t)unknown(0, 99),
        .skip = (uint8_t)unknown(0, 9),
        .scans = (uint8_t)unknown(0, 99),
        .characters = (uint8_t)unknown(2, 3),
        .stream = unknown(0, 1),
        .protocol = (uint8_t)unknown(1, 2),
    };
}

/* As ale_urg_geometry_valid allows. */
static inline ale_urg_geometry_t unknown_geometry(void)
{
    return (ale_urg_geometry_t){
        .range_min_mm = (int32_t)unknown(0, 999999),
        .range_max_mm = (int32_t)unknown(0, 999999),
        .steps_per_turn = (int32_t)unknown(200, 9999),
        .first_step = (int32_t)unknown(0, 9999),
        .last_step = (int32_t)unknown(0, 9999),
        .front_step = (int32_t)unknown(0, 9999),
        .rpm = (int32_t)unknown(1, 60000),
    };
}

/* As ale_urg_played_parse leaves it, and as the time since then has it, or none. */
static inline ale_urg_played_t unknown_played(void)
{
    if (unknown(0, 1)) {
        return (ale_urg_played_t){0};
    }
    return (ale_urg_played_t){
        .silence_ms = (int32_t)unknown(1, 10000000),
        .zero_us = unknown(0, 1) ? ALE_URG_PLAYED_ZERO_UNKNOWN : unknown(-MOST_STREAM_US, MOST_STREAM_US),
        .tick_us = (int32_t)unknown(1, 1000),
        .stamp_step = (int32_t)unknown(-20000, 20000),
        .step_ns = (int32_t)unknown(0, 10000000),
        .origin_bam = (int32_t)unknown(INT32_MIN, INT32_MAX),
        .step_bam = (int32_t)unknown(INT32_MIN, INT32_MAX),
        .blind_before = (int32_t)unknown(0, 20000),
        .blind_from = (int32_t)unknown(0, 20000),
    };
}

/* What grows from frame to frame is bounded by time: the sensor's clock by 2.3 hours a frame, and the
 * estimate falls with the drift of the clocks meanwhile. */
static inline void unknown_clock(ale_sensor_clock_t *clock)
{
    Frama_C_make_unknown((char *)clock, sizeof *clock);
    clock->started = unknown(0, 1);
    clock->sensor_us = unknown(-MOST_SENSOR_US, MOST_SENSOR_US);
    clock->stamp_ms = (uint32_t)unknown(0, (1 << 24) - 1);
    clock->arrival_us = unknown(-ALE_MAX_STAMP_US, ALE_MAX_STAMP_US);
    clock->latency_us = unknown(0, MOST_PERIOD_US);
    clock->offset_us = unknown(-MOST_OFFSET_US, MOST_OFFSET_US);
    clock->rate_ppb = (int32_t)unknown(-ALE_CLOCK_RATE_PPB, ALE_CLOCK_RATE_PPB);
    clock->blocks_seen = unknown_unsigned(0, INT64_MAX);
    clock->block_begin_us = unknown(-MOST_SENSOR_US, MOST_SENSOR_US);
    //@ loop unroll 16;
    for (uint32_t k = 0; k < ALE_CLOCK_BLOCKS; k++) {
        clock->block[k].time_us = unknown(-MOST_SENSOR_US, MOST_SENSOR_US);
        clock->block[k].offset_us = unknown(-MOST_SAMPLE_US, MOST_SAMPLE_US);
    }
}

/* Nothing waits: what a frame yielded was fetched. */
static inline void unknown_stream(ale_urg_stream_t *stream)
{
    Frama_C_make_unknown((char *)stream, sizeof *stream);
    stream->reversed = unknown(0, 1);
    stream->geometry = unknown_geometry();
    stream->played = unknown_played();
    stream->request = unknown_request();
    unknown_clock(&stream->clock);
    stream->period_us = (int32_t)unknown(1, MOST_PERIOD_US);
    stream->continuous = unknown(0, 1);
    stream->regular = (int32_t)unknown(-20, 3);
    stream->last_stamp_us = unknown(-MOST_STREAM_US, MOST_STREAM_US);
    stream->gaps_owed = 0;
    stream->gap_us = unknown(-MOST_GAP_US, MOST_GAP_US);
    stream->turn_us = unknown(-MOST_TURN_US, MOST_TURN_US);
    stream->loss_waits = false;
    stream->loss_stamp_us = unknown(-MOST_STREAM_US, MOST_STREAM_US);
    stream->scan_waits = false;
    stream->losses_until_us = unknown(INT64_MIN, MOST_STREAM_US);
}

#endif
