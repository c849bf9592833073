/* What a back end of the serial port provides; for drivers/serial only. */
#ifndef ALE_SERIAL_PORT_BACKEND_H
#define ALE_SERIAL_PORT_BACKEND_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "serial/port_status.h"

typedef struct ale_port ale_port_t;

typedef struct ale_port_backend {
    /* Opens the real path (no link) raw, 8N1, without flow control; sets port->fd, which poll can wait for.
     */
    int (*open)(ale_port_t *port, const char *real_path, int32_t baud);
    int (*set_baud)(ale_port_t *port, int32_t baud);
    /* One call each: bytes moved, 0 when none can be now, or a negative ale_port_status_t. */
    int (*read)(ale_port_t *port, uint8_t *bytes, size_t capacity);
    int (*write)(ale_port_t *port, const uint8_t *bytes, size_t count);
    void (*close)(ale_port_t *port);
    /* Waits for events (POLLIN, POLLOUT) as poll does: those that came, 0 at the end of the time, -1 with
     * errno. NULL: poll on port->fd. */
    int (*wait)(ale_port_t *port, short events, int32_t timeout_ms);
} ale_port_backend_t;

struct ale_port {
    const ale_port_backend_t *backend;
    int fd;
    int lock;     /* holds the port for this process; -1: the back end does */
    void *handle; /* of the back end */
    bool has_baud;
};

extern const ale_port_backend_t ale_port_fd_backend;
extern const ale_port_backend_t ale_port_libserialport_backend;
extern const ale_port_backend_t ale_port_tcp_backend; /* its path: address and port */

/* Sets any rate, also those without a constant (Linux: termios2, BOTHER). 0, or ALE_PORT_BAUD. */
int ale_port_set_any_baud(int fd, int32_t baud);

#endif
