/* When a scan was really taken: a mirror turns more evenly than a busy computer writes stamps.
 *
 * Stamps that jitter about an even pace by more than a little are replaced by that pace (a phase-locked
 * loop over the stamps); stamps that are even, stamps that keep no pace, and those of logs that hold a scan
 * now and then, are taken as they are. In
 * the recordings of a URG on a rover the stamps swing by 20 ms: at 2 rad/s that is 2 degrees between the
 * scan and the wheels. Source: bench of recordings, see README. One owner; constant work. */
#ifndef ALE_MOTION_TIMESTAMP_FILTER_H
#define ALE_MOTION_TIMESTAMP_FILTER_H

#include <stdbool.h>
#include <stdint.h>

typedef struct {
    uint32_t scans;   /* since the pace was taken up */
    int64_t stamp_us; /* of the last scan */
    int64_t even_us;  /* its instant by the pace */
    int64_t period_q8_us;
    int64_t jitter2_us2; /* mean square of stamp minus pace */
    int64_t usual_us;    /* mean time between scans, whatever their pace; 0: not known */
} ale_timestamp_filter_t;

void ale_timestamp_filter_init(ale_timestamp_filter_t *timestamp_filter);

/* Takes the stamp of the next scan and returns its instant, on the stamps' clock. A step back, or of more
 * than two seconds, takes up the pace anew. */
int64_t ale_timestamp_filter_instant(ale_timestamp_filter_t *timestamp_filter, int64_t stamp_us);

/* Whether the time between two scans can be believed: not if it is far less than usual, as in logs whose
 * stamps were taken when a queue was emptied. */
bool ale_timestamp_filter_accepts(const ale_timestamp_filter_t *timestamp_filter, int64_t step_us);

#endif
