/* What the sensor says of itself: the lines of VV, PP, II (SCIP 2.0) and V (1.1), read by their keys. Unknown
 * lines are ignored, wrong ones counted: no unit is refused for how it introduces itself. Pure functions. */
#ifndef ALE_SCANNER_URG_IDENTITY_H
#define ALE_SCANNER_URG_IDENTITY_H

#include <stdbool.h>
#include <stdint.h>

#include "scanner/scanner_types.h"
#include "scanner/urg/played.h"

typedef struct {
    int32_t range_min_mm;   /* DMIN */
    int32_t range_max_mm;   /* DMAX */
    int32_t steps_per_turn; /* ARES */
    int32_t first_step;     /* AMIN */
    int32_t last_step;      /* AMAX */
    int32_t front_step;     /* AFRT */
    int32_t rpm;            /* SCAN */
} ale_urg_geometry_t;

typedef struct {
    ale_scanner_identity_t device; /* MODL, or PROD until that is known; FIRM; SERI */
    char status[128];              /* STAT */
    ale_urg_geometry_t geometry;
    ale_urg_played_t played; /* PLAY; all zero: this is no recording */
    uint32_t warnings;       /* lines with a wrong sum or an unreadable value */
} ale_urg_identity_t;

/* Empty texts and the geometry of the URG-04LX's data sheet. */
void ale_urg_identity_init(ale_urg_identity_t *identity);

/* Takes one line without ";" and sum. A line whose sum is wrong changes no number, but its text is shown. */
void ale_urg_identity_line(ale_urg_identity_t *identity, const char *text, bool sum_right);

/* The numbers can belong to a scanner, and to the buffers of this program. */
bool ale_urg_geometry_valid(const ale_urg_geometry_t *geometry);

/* Time of one turn of the motor. */
int32_t ale_urg_period_us(const ale_urg_geometry_t *geometry);

#endif
