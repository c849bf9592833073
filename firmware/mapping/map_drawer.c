#include "mapping/map_drawer.h"

#include <stdlib.h>

#include "base/fixed.h"
#include "graph/live_map.h"
#include "system/background.h"

#define LOOK_NS 50000000

enum { IDLE_PARTS = 9 }; /* of a drawing's time, before the next one */

struct ale_map_drawer {
    ale_exchange_t *exchange;
    ale_live_map_t *live;
    ale_background_t thread;
    uint32_t known_epoch; /* whose map, a loaded one, it draws on */
    bool changed;         /* since the last drawing */
    int64_t next_ns;
};

/* Whether the map that the observation was taken in, if it was loaded, is known. */
static bool knows_map_of(ale_map_drawer_t *drawer, const ale_scan_observation_t *observation)
{
    if (observation->loaded == 0 || observation->epoch == drawer->known_epoch) {
        return true;
    }
    bool fresh = false;
    const ale_loaded_map_t *known = ale_snapshot_newest(drawer->exchange->known_to_drawer, &fresh);
    if (known->number != observation->loaded ||
        ale_live_map_set_prior_map(drawer->live, observation->epoch, &known->map) < 0) {
        return false;
    }
    drawer->known_epoch = observation->epoch;
    return true;
}

/* A drawing without the walls that the drive began with would be published, and saved, as the whole: where
 * they are not known nothing is drawn, and the tracker's map is shown. */
static void add(ale_map_drawer_t *drawer, const ale_scan_observation_t *observation)
{
    if (knows_map_of(drawer, observation)) {
        ale_live_map_add(drawer->live, observation);
    }
}

static void take(ale_map_drawer_t *drawer)
{
    ale_ring_t *observations = drawer->exchange->observations;
    for (uint32_t ready = ale_ring_ready(observations); ready > 0; ready--) {
        add(drawer, ale_ring_at(observations, 0));
        ale_ring_release(observations);
        drawer->changed = true;
    }
}

/* What is drawn is the map that the robot is in: that of the last keyframe. */
static void name_map(ale_map_t *map, const ale_mapper_poses_t *poses)
{
    const uint32_t map_id = poses->count > 0 ? poses->pose[poses->count - 1].map_id : 0;
    for (uint16_t k = 0; k < map->line_count; k++) {
        map->line[k].map_id = map_id;
    }
}

static void draw(ale_map_drawer_t *drawer)
{
    ale_exchange_t *exchange = drawer->exchange;
    bool moved = false;
    const ale_mapper_poses_t *poses = ale_snapshot_newest(exchange->keyframe_poses, &moved);
    if (!drawer->changed && !moved) {
        return;
    }
    const int64_t start_ns = ale_rt_now_ns();
    ale_drawn_map_t *drawn = ale_snapshot_back(exchange->drawn_map);
    if (ale_live_map_build(drawer->live, poses, &drawn->map)) {
        name_map(&drawn->map, poses);
        drawn->epoch = poses->epoch;
        ale_snapshot_publish(exchange->drawn_map);
    }
    drawer->changed = false;
    const int64_t now_ns = ale_rt_now_ns();
    drawer->next_ns = now_ns + ale_max64(ALE_MAP_PERIOD_NS, IDLE_PARTS * (now_ns - start_ns));
}

static void run(ale_rt_task_t *self, void *user)
{
    ale_map_drawer_t *drawer = user;
    while (!ale_rt_task_stopping(self)) {
        take(drawer);
        if (ale_rt_now_ns() >= drawer->next_ns) {
            draw(drawer);
        }
        ale_background_wait(&drawer->thread, LOOK_NS);
    }
    take(drawer);
    draw(drawer);
}

ale_map_drawer_t *ale_map_drawer_start(ale_exchange_t *exchange)
{
    ale_map_drawer_t *drawer = calloc(1, sizeof *drawer);
    if (!drawer) {
        return NULL;
    }
    drawer->exchange = exchange;
    drawer->live = ale_live_map_create();
    if (!drawer->live ||
        ale_background_start(&drawer->thread, "ale-drawer", run, drawer, ALE_LIVE_MAP_HEAP_BYTES) < 0) {
        ale_map_drawer_stop(drawer);
        return NULL;
    }
    return drawer;
}

void ale_map_drawer_stop(ale_map_drawer_t *drawer)
{
    if (!drawer) {
        return;
    }
    ale_background_stop(&drawer->thread);
    ale_live_map_destroy(drawer->live);
    free(drawer);
}
