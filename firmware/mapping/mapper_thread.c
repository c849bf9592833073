#include "mapping/mapper_thread.h"

#include <stdlib.h>

#include "graph/mapper.h"
#include "system/background.h"
#include "system/log_line.h"

#define LOOK_US 20000 /* of the robot's clock: a correction is due a few scans after its keyframe */

struct ale_mapper_thread {
    ale_exchange_t *exchange;
    ale_mapper_t *mapper;
    ale_background_t thread;
    uint32_t loops;       /* told so far */
    uint32_t known_epoch; /* whose map, a loaded one, the mapper knows */
};

static void tell(ale_mapper_thread_t *thread, int64_t spent_ns)
{
    const ale_mapper_statistics_t statistics = ale_mapper_statistics(thread->mapper);
    if (statistics.loops != thread->loops) {
        ale_log_line("loop closed: %u so far, %u keyframes, %lld ms", statistics.loops, statistics.keyframes,
                     (long long)(spent_ns / 1000000));
        thread->loops = statistics.loops;
    }
}

/* Without room in the rings the correction is kept, and grows, until the next keyframe. Exploration hears of
 * it first: it waits for the estimate that knows it. */
static void hand_out(ale_mapper_thread_t *thread)
{
    ale_exchange_t *exchange = thread->exchange;
    ale_correction_t *slot = ale_ring_reserve(exchange->corrections);
    ale_correction_t *copy = exchange->explore ? ale_ring_reserve(exchange->grid_corrections) : NULL;
    if (!slot || (exchange->explore && !copy) || !ale_mapper_correction(thread->mapper, slot)) {
        return;
    }
    if (copy) {
        *copy = *slot;
        ale_ring_commit(exchange->grid_corrections);
    }
    ale_ring_commit(exchange->corrections);
}

/* Where keyframes lie now, for the one who draws the map. */
static void show_poses(ale_mapper_thread_t *thread)
{
    ale_mapper_poses(thread->mapper, ale_snapshot_back(thread->exchange->keyframe_poses));
    ale_snapshot_publish(thread->exchange->keyframe_poses);
}

/* And what ties them, for everybody outside. Without memory for it they go on seeing the graph of before. */
static void show_graph(ale_mapper_thread_t *thread)
{
    if (ale_mapper_graph(thread->mapper, ale_snapshot_back(thread->exchange->graph))) {
        ale_snapshot_publish(thread->exchange->graph);
    }
}

/* Whether the map that the keyframe was taken in, if it was loaded, is known. */
static bool knows_map_of(ale_mapper_thread_t *thread, const ale_keyframe_t *keyframe)
{
    if (keyframe->loaded == 0 || keyframe->loaded == ALE_LOADED_TILES ||
        keyframe->epoch == thread->known_epoch) {
        return true; /* tiles the mapper knows as they come */
    }
    bool fresh = false;
    const ale_loaded_map_t *known = ale_snapshot_newest(thread->exchange->known_to_mapper, &fresh);
    if (known->number != keyframe->loaded ||
        ale_mapper_set_prior_map(thread->mapper, keyframe->epoch, &known->map) < 0) {
        return false;
    }
    thread->known_epoch = keyframe->epoch;
    return true;
}

/* Without the map of a drive that began in one there would be loops to itself only, and not to the map:
 * such keyframes are left out, until there is memory for it or the newer map is driven in. */
static void add(ale_mapper_thread_t *thread, const ale_keyframe_t *keyframe)
{
    if (knows_map_of(thread, keyframe) && ale_mapper_add(thread->mapper, keyframe) < 0) {
        thread->known_epoch = 0; /* forgotten with the graph */
    }
}

/* Without memory for a piece there are fewer walls to be held by. */
static void take_tiles(ale_mapper_thread_t *thread)
{
    ale_ring_t *tiles = thread->exchange->tiles_to_mapper;
    for (uint32_t ready = ale_ring_ready(tiles); ready > 0; ready--) {
        ale_mapper_change_tiles(thread->mapper, ale_ring_at(tiles, 0));
        ale_ring_release(tiles);
    }
}

static void work_off(ale_mapper_thread_t *thread)
{
    ale_ring_t *keyframes = thread->exchange->keyframes;
    take_tiles(thread);
    for (uint32_t ready = ale_ring_ready(keyframes); ready > 0; ready--) {
        const int64_t start_ns = ale_rt_now_ns();
        add(thread, ale_ring_at(keyframes, 0));
        ale_ring_release(keyframes);
        hand_out(thread);
        show_poses(thread);
        show_graph(thread);
        tell(thread, ale_rt_now_ns() - start_ns);
    }
}

static void run(ale_rt_task_t *self, void *user)
{
    ale_mapper_thread_t *thread = user;
    const int64_t look_ns = ale_clock_real_ns(&thread->exchange->clock, LOOK_US);
    while (!ale_rt_task_stopping(self)) {
        work_off(thread);
        ale_background_wait(&thread->thread, look_ns);
    }
}

ale_mapper_thread_t *ale_mapper_thread_start(ale_exchange_t *exchange)
{
    ale_mapper_thread_t *thread = calloc(1, sizeof *thread);
    if (!thread) {
        return NULL;
    }
    thread->exchange = exchange;
    thread->mapper = ale_mapper_create(ALE_MAPPER_KEYFRAMES);
    if (!thread->mapper ||
        ale_background_start(&thread->thread, "ale-mapper", run, thread, ALE_MAPPER_HEAP_BYTES) < 0) {
        ale_mapper_thread_stop(thread);
        return NULL;
    }
    return thread;
}

void ale_mapper_thread_stop(ale_mapper_thread_t *thread)
{
    if (!thread) {
        return;
    }
    ale_background_stop(&thread->thread);
    ale_mapper_destroy(thread->mapper);
    free(thread);
}
