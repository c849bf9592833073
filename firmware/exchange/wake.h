/* What an ordinary thread waits on: an event descriptor. (A real-time task has ale_rt_release_t, on which a
 * thread that RTAI does not know cannot wait.) */
#ifndef ALE_FIRMWARE_EXCHANGE_WAKE_H
#define ALE_FIRMWARE_EXCHANGE_WAKE_H

#include <stdbool.h>
#include <stdint.h>

/* The descriptor, or -1. */
int ale_wake_open(void);
void ale_wake_close(int wake); /* -1: nothing */

/* Any thread; never blocks. Posts before a wait count as one. */
void ale_wake_post(int wake);

/* Until a post, or wait_ns are over. One waiting thread. */
void ale_wake_wait(int wake, int64_t wait_ns);

/* The same, or until the descriptor `source` has something to read: then true. */
bool ale_wake_wait_or_read(int wake, int source, int64_t wait_ns);

#endif
