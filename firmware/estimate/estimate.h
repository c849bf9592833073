/* The estimate task: odometry and scans in, one result for every scan out; hard real time.
 *
 * Between its release and its wait it takes no lock, allocates nothing and makes no system call. When scans
 * queue up the newest count: those behind which more than ALE_MAX_BACKLOG wait are answered by
 * prediction and counted. */
#ifndef ALE_FIRMWARE_ESTIMATE_ESTIMATE_H
#define ALE_FIRMWARE_ESTIMATE_ESTIMATE_H

#include "config/config.h"
#include "exchange/exchange.h"

/* Scans that are still worked off in their order: together they cost a fraction of one turn of the scanner.
 */
enum { ALE_MAX_BACKLOG = 4 };

/* A scan is answered late when its result comes a turn of the scanner after its last byte. */
enum { ALE_DEADLINE_US = 100000 };

typedef struct ale_estimator ale_estimator_t;

/* The pipeline in memory of its own. NULL: out of memory, or the configuration is refused by the pipeline. */
ale_estimator_t *ale_estimator_create(const ale_config_t *config, ale_exchange_t *exchange);
void ale_estimator_destroy(ale_estimator_t *estimator);

/* What the computer was too slow for, since the start; when the task no longer runs. */
typedef struct {
    uint32_t scans; /* answered in all */
    uint32_t overloaded;
    uint32_t corrections_late; /* of the map, taken at a later scan than the one that they name */
    uint32_t tiles_late;       /* pieces of it that came after that */
} ale_shortfall_t;

ale_shortfall_t ale_estimator_shortfall(const ale_estimator_t *estimator);

/* Before the task runs: a known map to start from. pose: where the robot is in it; NULL: that is to be found.
 */
void ale_estimator_load_map(ale_estimator_t *estimator, const ale_map_t *map, const ale_pose_t *pose);

/* The same for a map of tiles, which the tile loader reads as the robot says where it is. */
void ale_estimator_load_tiles(ale_estimator_t *estimator, const ale_pose_t *pose);

/* One release's work: all that lies in the rings now. Bounded by their capacities. */
void ale_estimator_step(ale_estimator_t *estimator);

/* The task's body: waits and steps until it is stopped. user: the estimator. */
void ale_estimator_run(ale_rt_task_t *self, void *user);

#endif
