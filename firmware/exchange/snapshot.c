#include "exchange/snapshot.h"

#include <stdatomic.h>
#include <stdlib.h>

#include "realtime/memory.h"

enum { FRESH = 4, INDEX = 3 };

/* back belongs to the writer, front to the reader; they trade theirs for the middle one. */
struct ale_snapshot {
    void *buffer[3];
    unsigned back;
    unsigned front;
    atomic_uint middle; /* index, and FRESH when the writer traded last */
};

ale_snapshot_t *ale_snapshot_create(uint32_t bytes)
{
    ale_snapshot_t *snapshot = calloc(1, sizeof *snapshot);
    if (!snapshot) {
        return NULL;
    }
    for (int k = 0; k < 3; k++) {
        snapshot->buffer[k] = calloc(1, bytes);
        if (!snapshot->buffer[k]) {
            ale_snapshot_destroy(snapshot);
            return NULL;
        }
        ale_rt_touch(snapshot->buffer[k], bytes);
    }
    snapshot->back = 0;
    snapshot->front = 1;
    atomic_init(&snapshot->middle, 2);
    return snapshot;
}

void ale_snapshot_destroy(ale_snapshot_t *snapshot)
{
    if (!snapshot) {
        return;
    }
    for (int k = 0; k < 3; k++) {
        free(snapshot->buffer[k]);
    }
    free(snapshot);
}

void *ale_snapshot_back(ale_snapshot_t *snapshot)
{
    return snapshot->buffer[snapshot->back];
}

void ale_snapshot_publish(ale_snapshot_t *snapshot)
{
    const unsigned old =
        atomic_exchange_explicit(&snapshot->middle, snapshot->back | FRESH, memory_order_acq_rel);
    snapshot->back = old & INDEX;
}

const void *ale_snapshot_newest(ale_snapshot_t *snapshot, bool *fresh)
{
    *fresh = (atomic_load_explicit(&snapshot->middle, memory_order_relaxed) & FRESH) != 0;
    if (*fresh) {
        const unsigned old =
            atomic_exchange_explicit(&snapshot->middle, snapshot->front, memory_order_acq_rel);
        snapshot->front = old & INDEX;
    }
    return snapshot->buffer[snapshot->front];
}
