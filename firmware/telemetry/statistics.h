/* Times and counts over the run, for ALE_STATUS. Telemetry thread only. */
#ifndef ALE_FIRMWARE_TELEMETRY_STATISTICS_H
#define ALE_FIRMWARE_TELEMETRY_STATISTICS_H

#include "exchange/exchange.h"
#include "lcm/report.h"
#include "scanner/scanner.h"
#include "telemetry/durations.h"

typedef struct {
    ale_durations_t stage[ALE_STATUS_STAGES]; /* the last: all stages together */
    ale_durations_t latency;                  /* last byte of a scan to its pose on the wire */
    uint32_t poses;
    uint32_t overloaded;
    uint32_t corrections_late;
    uint32_t late;
    uint32_t wheel_faults; /* so often they began to */
    uint8_t wheel_fault;   /* ale_wheel_fault_t, of the newest pose */
    uint8_t maps;          /* that are not joined */
    uint8_t state;
} ale_statistics_t; /* all zero: nothing yet */

/* A result whose pose has just been sent, latency_ns after the scan's last byte. */
void ale_statistics_add(ale_statistics_t *statistics, const ale_result_t *result, int64_t latency_ns);

/* Fills times, counts and state of the report. */
void ale_statistics_report(const ale_statistics_t *statistics, ale_status_report_t *report);

/* Fills the report's counters: what the line, the driver, the rings and the bus lost, and why;
 * maps that are not joined, faults of the wheels. bus_unsent: messages that could not go out. */
void ale_statistics_counters(const ale_statistics_t *statistics, const ale_scanner_health_t *health,
                             const ale_exchange_t *exchange, uint64_t bus_unsent,
                             ale_status_report_t *report);

#endif
