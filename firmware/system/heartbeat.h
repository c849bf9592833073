/* A sign of life: one thread beats, any other sees whether it still does. Lock-free; no system call. */
#ifndef ALE_FIRMWARE_SYSTEM_HEARTBEAT_H
#define ALE_FIRMWARE_SYSTEM_HEARTBEAT_H

#include <stdint.h>

typedef struct ale_pulse ale_pulse_t;

ale_pulse_t *ale_pulse_create(void); /* NULL: out of memory */
void ale_pulse_destroy(ale_pulse_t *pulse);

void ale_pulse_beat(ale_pulse_t *pulse);

/* Beats since the start; wraps. */
uint32_t ale_pulse_beats(const ale_pulse_t *pulse);

#endif
