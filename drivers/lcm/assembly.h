/* Messages that come in parts, put together in memory that is there from the start: four messages under way,
 * of at most 64 KiB each, whatever a sender announces. Parts are taken in their order, as LCM sends them and
 * as they arrive on one machine; one that is out of turn, or that the one before did not come of, ends its
 * message. Nothing of ale-slamd and its tools is so long that LCM takes it apart, but LCM on macOS does
 * from 1.4 kB on. */
#ifndef ALE_LCM_ASSEMBLY_H
#define ALE_LCM_ASSEMBLY_H

#include "lcm/datagram.h"

enum { ALE_ASSEMBLY_MESSAGES = 4, ALE_ASSEMBLY_BYTES = 65536 };

typedef struct {
    uint64_t from;
    uint32_t sequence;
    uint32_t size;
    uint32_t filled;
    uint16_t next; /* number of the part that is due */
    uint16_t of;   /* 0: nothing is under way here */
    char channel[ALE_DATAGRAM_CHANNEL + 1];
    uint8_t bytes[ALE_ASSEMBLY_BYTES];
} ale_partial_t;

/* All zero: nothing is under way. */
typedef struct {
    ale_partial_t partial[ALE_ASSEMBLY_MESSAGES];
    uint32_t turn;
    uint64_t
        refused; /* parts that fit no message, or whose message is too long; messages given up for others */
} ale_assembly_t;

/* Takes one part (is_part). from: who sent it, one number for each sender, who is taken to send one message
 * after the other. The whole message when this was its last part: filled bytes, valid until the next call;
 * else NULL. Copies the part; no loop but over four messages. */
const ale_partial_t *ale_assembly_add(ale_assembly_t *assembly, uint64_t from, const ale_datagram_t *part);

#endif
