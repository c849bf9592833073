#include "system/persistence.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "exchange/snapshot.h"
#include "store/map_file.h"
#include "system/background.h"

enum { LOOK_NS = 500000000 };

typedef struct {
    ale_map_t map;
    ale_pose_t pose;
} kept_t;

struct ale_last_place {
    const char *path;
    ale_snapshot_t *offered; /* kept_t */
    ale_background_t thread;
    bool failed; /* and said so */
};

static void save_newest(ale_last_place_t *place)
{
    bool fresh = false;
    const kept_t *kept = ale_snapshot_newest(place->offered, &fresh);
    if (!fresh) {
        return;
    }
    char error[ALE_MAP_FILE_ERROR];
    const bool failed = ale_map_file_save_with_pose(place->path, &kept->map, &kept->pose, error) < 0;
    if (failed && !place->failed) {
        fprintf(stderr, "ale-slamd: map and pose are not kept: %s\n", error);
    }
    place->failed = failed;
}

static void run(ale_rt_task_t *self, void *user)
{
    ale_last_place_t *place = user;
    while (!ale_rt_task_stopping(self)) {
        ale_background_wait(&place->thread, LOOK_NS);
        save_newest(place);
    }
    save_newest(place);
}

ale_last_place_t *ale_last_place_start(const char *path)
{
    ale_last_place_t *place = calloc(1, sizeof *place);
    if (!place) {
        return NULL;
    }
    place->path = path;
    place->offered = ale_snapshot_create(sizeof(kept_t));
    if (!place->offered || ale_background_start(&place->thread, "ale-last-place", run, place, 0) < 0) {
        ale_last_place_stop(place);
        return NULL;
    }
    return place;
}

void ale_last_place_stop(ale_last_place_t *place)
{
    if (place) {
        ale_background_stop(&place->thread);
        ale_snapshot_destroy(place->offered);
        free(place);
    }
}

void ale_last_place_offer(ale_last_place_t *place, const ale_map_t *map, const ale_pose_t *pose)
{
    if (map->line_count == 0) {
        return; /* nothing in it could confirm the pose */
    }
    kept_t *kept = ale_snapshot_back(place->offered);
    kept->map = *map;
    kept->pose = *pose;
    ale_snapshot_publish(place->offered);
    ale_background_wake(&place->thread);
}
