/* Keeps map and pose on disk while the robot runs, so that it goes on from there after a power cut.
 *
 *   telemetry ── ale_persistence_offer: newest map, pose ──► its thread ──► one file, whole or not at all
 *
 * The thread has no priority: disks take their time. NULL: nothing is kept. */
#ifndef ALE_FIRMWARE_MAPPING_PERSISTENCE_H
#define ALE_FIRMWARE_MAPPING_PERSISTENCE_H

#include <stdbool.h>

#include "track/pipeline.h"

typedef struct ale_persistence ale_persistence_t;

/* path must outlive it. NULL: out of memory, descriptors or threads. */
ale_persistence_t *ale_persistence_start(const char *path);

/* Writes what was offered last, if that is not on disk yet. */
void ale_persistence_stop(ale_persistence_t *persistence);

/* Telemetry thread; copies and never blocks. A map without walls is not kept: nothing in it could confirm the
 * pose. What is offered before the last was written takes its place. */
void ale_persistence_offer(ale_persistence_t *persistence, const ale_map_t *map, const ale_pose_t *pose);

#endif
