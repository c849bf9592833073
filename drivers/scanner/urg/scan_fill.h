/* Values of a reply as a scan: bearings, flags, and the time of every beam. Pure function. */
#ifndef ALE_SCANNER_URG_SCAN_FILL_H
#define ALE_SCANNER_URG_SCAN_FILL_H

#include <stdbool.h>
#include <stdint.h>

#include "base/scan.h"
#include "scanner/urg/identity.h"
#include "scanner/urg/scip_parse.h"

/* event: a SCAN of the parser. stamp_us: host time of the moment the beam passes step 0; the scan's stamp_us
 * is that of stamp_beam, a fraction of a beam later when a cluster makes the beams coarser than that. A beam
 * of a cluster looks from the middle of its steps. period_us: of one turn. reversed: bearings negated. */
void ale_urg_fill_scan(const ale_urg_geometry_t *geometry, const ale_scip_event_t *event, int64_t stamp_us,
                       int32_t period_us, bool reversed, ale_scan_t *scan);

#endif
