#include "lcm/datagram.h"

#include <string.h>

enum { WHOLE = 0x4c433032, PART = 0x4c433033, WHOLE_HEADER = 8, PART_HEADER = 20 };

static uint32_t number_at(const uint8_t *bytes)
{
    return (uint32_t)bytes[0] << 24 | (uint32_t)bytes[1] << 16 | (uint32_t)bytes[2] << 8 | bytes[3];
}

static uint16_t short_at(const uint8_t *bytes)
{
    return (uint16_t)(bytes[0] << 8 | bytes[1]);
}

static void put_number(uint32_t number, uint8_t *bytes)
{
    for (int k = 0; k < 4; k++) {
        bytes[k] = (uint8_t)(number >> (24 - 8 * k));
    }
}

/* The channel at the begin of what is left, which then begins behind it. */
static int take_channel(ale_datagram_t *out)
{
    const size_t most = out->count < ALE_DATAGRAM_CHANNEL + 1 ? out->count : ALE_DATAGRAM_CHANNEL + 1;
    const size_t length = strnlen((const char *)out->bytes, most);
    if (length == 0 || length == most) {
        return -1;
    }
    out->channel = (const char *)out->bytes;
    out->bytes += length + 1;
    out->count -= length + 1;
    return 0;
}

static int read_part(const uint8_t *bytes, size_t count, ale_datagram_t *out)
{
    if (count < PART_HEADER) {
        return -1;
    }
    *out = (ale_datagram_t){
        .is_part = true,
        .bytes = bytes + PART_HEADER,
        .count = count - PART_HEADER,
        .sequence = number_at(bytes + 4),
        .size = number_at(bytes + 8),
        .offset = number_at(bytes + 12),
        .number = short_at(bytes + 16),
        .of = short_at(bytes + 18),
    };
    if (out->number >= out->of || (out->number == 0 && take_channel(out) < 0)) {
        return -1;
    }
    return out->offset <= out->size && out->count <= out->size - out->offset ? 0 : -1;
}

int ale_datagram_read(const uint8_t *bytes, size_t count, ale_datagram_t *out)
{
    if (count < WHOLE_HEADER) {
        return -1;
    }
    const uint32_t magic = number_at(bytes);
    if (magic == PART) {
        return read_part(bytes, count, out);
    }
    if (magic != WHOLE) {
        return -1;
    }
    *out = (ale_datagram_t){.bytes = bytes + WHOLE_HEADER, .count = count - WHOLE_HEADER};
    return take_channel(out);
}

size_t ale_datagram_head(uint32_t sequence, const char *channel, uint8_t head[ALE_DATAGRAM_HEAD])
{
    const size_t length = strnlen(channel, ALE_DATAGRAM_CHANNEL + 1);
    if (length == 0 || length > ALE_DATAGRAM_CHANNEL) {
        return 0;
    }
    put_number(WHOLE, head);
    put_number(sequence, head + 4);
    memcpy(head + WHOLE_HEADER, channel, length + 1);
    return WHOLE_HEADER + length + 1;
}
