/* What the robot starts from: the map and pose it kept when it last ran, else the configured map, else
 * nothing. */
#ifndef ALE_FIRMWARE_MAPPING_START_MAP_H
#define ALE_FIRMWARE_MAPPING_START_MAP_H

#include "config/config.h"
#include "estimate/estimate.h"

/* Loads it, and says on stderr what was taken up. 0, or -1 when the configured map cannot be used: one line
 * has said why. A kept map that cannot be read is told and passed over: the robot must come up. Before the
 * task runs. */
int ale_start_map_load(const ale_config_t *config, ale_estimator_t *estimator);

#endif
