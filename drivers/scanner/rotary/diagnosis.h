/* Why no scan comes from a rotary scanner, or why it turns too slowly: from what was seen on its line. Pure.
 */
#ifndef ALE_SCANNER_ROTARY_DIAGNOSIS_H
#define ALE_SCANNER_ROTARY_DIAGNOSIS_H

#include <stdbool.h>
#include <stdint.h>

#include "scanner/rotary/protocol.h"

enum { ALE_DIAGNOSIS_WORDS = 168 };

/* Seen since the port was opened or the stream began anew, or since the last scan. */
typedef struct {
    uint32_t bytes;
    uint32_t packets; /* of points, whole */
    uint32_t answers; /* to what was asked */
    uint32_t damaged;
    uint32_t turned; /* by which the head went on in whole packets, 2^32 a turn, at most one turn */
} ale_line_seen_t;

/* Why no scan came. baud: of the port. */
void ale_diagnosis_no_scan(const ale_rotary_protocol_t *protocol, const ale_line_seen_t *seen, int32_t baud,
                           char words[ALE_DIAGNOSIS_WORDS]);

/* Whether the head turns much slower than it would by itself, and in words. was_slow: it did so before; it
 * must come up some more to be right again. */
bool ale_diagnosis_slow(const ale_rotary_protocol_t *protocol, int32_t speed_mdeg_s, bool was_slow,
                        char words[ALE_DIAGNOSIS_WORDS]);

#endif
