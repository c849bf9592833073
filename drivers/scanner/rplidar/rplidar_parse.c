#include "scanner/rplidar/rplidar_parse.h"

#include <string.h>

#include "base/fixed.h"
#include "file/little_endian.h"

enum {
    SYNC_1 = 0xa5,
    SYNC_2 = 0x5a,
    CAPSULE_SYNC_1 = 0xa,
    CAPSULE_SYNC_2 = 0x5,
    AT_ANGLE = 2,
    AT_CABINS = 4,
    CABIN_BYTES = 5,
    NODES_BYTES = ALE_RPLIDAR_NODE * ALE_RPLIDAR_NODES,
    UM_A_QUARTER_MM = 250,
    WIDEST_Q6 = 90 << 6, /* a capsule sweeps at most so much */
    DEFAULT_POINT_NS = 500000
};

static const uint32_t turn_q16 = UINT32_C(360) << 16;

void ale_rplidar_parser_begin(ale_rplidar_parser_t *p)
{
    p->garbage += p->have;
    p->have = 0;
    p->stream = 0;
    p->in_step = false;
    p->has_before = false;
    p->stream_bytes = 0;
}

/* Of a descriptor: what is there of it may be one. */
static bool begins_descriptor(const ale_rplidar_parser_t *p)
{
    return p->bytes[0] == SYNC_1 && (p->have < 2 || p->bytes[1] == SYNC_2);
}

/* Of every node that is there, or begins to be: start and its inverse differ, and the angle's check bit is
 * set. */
static bool begins_nodes(const ale_rplidar_parser_t *p)
{
    for (uint32_t k = 0; k < p->have; k += ALE_RPLIDAR_NODE) {
        const bool start_differs = ((p->bytes[k] ^ p->bytes[k] >> 1) & 1) != 0;
        const bool checked = k + 1 >= p->have || (p->bytes[k + 1] & 1) != 0;
        if (!start_differs || !checked) {
            return false;
        }
    }
    return true;
}

static bool begins_capsule(const ale_rplidar_parser_t *p)
{
    return p->bytes[0] >> 4 == CAPSULE_SYNC_1 && (p->have < 2 || p->bytes[1] >> 4 == CAPSULE_SYNC_2);
}

static bool begins(const ale_rplidar_parser_t *p)
{
    switch (p->stream) {
    case 0:
        return begins_descriptor(p);
    case ALE_RPLIDAR_STANDARD:
        return begins_nodes(p);
    default:
        return begins_capsule(p);
    }
}

/* Lets go of the first byte, and of those behind it that begin nothing. */
static void shift(ale_rplidar_parser_t *p)
{
    do {
        p->garbage++;
        p->have--;
        memmove(p->bytes, p->bytes + 1, p->have);
    } while (p->have > 0 && !begins(p));
}

static void lose_step(ale_rplidar_parser_t *p, ale_rotary_packet_t *packet)
{
    packet->kind = p->in_step ? ALE_PACKET_DAMAGED : ALE_PACKET_NONE;
    p->in_step = false;
    p->has_before = false;
    shift(p);
}

static uint32_t points_a_piece(const ale_rplidar_parser_t *p)
{
    switch (p->stream) {
    case ALE_RPLIDAR_STANDARD:
        return ALE_RPLIDAR_NODES;
    case ALE_RPLIDAR_EXPRESS:
        return ALE_RPLIDAR_CAPSULE_POINTS;
    default:
        return ALE_RPLIDAR_DENSE_POINTS;
    }
}

static uint32_t piece_bytes(const ale_rplidar_parser_t *p)
{
    return p->stream == ALE_RPLIDAR_STANDARD ? NODES_BYTES : ALE_RPLIDAR_CAPSULE;
}

