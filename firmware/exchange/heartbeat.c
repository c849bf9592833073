#include "exchange/heartbeat.h"

#include <stdatomic.h>
#include <stdlib.h>

struct ale_heartbeat {
    atomic_uint beats;
};

ale_heartbeat_t *ale_heartbeat_create(void)
{
    return calloc(1, sizeof(ale_heartbeat_t));
}

void ale_heartbeat_destroy(ale_heartbeat_t *heartbeat)
{
    free(heartbeat);
}

void ale_heartbeat_beat(ale_heartbeat_t *heartbeat)
{
    atomic_fetch_add_explicit(&heartbeat->beats, 1, memory_order_relaxed);
}

uint32_t ale_heartbeat_beats(const ale_heartbeat_t *heartbeat)
{
    return atomic_load_explicit(&heartbeat->beats, memory_order_relaxed);
}
