/* A ring of equal slots between one producer thread and one consumer thread: lock-free, wait-free, in place.
 *
 *   producer:  slot = ale_ring_reserve(ring);  if (slot) { fill it; ale_ring_commit(ring); }
 *   consumer:  for (n = ale_ring_ready(ring); n > 0; n--) { use ale_ring_at(ring, 0); ale_ring_release(ring);
 * }
 *
 * Exactly one thread produces and one consumes; with more the ring is broken. A full ring refuses the newest
 * and counts it. No call blocks, allocates or makes a system call, create and destroy apart. */
#ifndef ALE_FIRMWARE_EXCHANGE_RING_H
#define ALE_FIRMWARE_EXCHANGE_RING_H

#include <stdint.h>

typedef struct ale_ring ale_ring_t;

/* slots: a power of two. The memory is touched. NULL: out of memory. */
ale_ring_t *ale_ring_create(uint32_t slot_bytes, uint32_t slots);
void ale_ring_destroy(ale_ring_t *ring);

/* Producer: the slot to fill, or NULL when the ring is full (counted). Asking twice gives the same slot. */
void *ale_ring_reserve(ale_ring_t *ring);
void ale_ring_commit(ale_ring_t *ring);

/* Consumer: filled slots; the k-th oldest of them, k < ready; giving back the oldest. */
uint32_t ale_ring_ready(const ale_ring_t *ring);
void *ale_ring_at(ale_ring_t *ring, uint32_t k);
void ale_ring_release(ale_ring_t *ring);

/* Any thread: slots committed and refused since the start; they wrap at 2^32. */
uint32_t ale_ring_committed(const ale_ring_t *ring);
uint32_t ale_ring_refused(const ale_ring_t *ring);

#endif
