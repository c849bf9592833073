#include "system/heartbeat.h"

#include <stdatomic.h>
#include <stdlib.h>

struct ale_pulse {
    atomic_uint beats;
};

ale_pulse_t *ale_pulse_create(void)
{
    return calloc(1, sizeof(ale_pulse_t));
}

void ale_pulse_destroy(ale_pulse_t *pulse)
{
    free(pulse);
}

void ale_pulse_beat(ale_pulse_t *pulse)
{
    atomic_fetch_add_explicit(&pulse->beats, 1, memory_order_relaxed);
}

uint32_t ale_pulse_beats(const ale_pulse_t *pulse)
{
    return atomic_load_explicit(&pulse->beats, memory_order_relaxed);
}
