#include "telemetry/supervisor.h"

#include <stdio.h>
#include <string.h>

#include "base/fixed.h"
#include "lcm/wheel_words.h"
#include "serial/port_status.h"

#define SILENT_US 1000000
#define OTHER_CAUSE_US 30000000

static const char *words_for(ale_scanner_state_t state)
{
    static const char *const words[] = {
        [ALE_SCANNER_CLOSED] = "no scanner",           [ALE_SCANNER_DETECTING] = "asking who is there",
        [ALE_SCANNER_STARTING] = "starting",           [ALE_SCANNER_STREAMING] = "streaming",
        [ALE_SCANNER_POLLING] = "asking scan by scan",
    };
    return words[state];
}

static ale_link_t link_of(const ale_scanner_health_t *health, ale_link_t before)
{
    switch (health->state) {
    case ALE_SCANNER_STREAMING:
    case ALE_SCANNER_POLLING:
        return health->scans > 0 ? ALE_LINK_STREAMING : before;
    case ALE_SCANNER_CLOSED:
        return health->status[0] ? ALE_LINK_ABSENT : before;
    case ALE_SCANNER_DETECTING:
    case ALE_SCANNER_STARTING:
        break;
    }
    return before;
}

static const char *or_unknown(const char *text)
{
    return text[0] ? text : "?";
}

/* Somebody who looks for what keeps the scanner away finds one cause, and then the next. */
static bool is_other_cause(const ale_supervisor_t *supervisor, const ale_scanner_health_t *health,
                           int64_t now_us)
{
    return health->state == ALE_SCANNER_CLOSED && strcmp(supervisor->cause, health->status) != 0 &&
           now_us - supervisor->said_us >= OTHER_CAUSE_US;
}

bool ale_supervisor_watch(ale_supervisor_t *supervisor, const ale_scanner_health_t *health, int64_t now_us,
                          char line[ALE_SUPERVISOR_LINE])
{
    const ale_link_t before = supervisor->link;
    const ale_link_t now = link_of(health, before);
    if (now == before && (now != ALE_LINK_ABSENT || !is_other_cause(supervisor, health, now_us))) {
        return false;
    }
    supervisor->link = now;
    if (now == ALE_LINK_STREAMING) {
        snprintf(line, ALE_SUPERVISOR_LINE, "scanner %s, serial number %s, at %s: streaming",
                 or_unknown(health->identity.model), or_unknown(health->identity.serial),
                 or_unknown(health->port));
    } else {
        snprintf(supervisor->cause, sizeof supervisor->cause, "%s", health->status);
        supervisor->said_us = now_us;
        snprintf(line, ALE_SUPERVISOR_LINE, "%s: %s; trying again until it is there",
                 before == ALE_LINK_STREAMING ? "scanner lost" : "no scanner", health->status);
    }
    return true;
}

bool ale_supervisor_watch_wheels(ale_supervisor_t *supervisor, uint8_t wheel_fault,
                                 char line[ALE_SUPERVISOR_LINE])
{
    if (supervisor->wheel_fault == wheel_fault) {
        return false;
    }
    supervisor->wheel_fault = wheel_fault;
    snprintf(line, ALE_SUPERVISOR_LINE, "wheels: %s", ale_wheel_fault_word(wheel_fault));
    return true;
}

bool ale_supervisor_watch_network(ale_supervisor_t *supervisor, bool has_route,
                                  char line[ALE_SUPERVISOR_LINE])
{
    if (supervisor->without_network == !has_route) {
        return false;
    }
    supervisor->without_network = !has_route;
    snprintf(
        line, ALE_SUPERVISOR_LINE, "%s",
        has_route
            ? "LCM: there is a route for multicast: joined"
            : "LCM: no route for multicast: going on without, nobody hears the poses; joining when there "
              "is a network (without one, as root: ip link set lo multicast on && ip route add "
              "224.0.0.0/4 dev lo)");
    return true;
}

bool ale_supervisor_watch_motors(ale_supervisor_t *supervisor, const char *path, int status,
                                 char line[ALE_SUPERVISOR_LINE])
{
    const bool without = status != ALE_PORT_OK;
    if (supervisor->without_motors == without) {
        return false;
    }
    supervisor->without_motors = without;
    if (without) {
        snprintf(line, ALE_SUPERVISOR_LINE,
                 "motor controller: %.200s: %s: nothing drives by this line; trying again", path,
                 ale_port_strerror(status));
    } else {
        snprintf(line, ALE_SUPERVISOR_LINE, "motor controller: %.200s: there again", path);
    }
    return true;
}

static void say_wheels(uint8_t wheel_fault, ale_status_report_t *report)
{
    if (wheel_fault != ALE_WHEELS_FINE) {
        const size_t length = strlen(report->driver_state);
        snprintf(report->driver_state + length, sizeof report->driver_state - length, "; wheels: %s",
                 ale_wheel_fault_word(wheel_fault));
    }
}

void ale_supervisor_report(const ale_scanner_health_t *health, int64_t now_us, uint8_t wheel_fault,
                           ale_status_report_t *report)
{
    const bool running = health->state == ALE_SCANNER_STREAMING || health->state == ALE_SCANNER_POLLING;
    const int64_t silence_us = ale_max64(SILENT_US, (int64_t)health->silence_ms * 1000);
    const bool silent = running && health->scans > 0 && now_us - health->last_scan_us > silence_us;
    const bool scans_come = running && !silent;
    const char *words = silent ? "silent" : words_for(health->state);
    snprintf(report->driver_state, sizeof report->driver_state, "%s%s%s", words, scans_come ? "" : ": ",
             scans_come ? "" : health->status);
    if (scans_come) {
        say_wheels(wheel_fault, report);
    }
    snprintf(report->device, sizeof report->device, "%s %s", health->identity.model, health->identity.serial);
    report->scans = (uint32_t)(health->scans + health->scans_lost);
    report->scan_period_us = scans_come ? health->scan_period_us : 0;
}
