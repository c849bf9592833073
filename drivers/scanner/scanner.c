#include "scanner/scanner.h"

#include <string.h>

#include "scanner/scanner_family.h"

static const ale_scanner_family_t *const FAMILIES[] = {&ale_scanner_urg};

ale_scanner_t *ale_scanner_open(const ale_scanner_config_t *config)
{
    const char *name = config->family != NULL ? config->family : FAMILIES[0]->name;
    for (unsigned k = 0; k < sizeof FAMILIES / sizeof FAMILIES[0]; k++) {
        if (strcmp(FAMILIES[k]->name, name) == 0) {
            return FAMILIES[k]->open(config);
        }
    }
    return NULL;
}

ale_scanner_event_t ale_scanner_step(ale_scanner_t *scanner, ale_scan_t *scan)
{
    return scanner->family->step(scanner, scan);
}

const ale_scanner_health_t *ale_scanner_health(const ale_scanner_t *scanner)
{
    return scanner->family->health(scanner);
}

void ale_scanner_close(ale_scanner_t *scanner)
{
    if (scanner != NULL) {
        scanner->family->close(scanner);
    }
}
