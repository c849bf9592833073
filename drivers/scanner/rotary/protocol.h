/* What a family of rotary scanners provides: pure functions on bytes, in one table. The device
 * (rotary_device.h) does the rest: port, time, turns, recovery, health. */
#ifndef ALE_SCANNER_ROTARY_PROTOCOL_H
#define ALE_SCANNER_ROTARY_PROTOCOL_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "scanner/rotary/packet.h"
#include "scanner/scanner_types.h"

enum { ALE_REQUEST_BYTES = 16, ALE_ROTARY_BAUDS = 4, ALE_ROTARY_WORDS = 96 };

typedef enum { ALE_DTR_KEEP, ALE_DTR_ON, ALE_DTR_OFF } ale_dtr_t;

/* What is to be done now. */
typedef struct {
    uint8_t bytes[ALE_REQUEST_BYTES]; /* to be sent */
    uint32_t count;
    ale_dtr_t dtr;   /* of a board whose motor hangs on that line */
    bool streams;    /* points follow; else an answer */
    int32_t wait_ms; /* for the first whole turn, or for the answer */
    bool gives_up;   /* nobody answers here: another rate, or the port anew */
} ale_rotary_request_t;

/* The range that a model measures, micrometres, and what it is called; filled as far as they are known. */
typedef struct {
    ale_scanner_identity_t identity;
    int32_t range_min_um;
    int32_t range_max_um;
    int32_t baud; /* usual rate of the model; 0: not known */
    uint64_t hardware_faults;
    char words[ALE_ROTARY_WORDS]; /* what the sensor says of its health; empty: nothing */
} ale_rotary_facts_t;

typedef struct {
    const char *name;                /* of the family */
    int32_t bauds[ALE_ROTARY_BAUDS]; /* rates that its models have, the most frequent first; 0: no more */
    bool clockwise;                  /* seen from above */
    int32_t turns_mdeg_s;            /* speed that the head keeps by itself; 0: no such */
    size_t state_bytes;              /* of the state that all functions are given, zeroed at first */

    /* The port was opened, or the stream is to begin anew: forgets what was half read. */
    void (*begin)(void *state);
    /* Reads on in the bytes; stops behind the first packet. The number of bytes used, at least 1 of count >
     * 0. Any cut of the same bytes into pieces gives the same packets. O(count). */
    uint32_t (*parse)(void *state, const uint8_t *bytes, uint32_t count, ale_rotary_packet_t *packet);
    /* After begin, after an ANSWER, and when the time to wait is over (late). NULL: it sends unasked. */
    ale_rotary_request_t (*next)(void *state, bool late);
    /* What stops the sensor before the port is closed. NULL: nothing. */
    ale_rotary_request_t (*stop)(void *state);
    void (*facts)(const void *state, ale_rotary_facts_t *facts);

    /* Of a recording, in place of next: what was sent, or (count 0) the ANSWER that came. True: the stream
     * ends here, and what was half read is forgotten. NULL: nothing is sent. */
    bool (*overhear)(void *state, const uint8_t *sent, uint32_t count);
} ale_rotary_protocol_t;

extern const ale_rotary_protocol_t ale_ldrobot_protocol; /* scanner/ldrobot, of ale_ldrobot_t */
extern const ale_rotary_protocol_t ale_rplidar_protocol; /* scanner/rplidar, of ale_rplidar_t */

#endif
