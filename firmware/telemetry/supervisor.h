/* Watches the scanner's health, what scans say of the wheels, the network and the line to the motors, and
 * puts it into words: for ALE_STATUS always, for people only when it changes. Pure: health and time come in,
 * texts go out. */
#ifndef ALE_FIRMWARE_TELEMETRY_SUPERVISOR_H
#define ALE_FIRMWARE_TELEMETRY_SUPERVISOR_H

#include <stdbool.h>
#include <stdint.h>

#include "lcm/report.h"
#include "scanner/scanner.h"

typedef enum {
    ALE_LINK_UNKNOWN, /* just started */
    ALE_LINK_ABSENT,  /* no scanner, or none that answers */
    ALE_LINK_STREAMING
} ale_link_t;

typedef struct {
    ale_link_t link;
    char cause[sizeof((ale_scanner_health_t *)0)->status]; /* why there is no scanner, as it was last said */
    int64_t said_us;
    uint8_t wheel_fault; /* ale_wheel_fault_t */
    bool without_network;
    bool without_motors;
} ale_supervisor_t; /* all zero: just started */

enum { ALE_SUPERVISOR_LINE = 320 };

/* True when there is something to say: `line` then is one line for people. Said once per change; while there
 * is no scanner another cause is a change, too, at most every half minute. now_us: any clock. */
bool ale_supervisor_watch(ale_supervisor_t *supervisor, const ale_scanner_health_t *health, int64_t now_us,
                          char line[ALE_SUPERVISOR_LINE]);

/* The same for the wheels: ale_wheel_fault_t of the newest pose. */
bool ale_supervisor_watch_wheels(ale_supervisor_t *supervisor, uint8_t wheel_fault,
                                 char line[ALE_SUPERVISOR_LINE]);

/* The same for the network: has_route, whether there is a route for LCM's messages. */
bool ale_supervisor_watch_network(ale_supervisor_t *supervisor, bool has_route,
                                  char line[ALE_SUPERVISOR_LINE]);

/* The same for the line to the motor controller: its path, and how it is, as ale_port_strerror knows it. */
bool ale_supervisor_watch_motors(ale_supervisor_t *supervisor, const char *path, int status,
                                 char line[ALE_SUPERVISOR_LINE]);

/* Fills driver_state, device, scans and scan_period_us of the report. now_us: clock of the health. While
 * scans come, driver_state says what they say of the wheels, too: "streaming; wheels: stalled". */
void ale_supervisor_report(const ale_scanner_health_t *health, int64_t now_us, uint8_t wheel_fault,
                           ale_status_report_t *report);

#endif
