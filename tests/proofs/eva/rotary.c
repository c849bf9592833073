/* One packet of any points, of any stamps, to turns and to the clock of a rotary scanner, in any state that
 * `unknown_turns` and `unknown_clock` allow; the state must be such a one again. What base/turn.h makes of
 * the points is not proved here: it may answer anything.
 *
 * proves: drivers/scanner/rotary/turns.c drivers/scanner/rotary/rotary_clock.c
 *  drivers/scanner/rotary/diagnosis.c
 * with: lib/base/fixed.c
 * options: -eva-precision 0 -eva-split-return full -eva-slevel-function ale_turns_next:40,take_packet:80 */
#include "unknown.h"
#include "unknown_scan.h"

#include <string.h>

#include "scanner/rotary/diagnosis.h"
#include "scanner/rotary/rotary_clock.h"
#include "scanner/rotary/turns.h"

/* 17 years since the sensor began, and since the clock of the host did. */
#define MOST_US (INT64_C(1) << 49)

void ale_turn_begin(ale_turn_t *turn)
{
    turn->count = 0;
}

void ale_turn_add(ale_turn_t *turn, uint32_t bearing_bam, int32_t range_um, ale_beam_flag_t flag)
{
    (void)bearing_bam;
    (void)range_um;
    (void)flag;
    turn->count++;
}

ale_turn_status_t ale_turn_to_scan(ale_turn_t *turn, ale_scan_t *scan)
{
    (void)turn;
    unknown_scan(scan);
    return (ale_turn_status_t)unknown(ALE_TURN_STILL, ALE_TURN_FINE);
}

static ale_turns_t turns;
static ale_rotary_packet_t packet;
static ale_rotary_clock_t host_clock;
static ale_scan_t scan;

/* A loss is dated when it is found, and found anew by each packet at most: its time is any. */
static void unknown_turns(void)
{
    Frama_C_make_unknown((char *)&turns, sizeof turns);
    turns.clockwise = unknown(0, 1);
    turns.reversed = unknown(0, 1);
    turns.whole = unknown(0, 1);
    turns.goes_on = unknown(0, 1);
    turns.scan_waits = false;
    turns.losses_owed = 0;
    turns.loss_us = unknown(-2 * MOST_US, 2 * MOST_US);
    turns.first_us = unknown(-2 * MOST_US, 2 * MOST_US);
    turns.begun_us = unknown(-2 * MOST_US, 2 * MOST_US);
    turns.last_us = unknown(-2 * MOST_US, 2 * MOST_US);
    turns.sensor_us = unknown(0, MOST_US);
    turns.sum_us = unknown(0, INT64_C(1) << 60);
    turns.sum_bam = unknown(0, INT64_C(1) << 60);
    turns.point_ns = (int32_t)unknown(0, INT32_MAX);
}

static void take_packet(void)
{
    unknown_turns();
    Frama_C_make_unknown((char *)&packet, sizeof packet);
    packet.count = (uint32_t)unknown(1, ALE_PACKET_POINTS_MOST);
    packet.sensor_us = unknown(0, MOST_US);
    ale_turns_take(&turns, &packet, unknown(-MOST_US, MOST_US));
    //@ assert turns.losses_owed <= 30;
    //@ assert -2 * MOST_US <= turns.first_us <= 2 * MOST_US && -2 * MOST_US <= turns.begun_us <= 2 * MOST_US;
    //@ assert -2 * MOST_US <= turns.last_us <= 2 * MOST_US && 0 <= turns.sensor_us <= MOST_US;
    //@ assert 0 <= turns.sum_us <= (1 << 60) && 0 <= turns.sum_bam <= (1 << 60) && 0 <= turns.point_ns;
    //@ loop unroll 32;
    while (ale_turns_next(&turns, &scan) != ALE_SCANNER_IDLE) {
    }
    //@ assert turns.losses_owed == 0 && turns.scan_waits == 0;
    ale_turns_speed_mdeg_s(&turns);
}

static void take_time(void)
{
    Frama_C_make_unknown((char *)&host_clock, sizeof host_clock);
    host_clock.started = unknown(0, 1);
    host_clock.sloped = unknown(0, 1);
    host_clock.sensor_us = unknown(0, MOST_US);
    host_clock.host_us = unknown(-MOST_US, MOST_US);
    host_clock.slope_ppm = (int32_t)unknown(-30000, 30000);
    host_clock.window_sensor_us = unknown(0, MOST_US);
    host_clock.window_host_us = unknown(-MOST_US, MOST_US);
    const int64_t us = ale_rotary_clock_take(&host_clock, unknown(0, MOST_US), unknown(0, MOST_US));
    //@ assert -MOST_US <= us <= MOST_US && -30000 <= host_clock.slope_ppm <= 30000;
    //@ assert 0 <= host_clock.sensor_us <= MOST_US && -MOST_US <= host_clock.host_us <= MOST_US;
    //@ assert 0 <= host_clock.window_sensor_us <= MOST_US;
    //@ assert -MOST_US <= host_clock.window_host_us <= MOST_US;
}

static void diagnose(void)
{
    ale_line_seen_t seen;
    char words[ALE_DIAGNOSIS_WORDS];
    const ale_rotary_protocol_t protocol = {.name = "ldrobot", .turns_mdeg_s = (int32_t)unknown(0, 36000000)};
    Frama_C_make_unknown((char *)&seen, sizeof seen);
    ale_diagnosis_no_scan(&protocol, &seen, (int32_t)unknown(0, INT32_MAX), words);
    ale_diagnosis_slow(&protocol, (int32_t)unknown(INT32_MIN, INT32_MAX), unknown(0, 1), words);
}

void main(void)
{
    ale_turns_init(&turns, unknown(0, 1), unknown(0, 1));
    ale_turns_range(&turns, (int32_t)unknown(0, ALE_MAX_RANGE_UM), (int32_t)unknown(0, ALE_MAX_RANGE_UM));
    ale_turns_begin(&turns);
    take_packet();
    take_time();
    diagnose();
}
