/* The thread that draws the map anew (lib/graph/live_map), like any program: what scans have shown comes from
 * the estimate task, where keyframes now lie from the mapper; the drawing goes to telemetry, which publishes
 * and saves it.
 *
 * Matching goes on by the tracker's own map. A drawing of a large map may take a second; nobody waits for it.
 * One is made when something has changed, a second after the last one at the earliest, and no more often than
 * keeps the thread idle nine tenths of the time. */
#ifndef ALE_FIRMWARE_MAPPING_MAP_DRAWER_H
#define ALE_FIRMWARE_MAPPING_MAP_DRAWER_H

#include "exchange/exchange.h"

typedef struct ale_map_drawer ale_map_drawer_t;

/* exchange must outlive it. NULL: out of memory or threads. */
ale_map_drawer_t *ale_map_drawer_start(ale_exchange_t *exchange);

/* Draws what has come since the last drawing, then stops. NULL: nothing. */
void ale_map_drawer_stop(ale_map_drawer_t *drawer);

#endif
