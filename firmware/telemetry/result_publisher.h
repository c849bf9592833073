/* Sends what came of each scan: pose, tracking, features and scan over LCM; the scan to those who drive by
 * it; all of it to the flight recorder; changes of tracking in words to the log. For the telemetry thread. */
#ifndef ALE_FIRMWARE_TELEMETRY_RESULT_PUBLISHER_H
#define ALE_FIRMWARE_TELEMETRY_RESULT_PUBLISHER_H

#include <stdbool.h>
#include <stdint.h>

#include "config/config.h"
#include "exchange/exchange.h"
#include "lcm/bus.h"
#include "system/async_logger.h"
#include "telemetry/statistics.h"
#include "telemetry/tracking_watch.h"

/* All zero but the first four: nothing has been sent yet. */
typedef struct {
    const ale_config_t *config;
    ale_exchange_t *exchange;
    ale_bus_t *bus;
    ale_logger_t *logger;
    ale_pose_t pose; /* in the map, newest */
    uint32_t epoch;  /* of that map, */
    uint32_t moves;  /* and how often it was moved */
    ale_statistics_t statistics;
    ale_tracking_watch_t tracking;
} ale_result_publisher_t;

/* Sends every result that is ready, oldest first. with_scans: ALE_SCAN too. */
void ale_result_publisher_work(ale_result_publisher_t *publisher, bool with_scans);

#endif
