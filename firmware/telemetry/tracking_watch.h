/* Puts into words for people when tracking changes: once a change, with its cause and what to do, never once
 * a scan. Pure: poses come in, texts go out. */
#ifndef ALE_FIRMWARE_TELEMETRY_TRACKING_WATCH_H
#define ALE_FIRMWARE_TELEMETRY_TRACKING_WATCH_H

#include <stdbool.h>
#include <stdint.h>

#include "track/estimate.h"

typedef enum {
    ALE_TRACKING_KNOWN,     /* in the first map */
    ALE_TRACKING_UNCERTAIN, /* in the first map, and the scan leaves a direction open */
    ALE_TRACKING_ASTRAY     /* lost, or in a map of its own */
} ale_tracking_situation_t;

/* All zero: no pose yet. Fields are private. */
typedef struct {
    ale_tracking_situation_t told;
    int64_t told_us;             /* when that began */
    ale_tracking_situation_t at; /* of the newest pose */
    int64_t at_us;               /* since when */
} ale_tracking_watch_t;

enum { ALE_TRACKING_LINE = 320 };

/* A pose, in the order of their stamps; lines: how many the scan shows, 0 without a scan. True: `line` is one
 * for people. At most two lines a second of stamps. O(1). */
bool ale_tracking_watch_take(ale_tracking_watch_t *watch, const ale_estimate_t *estimate, uint32_t lines,
                             char line[ALE_TRACKING_LINE]);

#endif
