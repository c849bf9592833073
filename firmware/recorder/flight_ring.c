#include "recorder/flight_ring.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "realtime/memory.h"

enum { OPENING_BYTES = 16384 };

struct ale_flight_ring {
    uint8_t *memory;
    uint32_t size;
    uint32_t first; /* where the oldest chunk begins */
    uint32_t used;
    bool lost; /* the oldest made room */
    bool opening_over;
    uint32_t opening_used;
    uint8_t opening[OPENING_BYTES];
};

ale_flight_ring_t *ale_flight_ring_create(uint32_t bytes)
{
    ale_flight_ring_t *ring = calloc(1, sizeof *ring);
    uint8_t *memory = calloc(1, bytes);
    if (!ring || !memory) {
        free(ring);
        free(memory);
        return NULL;
    }
    ale_rt_touch(memory, bytes);
    ring->memory = memory;
    ring->size = bytes;
    return ring;
}

void ale_flight_ring_destroy(ale_flight_ring_t *ring)
{
    if (ring) {
        free(ring->memory);
        free(ring);
    }
}

static void copy_in(ale_flight_ring_t *ring, const uint8_t *bytes, uint32_t count)
{
    const uint32_t at = (ring->first + ring->used) % ring->size;
    const uint32_t until_end = ring->size - at;
    const uint32_t head = count < until_end ? count : until_end;
    memcpy(ring->memory + at, bytes, head);
    memcpy(ring->memory, bytes + head, count - head);
    ring->used += count;
}

static void drop_oldest(ale_flight_ring_t *ring)
{
    uint8_t header[ALE_CHUNK_HEADER_BYTES];
    for (uint32_t k = 0; k < sizeof header; k++) {
        header[k] = ring->memory[(ring->first + k) % ring->size];
    }
    const uint32_t bytes = ale_chunk_bytes(header);
    ring->first = (ring->first + bytes) % ring->size;
    ring->used -= bytes;
    ring->lost = true;
}

/* The request for scans, M.. of SCIP 2, G of SCIP 1, is the last that a reader must know. */
static void keep_opening(ale_flight_ring_t *ring, const uint8_t *chunk, uint32_t bytes, bool asks_for_scans)
{
    if (ring->opening_over || ring->opening_used + bytes > OPENING_BYTES) {
        ring->opening_over = true;
        return;
    }
    memcpy(ring->opening + ring->opening_used, chunk, bytes);
    ring->opening_used += bytes;
    ring->opening_over = asks_for_scans;
}

void ale_flight_ring_put(ale_flight_ring_t *ring, ale_chunk_kind_t kind, int64_t stamp_us,
                         const void *payload, uint32_t length)
{
    uint8_t chunk[ALE_FLIGHT_MAX_PAYLOAD + ALE_CHUNK_FRAME_BYTES];
    const uint32_t bytes = ale_chunk_put(chunk, kind, stamp_us, payload, length);
    const uint8_t first = length > 0 ? *(const uint8_t *)payload : 0;
    if (kind == ALE_CHUNK_SENT || kind == ALE_CHUNK_RECEIVED) {
        keep_opening(ring, chunk, bytes, kind == ALE_CHUNK_SENT && (first == 'M' || first == 'G'));
    }
    while (ring->size - ring->used < bytes) {
        drop_oldest(ring);
    }
    copy_in(ring, chunk, bytes);
}

void ale_flight_ring_write(const ale_flight_ring_t *ring, ale_recording_t *recording)
{
    if (ring->lost) {
        fwrite(ring->opening, 1, ring->opening_used, recording->file);
    }
    const uint32_t until_end = ring->size - ring->first;
    const uint32_t head = ring->used < until_end ? ring->used : until_end;
    fwrite(ring->memory + ring->first, 1, head, recording->file);
    fwrite(ring->memory, 1, ring->used - head, recording->file);
}
