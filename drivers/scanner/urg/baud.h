/* Rates of the serial line: in which order to try them, and what of a scan fits through. Pure functions. */
#ifndef ALE_SCANNER_URG_BAUD_H
#define ALE_SCANNER_URG_BAUD_H

#include <stdbool.h>
#include <stdint.h>

#include "scanner/urg/scip_request.h"

enum { ALE_BAUD_RATES = 8, ALE_BAUD_FACTORY = 19200, ALE_BAUD_USUAL = 115200 };

/* The attempt-th rate to try, 0 .. ALE_BAUD_RATES-1, beginning with `preferred` (0: the usual one). */
int32_t ale_baud_candidate(int32_t preferred, uint32_t attempt);

/* Whether a scanner may have this rate. */
bool ale_baud_is_known(int32_t baud);

/* Time that `bytes` take on the line (8N1: ten bits each). */
int64_t ale_baud_time_us(int32_t baud, uint32_t bytes);

/* Fits a stream to the line: with the coding, cluster and skip wished for in `request` as the least,
 * takes the first of MD, MS, MD with cluster 2, MS with cluster 2 that passes within (skip + 1) turns with a
 * margin of 5 %, for the least skip. A request that nothing can fit ends at skip 9, cluster 2, MS. */
void ale_baud_fit(ale_scip_request_t *request, int32_t baud, int32_t period_us);

#endif
