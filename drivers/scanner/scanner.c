#include "scanner/scanner.h"

#include <stdio.h>
#include <string.h>

#include "scanner/scanner_family.h"

static const ale_scanner_family_t *const FAMILIES[] = {&ale_scanner_urg, &ale_scanner_ldrobot,
                                                       &ale_scanner_rplidar, &ale_scanner_auto};

enum { FAMILY_COUNT = sizeof FAMILIES / sizeof FAMILIES[0] };

static const ale_scanner_family_t *family_named(const char *name)
{
    for (unsigned k = 0; k < FAMILY_COUNT; k++) {
        if (strcmp(FAMILIES[k]->name, name) == 0) {
            return FAMILIES[k];
        }
    }
    return NULL;
}

bool ale_scanner_has_family(const char *name)
{
    return family_named(name) != NULL;
}

void ale_scanner_families(char names[ALE_SCANNER_NAMES])
{
    int used = 0;
    for (unsigned k = 0; k < FAMILY_COUNT && used < ALE_SCANNER_NAMES; k++) {
        used += snprintf(names + used, (size_t)(ALE_SCANNER_NAMES - used), "%s%s", k > 0 ? ", " : "",
                         FAMILIES[k]->name);
    }
}

bool ale_scanner_has_baud(int32_t baud)
{
    for (unsigned k = 0; k < FAMILY_COUNT; k++) {
        if (FAMILIES[k]->has_baud(baud)) {
            return true;
        }
    }
    return false;
}

ale_scanner_t *ale_scanner_open(const ale_scanner_config_t *config)
{
    const ale_scanner_family_t *family =
        config->family != NULL ? family_named(config->family) : &ale_scanner_urg;
    return family != NULL ? family->open(config) : NULL;
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
