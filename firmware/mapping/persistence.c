#include "mapping/persistence.h"

#include <stdlib.h>
#include <string.h>

#include "exchange/snapshot.h"
#include "store/map_file.h"
#include "system/background.h"
#include "system/log_line.h"

enum { LOOK_NS = 500000000 };

typedef struct {
    ale_map_t map;
    ale_pose_t pose;
} kept_t;

struct ale_persistence {
    const char *path;
    ale_snapshot_t *offered; /* kept_t */
    ale_background_t thread;
    bool failed; /* and said so */
};

static void save_newest(ale_persistence_t *persistence)
{
    bool fresh = false;
    const kept_t *kept = ale_snapshot_newest(persistence->offered, &fresh);
    if (!fresh) {
        return;
    }
    char error[ALE_MAP_FILE_ERROR];
    const bool failed = ale_map_file_save_with_pose(persistence->path, &kept->map, &kept->pose, error) < 0;
    if (failed && !persistence->failed) {
        ale_log_line("map and pose are not kept: %s; it is tried again", error);
    } else if (persistence->failed && !failed) {
        ale_log_line("map and pose are kept again");
    }
    persistence->failed = failed;
}

static void run(ale_rt_task_t *self, void *user)
{
    ale_persistence_t *persistence = user;
    while (!ale_rt_task_stopping(self)) {
        ale_background_wait(&persistence->thread, LOOK_NS);
        save_newest(persistence);
    }
    save_newest(persistence);
}

ale_persistence_t *ale_persistence_start(const char *path)
{
    ale_persistence_t *persistence = calloc(1, sizeof *persistence);
    if (!persistence) {
        return NULL;
    }
    persistence->path = path;
    persistence->offered = ale_snapshot_create(sizeof(kept_t));
    if (!persistence->offered ||
        ale_background_start(&persistence->thread, "ale-persistence", run, persistence, 0) < 0) {
        ale_persistence_stop(persistence);
        return NULL;
    }
    return persistence;
}

void ale_persistence_stop(ale_persistence_t *persistence)
{
    if (persistence) {
        ale_background_stop(&persistence->thread);
        ale_snapshot_destroy(persistence->offered);
        free(persistence);
    }
}

void ale_persistence_offer(ale_persistence_t *persistence, const ale_map_t *map, const ale_pose_t *pose)
{
    if (map->line_count == 0) {
        return; /* nothing in it could confirm the pose */
    }
    kept_t *kept = ale_snapshot_back(persistence->offered);
    kept->map = *map;
    kept->pose = *pose;
    ale_snapshot_publish(persistence->offered);
    ale_background_wake(&persistence->thread);
}
