/* A sign of life: one thread beats, any other sees whether it still does. Lock-free; no system call. */
#ifndef ALE_FIRMWARE_EXCHANGE_HEARTBEAT_H
#define ALE_FIRMWARE_EXCHANGE_HEARTBEAT_H

#include <stdint.h>

typedef struct ale_heartbeat ale_heartbeat_t;

ale_heartbeat_t *ale_heartbeat_create(void); /* NULL: out of memory */
void ale_heartbeat_destroy(ale_heartbeat_t *heartbeat);

void ale_heartbeat_beat(ale_heartbeat_t *heartbeat);

/* Beats since the start; wraps. */
uint32_t ale_heartbeat_beats(const ale_heartbeat_t *heartbeat);

#endif
