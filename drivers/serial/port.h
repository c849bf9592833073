/* A serial port: open, read, write, wait, close. Three back ends behind one interface: libserialport for
 * real ports, a bare descriptor (termios and poll) for pseudo terminals, which libserialport refuses, and a
 * TCP connection for scanners on Ethernet ("tcp:192.168.0.10:10940").
 *
 * One owner thread. Calls retry on EINTR. A port that is gone stays gone until it is closed and opened
 * again: ALE_PORT_GONE means close at once (the device node's number stays taken while it is open). */
#ifndef ALE_SERIAL_PORT_H
#define ALE_SERIAL_PORT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "serial/port_status.h"

typedef struct ale_port ale_port_t;
struct ale_port_backend; /* serial/port_backend.h */

/* Opens path (links are resolved) exclusively, raw, 8N1, no flow control, DTR untouched. ALE_PORT_OK and
 * *out, the caller's to close; else *out is NULL and the status ALE_PORT_ABSENT, DENIED, BUSY (and nothing
 * was done to the port), FILE, FOLDER, OTHER, BAUD (baud is not possible there), of "tcp:" ADDRESS, REFUSED,
 * UNREACHED, UNANSWERED (within a second), or GONE (any other error, and no memory). */
int ale_port_open(ale_port_t **out, const char *path, int32_t baud);

/* Changes the rate, bit/s. ALE_PORT_OK, or ALE_PORT_BAUD: the rate is as it was. */
int ale_port_set_baud(ale_port_t *port, int32_t baud);

/* Bytes read now without waiting, at most capacity; 0 when there are none; or a negative status,
 * ALE_PORT_GONE as a rule. */
int ale_port_read(ale_port_t *port, uint8_t *bytes, size_t capacity);

/* Writes all of the bytes. ALE_PORT_OK; ALE_PORT_TIMEOUT: some of them did not go within timeout_ms, how many
 * is not known; or another negative status, ALE_PORT_GONE as a rule. */
int ale_port_write(ale_port_t *port, const uint8_t *bytes, size_t count, int32_t timeout_ms);

/* Waits for bytes: 1 readable, 0 nothing within timeout_ms, or ALE_PORT_GONE; some kernels call a port
 * readable that has hung up, reading then tells. port NULL: only lets the time pass. */
int ale_port_wait(ale_port_t *port, int32_t timeout_ms);

/* True when a change of the rate has an effect (a real RS-232 port); false for pseudo terminals and USB. */
bool ale_port_has_baud(const ale_port_t *port);

/* Sets the line DTR, on which the motor of some scanners hangs. ALE_PORT_OK, or ALE_PORT_OTHER: the port has
 * none, as a pseudo terminal. */
int ale_port_set_dtr(ale_port_t *port, bool on);

/* NULL: nothing. */
void ale_port_close(ale_port_t *port);

enum { ALE_PORT_WORDS = 100 };

/* Why a path could not be opened, in words of one line; where another program holds it, which one. */
void ale_port_explain(int status, const char *path, char words[ALE_PORT_WORDS]);

/* A back end from above drivers/ that serves the paths which begin with prefix ("name:"); it is given what
 * follows. Once, before the first port is opened; both must stay. */
void ale_port_offer(const char *prefix, const struct ale_port_backend *backend);

#endif
