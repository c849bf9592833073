/* The clocks of those whose stamped messages are heard, each followed by itself (sender_clock.h). */
#ifndef ALE_LCM_SENDER_CLOCKS_H
#define ALE_LCM_SENDER_CLOCKS_H

#include <stdbool.h>
#include <stdint.h>

#include "lcm/sender_clock.h"

enum { ALE_MOST_SENDERS = 4 };

typedef struct {
    uint64_t sender;
    ale_sender_clock_t clock;
} ale_known_sender_t;

/* All zero but the scale (1000000: real time): nobody heard yet. Fields are private, but for reading. */
typedef struct {
    int32_t scale_ppm;
    ale_known_sender_t known[ALE_MOST_SENDERS]; /* heard of last */
    uint64_t refused;                           /* messages whose stamps agreed with no clock */
    uint32_t steps;                             /* of clocks, */
    int64_t step_us;                            /* and the last one: ahead is positive */
} ale_sender_clocks_t;

/* As ale_sender_clock_take, of one of them (ale_wire_sender). One more than there is room for takes the place
 * of who was heard of the longest ago. */
bool ale_sender_clocks_take(ale_sender_clocks_t *clocks, uint64_t sender, int64_t stamp_us,
                            int64_t arrival_us, int64_t *time_us);

/* How many were heard after this moment; at most ALE_MOST_SENDERS are known. */
uint32_t ale_sender_clocks_heard_since(const ale_sender_clocks_t *clocks, int64_t moment_us);

#endif
