/* Sends ALE_STATUS, and who says so (ALE_SPEAKER): once a second, and soon after something has happened that
 * operators should hear of. For the telemetry thread.
 *
 * What a status says comes from those who know it: statistics, odometry intake, other speakers, supervisor,
 * commands, logger.
 */
#ifndef ALE_FIRMWARE_TELEMETRY_STATUS_PUBLISHER_H
#define ALE_FIRMWARE_TELEMETRY_STATUS_PUBLISHER_H

#include <stdbool.h>
#include <stdint.h>

#include "exchange/exchange.h"
#include "lcm/bus.h"
#include "operator/commands.h"
#include "scanner/scanner.h"
#include "system/async_logger.h"
#include "telemetry/odometry_intake.h"
#include "telemetry/other_speakers.h"
#include "telemetry/statistics.h"

/* The sources must outlive the publisher. */
typedef struct {
    const ale_exchange_t *exchange;
    ale_bus_t *bus;
    ale_commands_t *commands;
    const ale_logger_t *logger;
    const ale_statistics_t *statistics;
    const ale_odometry_intake_t *odometry;
    ale_other_speakers_t *others;
    const ale_scanner_health_t *health; /* the scanner's newest */
    ale_rt_report_t realtime;
    int64_t boot; /* the nonce of this start */
    int64_t next_ns;
    int64_t last_ns;
    bool news;     /* of commands or the scanner, not yet in a status */
    bool refusals; /* not yet in a status: shown soon, but many of them do not make many statuses */
    ale_status_report_t report;
} ale_status_publisher_t;

/* Sends a status when one is due: at next_ns, or 50 ms after the last one when there is news. */
void ale_status_publisher_work(ale_status_publisher_t *publisher, int64_t now_ns);

/* Sends one now. */
void ale_status_publisher_send(ale_status_publisher_t *publisher);

/* Takes a command (commands.h). The answer to the one before it goes out first, if nobody has heard it yet.
 */
void ale_status_publisher_take_command(ale_status_publisher_t *publisher, const uint8_t *bytes, size_t count,
                                       const ale_map_t *newest_map);

#endif
