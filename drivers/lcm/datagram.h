/* One datagram of LCM's UDP multicast. Pure functions: bytes in, bytes out.
 *
 *   "LC02" | sequence (4) | channel, ends with 0 | message                                       a whole
 * message "LC03" | sequence (4) | size of the message (4) | offset (4) | number (2) | of how many (2) | part
 * of it
 *
 * Numbers are big-endian. The part with number 0 begins with the channel; offsets count the message alone.
 * What comes in is hostile: every length is held against the bytes that are there, before it is used. */
#ifndef ALE_LCM_DATAGRAM_H
#define ALE_LCM_DATAGRAM_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum {
    ALE_DATAGRAM_CHANNEL = 63,                            /* longest name, without its end */
    ALE_DATAGRAM_MOST = 65507,                            /* bytes: what UDP over IPv4 carries */
    ALE_DATAGRAM_HEAD = 4 + 4 + ALE_DATAGRAM_CHANNEL + 1, /* of a whole message, with the longest channel */
};

typedef struct {
    bool is_part;
    const char *channel; /* ends with 0, 1 to 63 characters; NULL in parts but the first */
    const uint8_t *bytes;
    size_t count;
    /* Of a part only: */
    uint32_t sequence;
    uint32_t size; /* of the whole message */
    uint32_t offset;
    uint16_t number;
    uint16_t of; /* at least 1, more than number */
} ale_datagram_t;

/* Takes a datagram apart; what *out points at lies within `bytes`. Looks at the header and 64 bytes of the
 * channel. 0, or -1 when it is none of LCM's: *out is then undefined. That a part fits its message is held
 * here: offset + count <= size, in numbers that cannot wrap. How large a message may be is the caller's
 * business. */
int ale_datagram_read(const uint8_t *bytes, size_t count, ale_datagram_t *out);

/* What stands before a whole message. The bytes written, or 0 when the channel has none or more than 63
 * characters. */
size_t ale_datagram_head(uint32_t sequence, const char *channel, uint8_t head[ALE_DATAGRAM_HEAD]);

#endif
