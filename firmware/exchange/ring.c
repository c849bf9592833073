#include "exchange/ring.h"

#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

enum { CACHE_LINE = 64 };

/* A counter on a cache line of its own: its writer does not disturb the other side. */
typedef struct {
    _Alignas(CACHE_LINE) atomic_uint count;
} lone_counter_t;

/* Counters run freely and wrap; their difference is the fill. */
struct ale_ring {
    lone_counter_t committed; /* written by the producer */
    lone_counter_t refused;   /* by the producer */
    lone_counter_t released;  /* by the consumer */
    uint8_t *memory;
    uint32_t slot_bytes;
    uint32_t slots;
};

static void *slot_at(const ale_ring_t *ring, uint32_t counter)
{
    return ring->memory + (size_t)(counter & (ring->slots - 1)) * ring->slot_bytes;
}

static size_t round_up(size_t bytes)
{
    return (bytes + CACHE_LINE - 1) / CACHE_LINE * CACHE_LINE;
}

ale_ring_t *ale_ring_create(uint32_t slot_bytes, uint32_t slots)
{
    ale_ring_t *ring = aligned_alloc(CACHE_LINE, round_up(sizeof *ring));
    const size_t step = round_up(slot_bytes);
    uint8_t *memory = aligned_alloc(CACHE_LINE, step * slots);
    if (!ring || !memory) {
        free(ring);
        free(memory);
        return NULL;
    }
    memset(ring, 0, sizeof *ring);
    memset(memory, 0, step * slots);
    ring->slot_bytes = (uint32_t)step;
    ring->slots = slots;
    ring->memory = memory;
    return ring;
}

void ale_ring_destroy(ale_ring_t *ring)
{
    if (ring) {
        free(ring->memory);
        free(ring);
    }
}

void *ale_ring_reserve(ale_ring_t *ring)
{
    const uint32_t committed = atomic_load_explicit(&ring->committed.count, memory_order_relaxed);
    const uint32_t released = atomic_load_explicit(&ring->released.count, memory_order_acquire);
    if (committed - released == ring->slots) {
        atomic_fetch_add_explicit(&ring->refused.count, 1, memory_order_relaxed);
        return NULL;
    }
    return slot_at(ring, committed);
}

void ale_ring_commit(ale_ring_t *ring)
{
    const uint32_t committed = atomic_load_explicit(&ring->committed.count, memory_order_relaxed);
    atomic_store_explicit(&ring->committed.count, committed + 1, memory_order_release);
}

uint32_t ale_ring_ready(const ale_ring_t *ring)
{
    const uint32_t released = atomic_load_explicit(&ring->released.count, memory_order_relaxed);
    return atomic_load_explicit(&ring->committed.count, memory_order_acquire) - released;
}

void *ale_ring_at(ale_ring_t *ring, uint32_t k)
{
    return slot_at(ring, atomic_load_explicit(&ring->released.count, memory_order_relaxed) + k);
}

void ale_ring_release(ale_ring_t *ring)
{
    const uint32_t released = atomic_load_explicit(&ring->released.count, memory_order_relaxed);
    atomic_store_explicit(&ring->released.count, released + 1, memory_order_release);
}

uint32_t ale_ring_committed(const ale_ring_t *ring)
{
    return atomic_load_explicit(&ring->committed.count, memory_order_acquire);
}

uint32_t ale_ring_refused(const ale_ring_t *ring)
{
    return atomic_load_explicit(&ring->refused.count, memory_order_relaxed);
}
