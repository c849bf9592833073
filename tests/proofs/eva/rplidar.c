/* One byte to the parser of SLAMTEC's scanners, and one answer to the conversation, from any state that
 * `unknown_state` allows; the state must be such a one again, so that by induction no row of bytes leads out
 * of it. A longer piece is the same loop again.
 *
 * proves: drivers/scanner/rplidar/rplidar_parse.c drivers/scanner/rplidar/rplidar.c
 * with: lib/base/fixed.c
 * options: -eva-precision 0 -eva-auto-loop-unroll 50 -eva-split-return full -eva-slevel 20 */
#include "unknown.h"
#include "unknown_protocol.h"

#include "scanner/rplidar/rplidar.h"

/* Of one stream: 127 days at 1 Mbit/s. */
#define MOST_STREAM_BYTES (UINT64_C(1) << 40)

enum { MOST_POINT_NS = 10000000 };

static ale_rplidar_t state;
static ale_rotary_packet_t packet;

static void unknown_state(void)
{
    Frama_C_make_unknown((char *)&state, sizeof state);
    state.parser.in_step = unknown(0, 1);
    state.parser.has_before = unknown(0, 1);
    state.parser.stream_bytes = unknown_unsigned(0, MOST_STREAM_BYTES);
    state.parser.point_ns = (int32_t)unknown(0, MOST_POINT_NS);
    state.parser.answer_bytes = (uint32_t)unknown(0, ALE_RPLIDAR_ANSWER);
    state.phase = (ale_rplidar_phase_t)unknown(0, ALE_RPLIDAR_PHASE_SCAN);
    state.begun = unknown(0, 1);
    state.known = unknown(0, 1);
    state.was_reset = unknown(0, 1);
    state.gives_up = unknown(0, 1);
}

/* The most bytes of a descriptor and its answer, of nodes, of a capsule are at hand, but one. */
static uint32_t most_at_hand(uint8_t stream)
{
    if (stream == 0) {
        return ALE_RPLIDAR_DESCRIPTOR + ALE_RPLIDAR_ANSWER - 1;
    }
    return stream == ALE_RPLIDAR_STANDARD ? ALE_RPLIDAR_NODE * ALE_RPLIDAR_NODES - 1
                                          : ALE_RPLIDAR_CAPSULE - 1;
}

/* A packet of points is counted anew; another leaves the count as it was. */
static void take_any_byte(void)
{
    packet.count = (uint32_t)unknown(1, ALE_PACKET_POINTS_MOST);
    const uint8_t byte = (uint8_t)unknown(0, UINT8_MAX);
    const uint32_t used = protocol_of_family->parse(&state, &byte, 1, &packet);
    //@ assert used == 1;
    //@ assert state.parser.stream == 0 ==> state.parser.have <= 70;
    //@ assert state.parser.stream == ALE_RPLIDAR_STANDARD ==> state.parser.have <= 39;
    //@ assert state.parser.have <= 83 && state.parser.answer_bytes <= ALE_RPLIDAR_ANSWER;
    //@ assert 1 <= packet.count <= ALE_PACKET_POINTS_MOST;
}

static void take_stream(uint8_t stream)
{
    unknown_state();
    state.parser.stream = stream;
    state.parser.have = (uint32_t)unknown(0, most_at_hand(stream));
    take_any_byte();
}

static void converse(void)
{
    unknown_state();
    protocol_of_family->next(&state, unknown(0, 1));
    //@ assert 0 <= state.parser.point_ns <= MOST_POINT_NS;
    //@ assert 0 <= state.phase <= ALE_RPLIDAR_PHASE_SCAN;
    unknown_state();
    protocol_of_family->begin(&state);
    protocol_of_family->stop(&state);
    unknown_state();
    ale_rotary_facts_t facts;
    protocol_of_family->facts(&state, &facts);
}

/* A recording: any bytes that were sent, or the answer that came. */
static void overhear(void)
{
    uint8_t sent[ALE_REQUEST_BYTES];
    Frama_C_make_unknown((char *)sent, sizeof sent);
    unknown_state();
    protocol_of_family->overhear(&state, sent, (uint32_t)unknown(0, sizeof sent));
    //@ assert 0 <= state.parser.point_ns <= MOST_POINT_NS;
}

void main(void)
{
    ale_scanner_config_t config = {0};
    ale_scanner_rplidar.open(&config);
    ale_scanner_rplidar.has_baud((int32_t)unknown(0, INT32_MAX));
    take_stream(0);
    take_stream(ALE_RPLIDAR_STANDARD);
    take_stream(ALE_RPLIDAR_EXPRESS);
    take_stream(ALE_RPLIDAR_DENSE);
    converse();
    overhear();
}
