/* What stands in for the rotary device: it takes a family's protocol as it is opened, and gives it bytes. */
#ifndef ALE_PROOFS_EVA_UNKNOWN_PROTOCOL_H
#define ALE_PROOFS_EVA_UNKNOWN_PROTOCOL_H

#include "scanner/rotary/rotary_device.h"
#include "scanner/scanner_family.h"
#include "unknown.h"

static const ale_rotary_protocol_t *protocol_of_family;

ale_scanner_t *ale_rotary_open(const ale_scanner_family_t *family, const ale_rotary_protocol_t *protocol,
                               const ale_scanner_config_t *config)
{
    (void)config;
    static ale_scanner_t scanner;
    scanner.family = family;
    protocol_of_family = protocol;
    return &scanner;
}

ale_scanner_event_t ale_rotary_step(ale_scanner_t *scanner, ale_scan_t *scan)
{
    (void)scanner;
    (void)scan;
    return ALE_SCANNER_IDLE;
}

const ale_scanner_health_t *ale_rotary_health(const ale_scanner_t *scanner)
{
    (void)scanner;
    return NULL;
}

void ale_rotary_close(ale_scanner_t *scanner)
{
    (void)scanner;
}

#endif
