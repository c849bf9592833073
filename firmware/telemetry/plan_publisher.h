/* ALE_PLAN: where the robot drives by itself, whenever that is planned anew, and once a second while it is at
 * it or has something to say of it. Telemetry thread only. */
#ifndef ALE_FIRMWARE_TELEMETRY_PLAN_PUBLISHER_H
#define ALE_FIRMWARE_TELEMETRY_PLAN_PUBLISHER_H

#include "exchange/exchange.h"
#include "lcm/bus.h"

typedef struct {
    ale_exchange_t *exchange;
    ale_bus_t *bus;
    uint32_t told; /* number of what was sent last */
    int64_t next_ns;
    ale_plan_report_t report;
} ale_plan_publisher_t;

/* Sends what is due. */
void ale_plan_publisher_work(ale_plan_publisher_t *publisher, int64_t now_ns);

#endif
