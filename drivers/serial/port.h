/* A serial port: open, read, write, wait, close. Two back ends behind one interface: libserialport for
 * real ports, a bare descriptor (termios and poll) for pseudo terminals, which libserialport refuses.
 *
 * One owner thread. Calls retry on EINTR. A port that is gone stays gone until it is closed and opened
 * again: ALE_PORT_GONE means close at once (the device node's number stays taken while it is open). */
#ifndef ALE_SERIAL_PORT_H
#define ALE_SERIAL_PORT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef enum {
    ALE_PORT_OK = 0,
    ALE_PORT_GONE = -1,   /* unplugged, hung up, I/O error */
    ALE_PORT_DENIED = -2, /* no permission, or another program holds it */
    ALE_PORT_ABSENT = -3, /* no such device */
    ALE_PORT_BAUD = -4,   /* rate not possible on this port */
    ALE_PORT_TIMEOUT = -5,
    ALE_PORT_FILE = -6, /* the path is an ordinary file, */
    ALE_PORT_FOLDER = -7,
    ALE_PORT_OTHER = -8 /* or no terminal */
} ale_port_status_t;

typedef struct ale_port ale_port_t;

/* Opens path (links are resolved) exclusively, raw, 8N1, no flow control, DTR untouched.
 * On failure returns a negative ale_port_status_t and *out is NULL. */
int ale_port_open(ale_port_t **out, const char *path, int32_t baud);
int ale_port_set_baud(ale_port_t *port, int32_t baud);
/* Bytes read now without waiting, 0 when there are none, or a negative status. */
int ale_port_read(ale_port_t *port, uint8_t *bytes, size_t capacity);
/* All of the bytes within timeout_ms, or a negative status. */
int ale_port_write(ale_port_t *port, const uint8_t *bytes, size_t count, int32_t timeout_ms);
/* Waits for bytes: 1 readable, 0 time-out, negative status; some kernels call a port readable that has hung
 * up, reading then tells. port NULL: only lets the time pass. */
int ale_port_wait(ale_port_t *port, int32_t timeout_ms);
/* True when a change of the rate has an effect (a real RS-232 port); false for pseudo terminals and USB. */
bool ale_port_has_baud(const ale_port_t *port);
void ale_port_close(ale_port_t *port);
const char *ale_port_strerror(int status);

#endif
