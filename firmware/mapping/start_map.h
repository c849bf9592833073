/* What the robot starts from: the map and pose it kept when it last ran, else the configured map, else
 * nothing. */
#ifndef ALE_FIRMWARE_MAPPING_START_MAP_H
#define ALE_FIRMWARE_MAPPING_START_MAP_H

#include "config/config.h"
#include "estimate/estimate.h"
#include "store/tile_loader.h"

/* Loads it, and says on stderr what was taken up. 0, or -1 when the configured map cannot be used: one line
 * has said why. A kept map that cannot be read is told and passed over: the robot must come up. Before the
 * task runs.
 *
 * A map of tiles goes before a kept one, which is a part of it as last seen: of what was kept the pose alone
 * counts. *tiles: its loader, the caller's to close; NULL: there is no map of tiles. */
int ale_start_map_load(const ale_config_t *config, ale_estimator_t *estimator, ale_tile_loader_t **tiles);

#endif
