/* A laser scanner: opened once, stepped for ever, scans out. It finds its sensor, starts it, and recovers by
 * itself from whatever happens on the line.
 *
 *   ale_scanner_t *scanner = ale_scanner_open(&config);
 *   for (;;) switch (ale_scanner_step(scanner, &scan)) { case ALE_SCANNER_SCAN: ...; case
 * ALE_SCANNER_SCAN_LOST: ... }
 *
 * Each scan that the sensor sent comes out once, in order: as a scan or as a loss. One owner thread. */
#ifndef ALE_SCANNER_SCANNER_H
#define ALE_SCANNER_SCANNER_H

#include "base/scan.h"
#include "scanner/scanner_types.h"

typedef struct ale_scanner ale_scanner_t;

enum { ALE_SCANNER_NAMES = 64 };

/* Whether there is a family of that name; all of their names, in words; whether any scanner of theirs has
 * that rate, bit/s. */
bool ale_scanner_has_family(const char *name);
void ale_scanner_families(char names[ALE_SCANNER_NAMES]);
bool ale_scanner_has_baud(int32_t baud);

/* Makes the driver; the port is opened by the steps, so that a sensor may come later. What config points to
 * must outlive the scanner. NULL: out of memory, or no family of that name. */
ale_scanner_t *ale_scanner_open(const ale_scanner_config_t *config);

/* Goes on by one event; *scan is filled at SCAN and SCAN_LOST. Waits for at most step_ms; a step that has
 * something to say to the sensor, as at its start and after a fault, for 200 ms more where the line takes no
 * bytes. A step that opens the port (none is open then) takes and allocates what the system does for that;
 * the others allocate nothing. Cannot fail: what goes wrong stands in the health, and is tried again. */
ale_scanner_event_t ale_scanner_step(ale_scanner_t *scanner, ale_scan_t *scan);

/* State, identity and counters as of the last step. Valid until close. */
const ale_scanner_health_t *ale_scanner_health(const ale_scanner_t *scanner);

/* Stops the sensor (laser off), closes its port. NULL: nothing. */
void ale_scanner_close(ale_scanner_t *scanner);

#endif