/* Points come at an even pace, and so do their bytes. */
static int64_t time_us(const ale_rplidar_parser_t *p, uint64_t bytes)
{
    const int64_t point_ns = p->point_ns > 0 ? p->point_ns : DEFAULT_POINT_NS;
    const int64_t piece_ns = point_ns * (int64_t)points_a_piece(p);
    const uint64_t pieces = bytes / piece_bytes(p);
    const int64_t rest = (int64_t)(bytes % piece_bytes(p));
    return ((int64_t)pieces * piece_ns + rest * piece_ns / (int64_t)piece_bytes(p)) / 1000;
}

static void give(ale_rplidar_parser_t *p, ale_rotary_packet_t *packet, uint32_t count, uint32_t behind_bytes)
{
    const int64_t now_us = time_us(p, p->stream_bytes);
    packet->kind = ALE_PACKET_POINTS;
    packet->count = count;
    packet->sensor_us = time_us(p, (uint64_t)ale_max64((int64_t)p->stream_bytes - behind_bytes, 0));
    packet->behind_us = (int32_t)(now_us - packet->sensor_us);
    packet->line_bytes = p->stream == ALE_RPLIDAR_STANDARD ? ALE_RPLIDAR_NODE : ALE_RPLIDAR_CAPSULE;
    packet->speed_mdeg_s = -1;
}

static uint32_t bearing_of(uint32_t clockwise_q16)
{
    return (uint32_t)(0 - ((uint64_t)(clockwise_q16 % turn_q16) << 32) / turn_q16);
}

static void take_nodes(ale_rplidar_parser_t *p, ale_rotary_packet_t *packet)
{
    for (uint32_t k = 0; k < ALE_RPLIDAR_NODES; k++) {
        const uint8_t *node = p->bytes + (size_t)k * ALE_RPLIDAR_NODE;
        const uint32_t angle_q6 = (uint32_t)ale_get_u16(node + 1) >> 1;
        const int32_t quarters = ale_get_u16(node + 3);
        packet->points[k] = (ale_rotary_point_t){bearing_of(angle_q6 << 10), quarters * UM_A_QUARTER_MM};
    }
    p->have = 0;
    p->in_step = true;
    give(p, packet, ALE_RPLIDAR_NODES, 0);
}

static uint32_t start_q6(const uint8_t *capsule)
{
    return ale_get_u16(capsule + AT_ANGLE) & 0x7fffU;
}

/* Two points share a cabin: their distances with two bits of an angle each, and the other four bits of both.
 */
static void take_cabins(const uint8_t *capsule, uint32_t sweep_q6, ale_rotary_packet_t *packet)
{
    for (uint32_t k = 0; k < ALE_RPLIDAR_CAPSULE_POINTS; k++) {
        const uint8_t *cabin = capsule + AT_CABINS + (size_t)(k / 2) * CABIN_BYTES;
        const uint32_t word = ale_get_u16(cabin + (size_t)(k % 2) * 2);
        const uint32_t low = k % 2 == 0 ? cabin[4] & 0xfU : (uint32_t)cabin[4] >> 4;
        const uint32_t less_q3 = low | (word & 3U) << 4;
        const uint32_t even_q16 = (start_q6(capsule) << 10) + (sweep_q6 << 5) * k;
        packet->points[k] = (ale_rotary_point_t){bearing_of(even_q16 + turn_q16 - (less_q3 << 13)),
                                                 (int32_t)(word & 0xfffcU) * UM_A_QUARTER_MM};
    }
}

static void take_dense(const uint8_t *capsule, uint32_t sweep_q6, ale_rotary_packet_t *packet)
{
    for (uint32_t k = 0; k < ALE_RPLIDAR_DENSE_POINTS; k++) {
        const uint32_t even_q16 = (start_q6(capsule) << 10) + (sweep_q6 << 10) * k / ALE_RPLIDAR_DENSE_POINTS;
        packet->points[k] = (ale_rotary_point_t){bearing_of(even_q16),
                                                 ale_get_u16(capsule + AT_CABINS + (size_t)2 * k) * 1000};
    }
}

