#include "scanner/rotary/turns.h"

#include <string.h>

#include "base/fixed.h"

enum {
    SMOOTHING = 16,     /* packets over which a time is averaged */
    SPEED_US = 2000000, /* over which the speed is, at most */
    MOST_LOSSES = 30    /* more turns without a point are an interruption */
};

/* A head that never passes straight ahead ends no sum. */
static const int64_t MOST_SUM = INT64_C(1) << 60;

static const uint32_t half_turn = UINT32_C(1) << 31;

void ale_turns_init(ale_turns_t *turns, bool clockwise, bool reversed)
{
    memset(turns, 0, sizeof *turns);
    turns->clockwise = clockwise;
    turns->reversed = reversed;
}

void ale_turns_range(ale_turns_t *turns, int32_t range_min_um, int32_t range_max_um)
{
    turns->range_min_um = range_min_um;
    turns->range_max_um = range_max_um;
}

static void open_turn(ale_turns_t *turns, int64_t begun_us, bool whole)
{
    ale_turn_begin(&turns->turn);
    turns->swept = 0;
    turns->begun_us = begun_us;
    turns->whole = whole;
}

void ale_turns_begin(ale_turns_t *turns)
{
    turns->goes_on = false;
    turns->sum_us = 0;
    turns->sum_bam = 0;
    open_turn(turns, 0, false);
}

static int32_t follow(int32_t mean, int64_t measured)
{
    const int64_t next = mean == 0 ? measured : mean + ale_round_div(measured - mean, SMOOTHING);
    return (int32_t)ale_clamp64(next, 0, INT32_MAX);
}

static uint32_t phase_of(const ale_turns_t *turns, const ale_rotary_point_t *point)
{
    return turns->clockwise ? 0 - point->bearing_bam : point->bearing_bam;
}

/* A packet behind another without a gap tells the time from point to point, and the speed. */
static void follow_pace(ale_turns_t *turns, const ale_rotary_packet_t *packet)
{
    const int64_t passed_us = packet->sensor_us - turns->sensor_us;
    const int64_t measured_ns = ale_round_div(passed_us * 1000, packet->count);
    const bool gap = turns->point_ns > 0 && 2 * measured_ns > 3 * (int64_t)turns->point_ns;
    if (turns->goes_on && passed_us > 0 && !gap) {
        const uint32_t turned_bam = phase_of(turns, &packet->points[packet->count - 1]) - turns->phase;
        turns->point_ns = follow(turns->point_ns, measured_ns);
        const bool turns_on = turned_bam > 0 && turned_bam < half_turn;
        turns->sum_us = ale_min64(turns->sum_us + (turns_on ? passed_us : 0), MOST_SUM);
        turns->sum_bam = ale_min64(turns->sum_bam + (turns_on ? turned_bam : 0), MOST_SUM);
    }
    turns->sensor_us = packet->sensor_us;
}

/* Over some turns: stamps may count in whole milliseconds. */
static void follow_speed(ale_turns_t *turns)
{
    if (turns->sum_bam > half_turn) {
        turns->period_us = (int32_t)ale_mul_div(turns->sum_us, INT64_C(1) << 32, turns->sum_bam);
    }
    if (turns->sum_us > SPEED_US) {
        turns->sum_us /= 2;
        turns->sum_bam /= 2;
    }
}

/* Half of it was seen; of a turn without gaps nearly all. */
static bool is_usable(const ale_turns_t *turns, int64_t turn_us)
{
    const int64_t seen_us = (int64_t)turns->turn.count * turns->point_ns / 1000;
    return 2 * seen_us >= turn_us;
}

/* The points of the turn under way as the scan; false: they make none. */
static bool fill(ale_turns_t *turns)
{
    turns->scan.range_min_um = turns->range_min_um;
    turns->scan.range_max_um = turns->range_max_um;
    turns->turn.first_us = turns->first_us;
    turns->turn.last_us = turns->last_us;
    return ale_turn_to_scan(&turns->turn, &turns->scan) == ALE_TURN_FINE;
}

/* The turns that passed between the beginning of the one under way and now. */
static int64_t turns_passed(const ale_turns_t *turns, int64_t now_us)
{
    const int64_t passed_us = now_us - turns->begun_us;
    return turns->period_us > 0 ? ale_max64(1, ale_round_div(passed_us, turns->period_us)) : 1;
}

