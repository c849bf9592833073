/* Maps on disk, for the telemetry thread: a thread of its own saves and loads, because disks block.
 *
 *   ale_map_storage_save(storage, "kitchen", map);           (or _load; false: busy with another)
 *   ... descriptor `under_way` of the exchange wakes telemetry ...
 *   if (ale_map_storage_done(storage, &outcome)) ... outcome.text says what came of it ...
 *
 * A loaded map lies in the snapshot `loaded_map` of the exchange, for the estimate task. One job at a time.
 */
#ifndef ALE_FIRMWARE_MAPPING_MAP_STORAGE_H
#define ALE_FIRMWARE_MAPPING_MAP_STORAGE_H

#include <stdbool.h>

#include "config/config.h"
#include "exchange/exchange.h"
#include "lcm/report.h"

typedef struct ale_map_storage ale_map_storage_t;

typedef struct {
    bool loaded; /* a map was loaded, not saved */
    bool fine;
    char text[ALE_ANSWER_BYTES];
} ale_map_outcome_t;

/* NULL: out of memory or threads. config and exchange must outlive it. */
ale_map_storage_t *ale_map_storage_start(const ale_config_t *config, ale_exchange_t *exchange);

/* Ends the job that is under way, then stops. NULL: nothing. */
void ale_map_storage_stop(ale_map_storage_t *storage);

/* name: one for which ale_is_name holds; the file is NAME.map in map.folder, which is made when it is not
 * there. The map is copied. False: busy. */
bool ale_map_storage_save(ale_map_storage_t *storage, const char *name, const ale_map_t *map);
bool ale_map_storage_load(ale_map_storage_t *storage, const char *name);

/* True once for each job, when it is done. */
bool ale_map_storage_done(ale_map_storage_t *storage, ale_map_outcome_t *outcome);

#endif