/* The points of the capsule before, which the one at hand ends. */
static void take_before(ale_rplidar_parser_t *p, ale_rotary_packet_t *packet)
{
    const uint32_t turn_q6 = turn_q16 >> 10;
    const uint32_t sweep_q6 = (start_q6(p->bytes) + turn_q6 - start_q6(p->before)) % turn_q6;
    if (sweep_q6 > WIDEST_Q6) {
        packet->kind = ALE_PACKET_DAMAGED;
        return;
    }
    if (p->stream == ALE_RPLIDAR_EXPRESS) {
        take_cabins(p->before, sweep_q6, packet);
    } else {
        take_dense(p->before, sweep_q6, packet);
    }
    give(p, packet, points_a_piece(p), ALE_RPLIDAR_CAPSULE);
}

static bool is_capsule_whole(const ale_rplidar_parser_t *p)
{
    uint8_t sum = 0;
    for (uint32_t k = AT_ANGLE; k < ALE_RPLIDAR_CAPSULE; k++) {
        sum ^= p->bytes[k];
    }
    return sum == ((p->bytes[0] & 0xf) | (p->bytes[1] & 0xf) << 4) && start_q6(p->bytes) < turn_q16 >> 10;
}

static void take_capsule(ale_rplidar_parser_t *p, ale_rotary_packet_t *packet)
{
    if (!is_capsule_whole(p)) {
        lose_step(p, packet);
        return;
    }
    const bool anew = (p->bytes[AT_ANGLE + 1] & 0x80) != 0;
    if (p->has_before && !anew) {
        take_before(p, packet);
    }
    memcpy(p->before, p->bytes, sizeof p->before);
    p->has_before = true;
    p->in_step = true;
    p->have = 0;
}

/* A descriptor, and the answer behind it; of measurements the descriptor alone. */
static void take_answer(ale_rplidar_parser_t *p, ale_rotary_packet_t *packet)
{
    const uint32_t word = ale_get_u32(p->bytes + 2);
    const uint32_t length = word & 0x3fffffffU;
    const uint8_t type = p->bytes[ALE_RPLIDAR_DESCRIPTOR - 1];
    if (word >> 30 == 1 &&
        (type == ALE_RPLIDAR_STANDARD || type == ALE_RPLIDAR_EXPRESS || type == ALE_RPLIDAR_DENSE)) {
        p->stream = type;
        p->have = 0;
        return;
    }
    if (word >> 30 != 0 || length == 0 || length > ALE_RPLIDAR_ANSWER) {
        shift(p);
        return;
    }
    if (p->have >= ALE_RPLIDAR_DESCRIPTOR + length) {
        p->answer_type = type;
        p->answer_bytes = length;
        memcpy(p->answer, p->bytes + ALE_RPLIDAR_DESCRIPTOR, length);
        p->have = 0;
        packet->kind = ALE_PACKET_ANSWER;
    }
}

static void take_byte(ale_rplidar_parser_t *p, uint8_t byte, ale_rotary_packet_t *packet)
{
    p->bytes[p->have++] = byte;
    p->stream_bytes += p->stream != 0;
    if (!begins(p)) {
        lose_step(p, packet);
    } else if (p->stream == 0 && p->have >= ALE_RPLIDAR_DESCRIPTOR) {
        take_answer(p, packet);
    } else if (p->stream == ALE_RPLIDAR_STANDARD && p->have == NODES_BYTES) {
        take_nodes(p, packet);
    } else if (p->stream != 0 && p->have == ALE_RPLIDAR_CAPSULE) {
        take_capsule(p, packet);
    }
}

uint32_t ale_rplidar_parse(ale_rplidar_parser_t *p, const uint8_t *bytes, uint32_t count,
                           ale_rotary_packet_t *packet)
{
    uint32_t used = 0;
    packet->kind = ALE_PACKET_NONE;
    while (used < count && packet->kind == ALE_PACKET_NONE) {
        take_byte(p, bytes[used++], packet);
    }
    packet->garbage = p->garbage;
    p->garbage = 0;
    return used;
}
