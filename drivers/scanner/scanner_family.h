/* What a family of scanners provides: one table of functions; for drivers/scanner only. */
#ifndef ALE_SCANNER_SCANNER_FAMILY_H
#define ALE_SCANNER_SCANNER_FAMILY_H

#include "base/scan.h"
#include "scanner/scanner_types.h"

typedef struct ale_scanner ale_scanner_t;

/* The functions keep what scanner.h promises of their namesakes. */
typedef struct {
    const char *name;
    uint32_t tries;                 /* times that it opens a port until it has tried all of its rates */
    bool (*has_baud)(int32_t baud); /* a scanner of this family may have that rate */
    ale_scanner_t *(*open)(const ale_scanner_config_t *config);
    ale_scanner_event_t (*step)(ale_scanner_t *scanner, ale_scan_t *scan);
    const ale_scanner_health_t *(*health)(const ale_scanner_t *scanner);
    void (*close)(ale_scanner_t *scanner);
} ale_scanner_family_t;

/* First member of the structure that a family's open returns. */
struct ale_scanner {
    const ale_scanner_family_t *family;
};

extern const ale_scanner_family_t ale_scanner_urg;     /* scanner/urg */
extern const ale_scanner_family_t ale_scanner_ldrobot; /* scanner/ldrobot */
extern const ale_scanner_family_t ale_scanner_rplidar; /* scanner/rplidar */
extern const ale_scanner_family_t ale_scanner_auto;    /* auto.c: whichever answers */

#endif
