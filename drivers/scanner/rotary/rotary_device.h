/* A rotary scanner over a serial port, whatever its protocol: port, time, turns, recovery and health. A
 * family is a protocol and these four functions; they keep what scanner.h promises of their namesakes. */
#ifndef ALE_SCANNER_ROTARY_DEVICE_H
#define ALE_SCANNER_ROTARY_DEVICE_H

#include "scanner/rotary/protocol.h"
#include "scanner/scanner_family.h"

/* Both tables must stay. */
ale_scanner_t *ale_rotary_open(const ale_scanner_family_t *family, const ale_rotary_protocol_t *protocol,
                               const ale_scanner_config_t *config);
ale_scanner_event_t ale_rotary_step(ale_scanner_t *scanner, ale_scan_t *scan);
const ale_scanner_health_t *ale_rotary_health(const ale_scanner_t *scanner);
void ale_rotary_close(ale_scanner_t *scanner);

#endif
