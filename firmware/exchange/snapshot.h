/* The newest value of something large, from one writer thread to one reader thread: a triple buffer.
 *
 *   writer:  fill ale_snapshot_back(s);  ale_snapshot_publish(s);
 *   reader:  value = ale_snapshot_newest(s, &fresh);
 *
 * Neither side ever waits for the other; values that the reader was too slow for are skipped. No call
 * blocks, allocates or makes a system call, create and destroy apart. */
#ifndef ALE_FIRMWARE_EXCHANGE_SNAPSHOT_H
#define ALE_FIRMWARE_EXCHANGE_SNAPSHOT_H

#include <stdbool.h>
#include <stdint.h>

typedef struct ale_snapshot ale_snapshot_t;

/* Three buffers of `bytes`, all zero and touched. NULL: out of memory. */
ale_snapshot_t *ale_snapshot_create(uint32_t bytes);
void ale_snapshot_destroy(ale_snapshot_t *snapshot);

/* Writer: the buffer to fill. It holds some older value. */
void *ale_snapshot_back(ale_snapshot_t *snapshot);
void ale_snapshot_publish(ale_snapshot_t *snapshot);

/* Reader: the newest value, valid until the next call; all zero before the first was published. *fresh:
 * it was published since the last call. */
const void *ale_snapshot_newest(ale_snapshot_t *snapshot, bool *fresh);

#endif
