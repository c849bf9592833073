/* Whichever family answers on the line: each is tried in turn, the one that only listens first, until scans
 * come. The one that was found stays, as long as it is not silent for long. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scanner/connection.h"
#include "scanner/scanner_family.h"

enum {
    PATIENCE_US = 8000000, /* with one family, also while the port is not there */
    LOYALTY_US = 10000000  /* to the one that was found, without a scan */
};

static const ale_scanner_family_t *const FAMILIES[] = {&ale_scanner_ldrobot, &ale_scanner_urg,
                                                       &ale_scanner_rplidar};

enum { FAMILY_COUNT = sizeof FAMILIES / sizeof FAMILIES[0] };

typedef struct {
    ale_scanner_t scanner; /* first */
    ale_scanner_config_t config;
    ale_connection_t clock; /* never opened: the config's clock alone */
    ale_scanner_t *inner;   /* the family at work; NULL: no memory for it yet */
    unsigned family;
    bool found;
    int64_t since_us; /* of the last scan, or the beginning with this family */
} auto_t;

static void start(auto_t *a, unsigned family)
{
    a->family = family;
    a->found = false;
    a->since_us = ale_connection_now_us(&a->clock);
    a->inner = FAMILIES[family]->open(&a->config);
}

static void next_family(auto_t *a)
{
    if (a->inner != NULL) {
        a->inner->family->close(a->inner);
    }
    start(a, (a->family + 1) % FAMILY_COUNT);
}

/* This family does not find its scanner here. */
static bool has_failed(const auto_t *a)
{
    const ale_scanner_health_t *health = a->inner->family->health(a->inner);
    const int64_t waited_us = ale_connection_now_us(&a->clock) - a->since_us;
    if (a->found) {
        return waited_us > LOYALTY_US;
    }
    return health->reopens >= FAMILIES[a->family]->tries || waited_us > PATIENCE_US;
}

static ale_scanner_event_t step(ale_scanner_t *scanner, ale_scan_t *scan)
{
    auto_t *a = (auto_t *)scanner;
    if (a->inner == NULL || has_failed(a)) {
        next_family(a);
        return ALE_SCANNER_IDLE;
    }
    const ale_scanner_event_t event = a->inner->family->step(a->inner, scan);
    if (event == ALE_SCANNER_SCAN) {
        a->found = true;
        a->since_us = ale_connection_now_us(&a->clock);
    }
    return event;
}

static const ale_scanner_health_t *health(const ale_scanner_t *scanner)
{
    static const ale_scanner_health_t none;
    const auto_t *a = (const auto_t *)scanner;
    return a->inner != NULL ? a->inner->family->health(a->inner) : &none;
}

static ale_scanner_t *open_scanner(const ale_scanner_config_t *config)
{
    auto_t *a = calloc(1, sizeof *a);
    if (a == NULL) {
        return NULL;
    }
    a->scanner.family = &ale_scanner_auto;
    a->config = *config;
    ale_connection_init(&a->clock, &a->config);
    start(a, 0);
    return &a->scanner;
}

static void close_scanner(ale_scanner_t *scanner)
{
    auto_t *a = (auto_t *)scanner;
    if (a->inner != NULL) {
        a->inner->family->close(a->inner);
    }
    free(a);
}

static bool has_baud(int32_t baud)
{
    (void)baud;
    return false;
}

const ale_scanner_family_t ale_scanner_auto = {.name = "auto",
                                               .has_baud = has_baud,
                                               .open = open_scanner,
                                               .step = step,
                                               .health = health,
                                               .close = close_scanner};