/* When the head passed straight ahead, of which the point at now_us is the first one behind. */
static int64_t passing_us(const ale_turns_t *turns, uint32_t phase, int64_t now_us)
{
    return now_us - (int64_t)(((uint64_t)phase * (uint32_t)turns->period_us) >> 32);
}

/* The head passes straight ahead at now_us: the turn is over. */
static void close_turn(ale_turns_t *turns, int64_t now_us)
{
    const int64_t passed = turns_passed(turns, now_us);
    const int64_t turn_us = (now_us - turns->begun_us) / passed;
    if (turns->whole && passed <= MOST_LOSSES) {
        const bool usable = is_usable(turns, turn_us) && fill(turns);
        turns->losses_owed = (uint32_t)(passed - (usable ? 1 : 0));
        turns->loss_us = turns->begun_us + turn_us / 2 + (usable ? turn_us : 0);
        turns->scan_waits = usable;
    }
    follow_speed(turns);
    open_turn(turns, now_us, true);
}

static void add(ale_turns_t *turns, const ale_rotary_point_t *point, int64_t at_us)
{
    const uint32_t bearing_bam = turns->reversed ? 0 - point->bearing_bam : point->bearing_bam;
    turns->first_us = turns->turn.count == 0 ? at_us : turns->first_us;
    turns->last_us = at_us;
    ale_turn_add(&turns->turn, bearing_bam, point->range_um,
                 point->range_um > 0 ? ALE_BEAM_VALID : ALE_BEAM_NO_RETURN);
}

/* Bearings jitter, so that the head seems to go back by a little: straight ahead is passed once, half a turn
 * after the last time at least. Behind a long gap the time tells. */
static bool passes_ahead(const ale_turns_t *turns, uint32_t phase, int64_t at_us)
{
    if (turns->period_us > 0 && at_us - turns->last_us > turns->period_us / 2) {
        return turns->goes_on && passing_us(turns, phase, at_us) > turns->last_us;
    }
    const bool forward = phase - turns->phase < half_turn;
    return turns->goes_on && forward && phase < turns->phase && (turns->swept >= half_turn || !turns->whole);
}

static void take_point(ale_turns_t *turns, const ale_rotary_point_t *point, int64_t at_us)
{
    const uint32_t phase = phase_of(turns, point);
    if (passes_ahead(turns, phase, at_us)) {
        close_turn(turns, passing_us(turns, phase, at_us));
    }
    const uint32_t ahead = phase - turns->phase;
    if (turns->goes_on && ahead < half_turn) {
        turns->swept = (uint32_t)ale_min64((int64_t)turns->swept + ahead, UINT32_MAX);
    }
    turns->phase = phase;
    turns->goes_on = true;
    add(turns, point, at_us);
}

void ale_turns_take(ale_turns_t *turns, const ale_rotary_packet_t *packet, int64_t last_us)
{
    follow_pace(turns, packet);
    for (uint32_t k = 0; k < packet->count; k++) {
        const int64_t before_us = ale_round_div(((int64_t)packet->count - 1 - k) * turns->point_ns, 1000);
        take_point(turns, &packet->points[k], last_us - before_us);
    }
    turns->last_us = last_us;
}

static ale_scanner_event_t yield_loss(ale_turns_t *turns, ale_scan_t *scan)
{
    memset(scan, 0, sizeof *scan);
    scan->stamp_us = turns->loss_us;
    turns->losses_owed--;
    turns->loss_us += turns->period_us;
    return ALE_SCANNER_SCAN_LOST;
}

ale_scanner_event_t ale_turns_next(ale_turns_t *turns, ale_scan_t *scan)
{
    if (turns->scan_waits) {
        turns->scan_waits = false;
        *scan = turns->scan;
        return ALE_SCANNER_SCAN;
    }
    return turns->losses_owed > 0 ? yield_loss(turns, scan) : ALE_SCANNER_IDLE;
}

int32_t ale_turns_speed_mdeg_s(const ale_turns_t *turns)
{
    return turns->period_us > 0 ? (int32_t)(INT64_C(360000) * 1000000 / turns->period_us) : 0;
}
