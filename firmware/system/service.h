/* What systemd is told (sd_notify's protocol): ready, stopping, a line of status, and that the estimate task
 * goes on.
 *
 * The watchdog is fed by progress alone: when the task that makes the poses hangs, systemd restarts the
 * robot's firmware, however lively everything else is. Without systemd ($NOTIFY_SOCKET) all of it does
 * nothing. Never blocks. One thread a structure. */
#ifndef ALE_FIRMWARE_SYSTEM_SERVICE_H
#define ALE_FIRMWARE_SYSTEM_SERVICE_H

#include <stdint.h>
#include <sys/socket.h>
#include <sys/un.h>

typedef struct {
    int socket; /* -1: nobody listens */
    struct sockaddr_un address;
    socklen_t address_bytes;
    int64_t feed_period_ns; /* 0: no watchdog */
    int64_t next_feed_ns;
    uint32_t progress; /* when the watchdog was fed last */
} ale_service_t;

/* From $NOTIFY_SOCKET and $WATCHDOG_USEC. */
void ale_service_open(ale_service_t *service);
void ale_service_close(ale_service_t *service);

/* "READY=1", "STOPPING=1", "STATUS=words for people". */
void ale_service_tell(const ale_service_t *service, const char *text);

/* Feeds the watchdog, four times as often as it asks, if progress has changed since the last time. Call at
 * least once a second. */
void ale_service_feed(ale_service_t *service, uint32_t progress, int64_t now_ns);

#endif
