/* The acquire thread: steps the scanner's driver and hands every scan it sent to the estimate task. */
#ifndef ALE_FIRMWARE_ACQUIRE_ACQUIRE_H
#define ALE_FIRMWARE_ACQUIRE_ACQUIRE_H

#include "config/config.h"
#include "exchange/exchange.h"

typedef struct ale_acquire ale_acquire_t;

/* Starts the thread (ALE_RT_SOFT). config and exchange must outlive it. NULL: out of memory or threads. */
ale_acquire_t *ale_acquire_start(const ale_config_t *config, ale_exchange_t *exchange);

/* Stops the scanner and the thread, within about the driver's step of 50 ms. NULL: nothing. */
void ale_acquire_stop(ale_acquire_t *acquire);

#endif
