/* Odometry on its way from the bus to the estimate task: put into the robot's time by the clock of who sent
 * it (lcm/sender_clocks.h), and counted, by the reason where it is refused. For the telemetry thread. */
#ifndef ALE_FIRMWARE_TELEMETRY_ODOMETRY_INTAKE_H
#define ALE_FIRMWARE_TELEMETRY_ODOMETRY_INTAKE_H

#include <stdbool.h>
#include <stdint.h>

#include "exchange/exchange.h"
#include "lcm/bus.h"
#include "lcm/sender_clocks.h"

enum { ALE_INTAKE_LINE = 160 };

typedef struct {
    ale_exchange_t *exchange;
    ale_sender_clocks_t clocks;
    uint32_t steps_told; /* of clocks */
    int64_t next_word_us;
} ale_odometry_intake_t;

/* Nothing heard yet. */
void ale_odometry_intake_init(ale_odometry_intake_t *intake, ale_exchange_t *exchange);

/* Takes a sample as the bus hands it on: stamp_us is a utime of the sender's clock. */
void ale_odometry_intake_take(ale_odometry_intake_t *intake, const ale_odometry_t *sample, uint64_t sender);

/* True when there is something to say: that a clock was stepped, at most once in ten seconds. */
bool ale_odometry_intake_word(ale_odometry_intake_t *intake, char line[ALE_INTAKE_LINE]);

/* Adds the counters of what came and what was refused. */
void ale_odometry_intake_counters(const ale_odometry_intake_t *intake, ale_bus_refused_t bus_refused,
                                  ale_status_report_t *report);

#endif
