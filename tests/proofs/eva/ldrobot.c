/* One byte to the parser of LDROBOT's scanners, whatever it is and whatever came before: the state is any
 * that `is_state` allows, and must be such a state again, so that by induction no row of bytes leads out of
 * it. A longer piece is the same loop again.
 *
 * proves: drivers/scanner/ldrobot/ldrobot.c
 * options: -eva-precision 0 -eva-auto-loop-unroll 50 -eva-split-return full
 *  -eva-slevel-function shift:100,judge:100,read_on:100 */
#include "unknown.h"
#include "unknown_protocol.h"

#include "scanner/ldrobot/ldrobot.h"

/* 35 years of the sensor's clock. */
#define MOST_SENSOR_US (INT64_C(1) << 50)

static ale_ldrobot_t state;
static ale_rotary_packet_t packet;

static void unknown_state(uint32_t have)
{
    Frama_C_make_unknown((char *)&state, sizeof state);
    state.have = have;
    state.stamped = unknown(0, 1);
    state.stamp_ms = (uint16_t)unknown(0, 30000);
    state.sensor_us = unknown(0, MOST_SENSOR_US);
}

/* A packet of points is counted anew; another leaves the count as it was. */
static void take_any_byte(void)
{
    packet.count = (uint32_t)unknown(1, ALE_LDROBOT_POINTS);
    const uint8_t byte = (uint8_t)unknown(0, UINT8_MAX);
    const uint32_t used = protocol_of_family->parse(&state, &byte, 1, &packet);
    //@ assert used == 1;
    //@ assert state.have < ALE_LDROBOT_PACKET;
    //@ assert state.stamp_ms <= 30000 && 0 <= state.sensor_us <= MOST_SENSOR_US + 30000000;
    //@ assert 1 <= packet.count <= ALE_LDROBOT_POINTS;
}

void main(void)
{
    ale_scanner_config_t config = {0};
    ale_scanner_ldrobot.open(&config);
    ale_scanner_ldrobot.has_baud((int32_t)unknown(0, INT32_MAX));
    //@ loop unroll 47;
    for (uint32_t have = 0; have < ALE_LDROBOT_PACKET; have++) {
        unknown_state(have);
        take_any_byte();
    }
    unknown_state((uint32_t)unknown(0, ALE_LDROBOT_PACKET - 1));
    protocol_of_family->begin(&state);
    ale_rotary_facts_t facts;
    protocol_of_family->facts(&state, &facts);
}
