#include "scanner/ldrobot/ldrobot.h"

#include <stdio.h>
#include <string.h>

#include "file/little_endian.h"
#include "scanner/rotary/rotary_device.h"
#include "scanner/scanner_family.h"

enum {
    HEADER = 0x54,
    LENGTH = 0x2c, /* a version of 1 in the upper three bits, 12 points in the lower five */
    AT_SPEED = 2,
    AT_START = 4,
    AT_POINTS = 6,
    POINT_BYTES = 3,
    AT_END = AT_POINTS + ALE_LDROBOT_POINTS * POINT_BYTES,
    AT_STAMP = AT_END + 2,
    POLYNOMIAL = 0x4d,
    TURN = 36000,      /* hundredths of a degree */
    WIDEST = TURN / 4, /* at 13 turns a second a packet sweeps 12.5 degrees */
    STAMP_MS = 30000,
    GAPS = ALE_LDROBOT_POINTS - 1
};

uint8_t ale_ldrobot_sum(const uint8_t *bytes, uint32_t count)
{
    uint8_t sum = 0;
    for (uint32_t k = 0; k < count; k++) {
        sum ^= bytes[k];
        for (int bit = 0; bit < 8; bit++) {
            sum = (uint8_t)((sum & 0x80) != 0 ? sum << 1 ^ POLYNOMIAL : sum << 1);
        }
    }
    return sum;
}

/* What is there may be the beginning of a packet. */
static bool begins(const uint8_t *bytes, uint32_t count)
{
    return bytes[0] == HEADER && (count < 2 || bytes[1] == LENGTH);
}

/* Lets go of the first byte, and of those behind it that begin no packet. */
static void shift(ale_ldrobot_t *l)
{
    uint32_t from = 1;
    while (from < l->have && !begins(l->bytes + from, l->have - from)) {
        from++;
    }
    l->garbage += from;
    l->have -= from;
    memmove(l->bytes, l->bytes + from, l->have);
}

static int64_t advance(ale_ldrobot_t *l, uint16_t stamp_ms)
{
    const int32_t passed_ms = l->stamped ? (stamp_ms - l->stamp_ms + STAMP_MS) % STAMP_MS : 0;
    l->stamped = true;
    l->stamp_ms = stamp_ms;
    l->sensor_us += (int64_t)passed_ms * 1000;
    return l->sensor_us;
}

/* Bearings of the points lie evenly between those of the first and the last; an eleventh of 0.01 degree is
 * exact. */
static uint32_t bearing_of(uint32_t start, uint32_t sweep, uint32_t k)
{
    const uint64_t clockwise = (uint64_t)start * GAPS + (uint64_t)sweep * k;
    return (uint32_t)(0 - (clockwise << 32) / ((uint64_t)TURN * GAPS));
}

static bool fill(ale_ldrobot_t *l, ale_rotary_packet_t *packet)
{
    const uint8_t *bytes = l->bytes;
    const uint32_t start = ale_get_u16(bytes + AT_START);
    const uint32_t end = ale_get_u16(bytes + AT_END);
    const uint16_t stamp_ms = ale_get_u16(bytes + AT_STAMP);
    const uint32_t sweep = (end + TURN - start) % TURN;
    if (start >= TURN || end >= TURN || sweep > WIDEST || stamp_ms > STAMP_MS) {
        return false;
    }
    packet->sensor_us = advance(l, stamp_ms);
    packet->behind_us = 0;
    packet->line_bytes = ALE_LDROBOT_PACKET;
    packet->speed_mdeg_s = ale_get_u16(bytes + AT_SPEED) * 1000;
    packet->count = ALE_LDROBOT_POINTS;
    for (uint32_t k = 0; k < ALE_LDROBOT_POINTS; k++) {
        const uint8_t *at = bytes + AT_POINTS + (size_t)k * POINT_BYTES;
        packet->points[k] = (ale_rotary_point_t){bearing_of(start, sweep, k), ale_get_u16(at) * 1000};
    }
    return true;
}

/* All bytes of a packet are there. */
static void judge(ale_ldrobot_t *l, ale_rotary_packet_t *packet)
{
    const uint32_t summed = ALE_LDROBOT_PACKET - 1;
    const bool whole = ale_ldrobot_sum(l->bytes, summed) == l->bytes[summed];
    if (whole && fill(l, packet)) {
        packet->kind = ALE_PACKET_POINTS;
        l->have = 0;
    } else {
        packet->kind = ALE_PACKET_DAMAGED;
        shift(l);
    }
}

/* Reads on until a packet is whole or no byte is left; the number of bytes used. */
static uint32_t read_on(ale_ldrobot_t *l, const uint8_t *bytes, uint32_t count, ale_rotary_packet_t *packet)
{
    for (uint32_t used = 0; used < count;) {
        l->bytes[l->have++] = bytes[used++];
        if (!begins(l->bytes, l->have)) {
            shift(l);
        } else if (l->have == ALE_LDROBOT_PACKET) {
            judge(l, packet);
            return used;
        }
    }
    return count;
}

uint32_t ale_ldrobot_parse(void *state, const uint8_t *bytes, uint32_t count, ale_rotary_packet_t *packet)
{
    ale_ldrobot_t *l = state;
    packet->kind = ALE_PACKET_NONE;
    const uint32_t used = read_on(l, bytes, count, packet);
    packet->garbage = l->garbage;
    l->garbage = 0;
    return used;
}

static void begin(void *state)
{
    ale_ldrobot_t *l = state;
    l->garbage += l->have;
    l->have = 0;
    l->stamped = false;
}

static void facts(const void *state, ale_rotary_facts_t *f)
{
    (void)state;
    snprintf(f->identity.model, sizeof f->identity.model, "LDROBOT LD06, LD19 or STL-19P");
    f->range_min_um = 20000;
    f->range_max_um = 12000000;
}

const ale_rotary_protocol_t ale_ldrobot_protocol = {.name = "ldrobot",
                                                    .bauds = {230400},
                                                    .clockwise = true,
                                                    .turns_mdeg_s = 3600000,
                                                    .state_bytes = sizeof(ale_ldrobot_t),
                                                    .begin = begin,
                                                    .parse = ale_ldrobot_parse,
                                                    .facts = facts};

static bool has_baud(int32_t baud)
{
    return baud == ale_ldrobot_protocol.bauds[0];
}

static ale_scanner_t *open_scanner(const ale_scanner_config_t *config)
{
    return ale_rotary_open(&ale_scanner_ldrobot, &ale_ldrobot_protocol, config);
}

const ale_scanner_family_t ale_scanner_ldrobot = {.name = "ldrobot",
                                                  .tries = 1,
                                                  .has_baud = has_baud,
                                                  .open = open_scanner,
                                                  .step = ale_rotary_step,
                                                  .health = ale_rotary_health,
                                                  .close = ale_rotary_close};
