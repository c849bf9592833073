#include "mapping/tile_thread.h"

#include <stdlib.h>

#include "system/background.h"
#include "system/log_line.h"

#define LOOK_US 20000 /* of the robot's clock: pieces are due a few scans after what they follow from */

struct ale_tile_thread {
    ale_exchange_t *exchange;
    ale_tile_loader_t *loader;
    ale_background_t thread;
    int64_t look_ns;
    ale_tile_change_t piece;
    ale_tile_trouble_t told; /* so far */
};

static void tell(ale_tile_thread_t *thread)
{
    const ale_tile_trouble_t *trouble = ale_tile_loader_trouble(thread->loader);
    ale_tile_trouble_t *told = &thread->told;
    if (trouble->unread != told->unread) {
        ale_log_line("map of tiles: %u tiles could not be read, and count as empty; the last: %s",
                     trouble->unread, trouble->error);
    }
    const bool is_short = trouble->reach_um < trouble->wanted_um;
    if (is_short && told->reach_um == told->wanted_um) {
        ale_log_line(
            "map of tiles: so many walls are here that only those within %lld m are loaded, not %lld",
            (long long)(trouble->reach_um / 1000000), (long long)(trouble->wanted_um / 1000000));
    }
    *told = *trouble;
}

/* False: the thread is to end first. */
static bool put(ale_tile_thread_t *thread, ale_rt_task_t *self, ale_ring_t *ring)
{
    ale_tile_change_t *slot = ale_ring_reserve(ring);
    while (!slot && !ale_rt_task_stopping(self)) {
        ale_background_wait(&thread->thread, thread->look_ns);
        slot = ale_ring_reserve(ring);
    }
    if (slot) {
        *slot = thread->piece;
        ale_ring_commit(ring);
    }
    return slot != NULL;
}

static void hand_out(ale_tile_thread_t *thread, ale_rt_task_t *self)
{
    bool goes_on = true;
    while (goes_on && ale_tile_loader_next(thread->loader, &thread->piece)) {
        goes_on = put(thread, self, thread->exchange->tiles) &&
                  put(thread, self, thread->exchange->tiles_to_mapper);
    }
}

static void run(ale_rt_task_t *self, void *user)
{
    ale_tile_thread_t *thread = user;
    ale_ring_t *whereabouts = thread->exchange->whereabouts;
    while (!ale_rt_task_stopping(self)) {
        for (uint32_t ready = ale_ring_ready(whereabouts); ready > 0; ready--) {
            ale_tile_loader_follow(thread->loader, ale_ring_at(whereabouts, 0));
            ale_ring_release(whereabouts);
            hand_out(thread, self);
            tell(thread);
        }
        ale_background_wait(&thread->thread, thread->look_ns);
    }
}

ale_tile_thread_t *ale_tile_thread_start(ale_exchange_t *exchange, ale_tile_loader_t *loader)
{
    ale_tile_thread_t *thread = calloc(1, sizeof *thread);
    if (!thread) {
        return NULL;
    }
    thread->exchange = exchange;
    thread->loader = loader;
    thread->look_ns = ale_clock_real_ns(&exchange->clock, LOOK_US);
    if (ale_background_start(&thread->thread, "ale-tiles", run, thread, 0) < 0) {
        free(thread);
        return NULL;
    }
    return thread;
}

void ale_tile_thread_stop(ale_tile_thread_t *thread)
{
    if (thread) {
        ale_background_stop(&thread->thread);
        free(thread);
    }
}
