/* How what comes from the bus is handed on, and what is counted that is not. */
#ifndef ALE_LCM_INCOMING_H
#define ALE_LCM_INCOMING_H

#include <stddef.h>
#include <stdint.h>

/* A message: valid in the call only. Bytes that nobody has looked at but for their length. */
typedef void (*ale_lcm_take_t)(void *user, const char *channel, const uint8_t *bytes, size_t count);

typedef struct {
    uint64_t
        malformed; /* datagrams that are none of LCM's, or parts of a message that cannot be put together */
    uint64_t unheard; /* what the kernel dropped: of other machines (ttl 0), or more than may wait */
} ale_lcm_dropped_t;

#endif
