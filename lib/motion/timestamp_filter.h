/* Timestamp filter: when a scan was really taken. A mirror turns more evenly than a busy computer writes
 * stamps.
 *
 * A phase-locked loop follows the stamps. Stamps that jitter about an even period by more than 2 ms are
 * replaced by the loop's, however far a queue has held them up and in whatever order it let them go; even
 * stamps, stamps without a period, and those of logs with a scan now and then are kept. Where stamps swing by
 * 20 ms, 2 rad/s make 2 degrees between scan and odometry. One owner; constant work. */
#ifndef ALE_MOTION_TIMESTAMP_FILTER_H
#define ALE_MOTION_TIMESTAMP_FILTER_H

#include <stdbool.h>
#include <stdint.h>

enum { ALE_SCAN_PERIOD_MAX_US = 2000000 }; /* scans farther apart say nothing of speed */

typedef struct {
    uint32_t scans;   /* since the loop was restarted */
    int64_t stamp_us; /* of the last scan */
    int64_t even_us;  /* its instant by the loop */
    int64_t period_q8_us;
    int64_t jitter2_us2;     /* mean square of stamp minus loop */
    int64_t walk_us2;        /* mean; below 0: the stamps do not walk off the loop */
    int64_t usual_us;        /* mean time between scans, even or not; 0: unknown */
    int64_t usual_before_us; /* and before the last one came */
    int64_t off_us;          /* what the last of these times was off, */
    int64_t uneven2_us2;     /* and the mean square of that, of many scans before it */
} ale_timestamp_filter_t;

void ale_timestamp_filter_init(ale_timestamp_filter_t *timestamp_filter);

/* Instant of the next scan, on the clock of its stamp. A step back, or of more than two seconds, restarts the
 * loop; where stamps are held up by more than a quarter of the period, one of more than four seconds. */
int64_t ale_timestamp_filter_instant(ale_timestamp_filter_t *timestamp_filter, int64_t stamp_us);

/* Whether scans come as the mirror turns, not only some of them. */
bool ale_timestamp_filter_is_dense(const ale_timestamp_filter_t *timestamp_filter);

/* Up to which time between scans says nothing: the usual one and four times what stamps are off it, which a
 * busy computer writes as it comes to. */
int64_t ale_timestamp_filter_usual_most_us(const ale_timestamp_filter_t *timestamp_filter);

/* Whether the time between two scans is plausible: not if it is less than a quarter of the mean, as in logs
 * whose stamps were taken when a queue was emptied. */
bool ale_timestamp_filter_accepts(const ale_timestamp_filter_t *timestamp_filter, int64_t step_us);

#endif
