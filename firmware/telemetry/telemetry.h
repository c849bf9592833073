/* The telemetry thread: results out over LCM, odometry and commands in from it, status and map at
 * their own pace.
 *
 * It is not woken by the estimate task, which makes no system call but its wait: the acquire thread
 * announces a scan under way, and until its result is there the thread looks every quarter of a millisecond.
 */
#ifndef ALE_FIRMWARE_TELEMETRY_TELEMETRY_H
#define ALE_FIRMWARE_TELEMETRY_TELEMETRY_H

#include "command/keys.h"
#include "config/config.h"
#include "exchange/exchange.h"
#include "lcm/bus.h"
#include "realtime/rt.h"

typedef struct ale_telemetry ale_telemetry_t;

/* Takes the bus over as its only user. keys: of those who are obeyed. Returns when the bus hears itself, at
 * once as a rule, after a second in which it does not, or when there is no route for multicast: then the bus
 * is joined as soon as there is one. NULL: no memory or no threads. config and exchange
 * must outlive it. */
ale_telemetry_t *ale_telemetry_start(const ale_config_t *config, const ale_keys_t *keys,
                                     ale_exchange_t *exchange, ale_bus_t *bus,
                                     const ale_rt_report_t *realtime);

/* Sends what is still waiting, then stops; the bus is the caller's again. NULL: nothing. */
void ale_telemetry_stop(ale_telemetry_t *telemetry);

#endif
