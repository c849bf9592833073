/* How long no recording is written that nobody asked for: a minute after the first one, twice as long after
 * each that follows, an hour at most; a minute again after an hour without. A cable that comes loose once a
 * minute fills no disk and tells nothing new. Pure: time comes in. */
#ifndef ALE_FIRMWARE_RECORDER_FLIGHT_PAUSE_H
#define ALE_FIRMWARE_RECORDER_FLIGHT_PAUSE_H

#include <stdbool.h>
#include <stdint.h>

#define ALE_FLIGHT_PAUSE_NS 60000000000LL
#define ALE_FLIGHT_LONGEST_PAUSE_NS (60 * ALE_FLIGHT_PAUSE_NS)

typedef struct {
    int64_t until_ns;
    int64_t next_ns;  /* length of the one after the next recording */
} ale_flight_pause_t; /* all zero: none was written yet */

/* Whether one may be written. */
bool ale_flight_pause_is_over(const ale_flight_pause_t *pause, int64_t now_ns);

/* One is. */
void ale_flight_pause_begin(ale_flight_pause_t *pause, int64_t now_ns);

#endif
