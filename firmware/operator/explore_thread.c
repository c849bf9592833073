#include "operator/explore_thread.h"

#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>

#include "exchange/ring.h"
#include "exchange/snapshot.h"
#include "exchange/wake.h"
#include "operator/drive_arbiter.h"
#include "plan/explorer.h"
#include "system/background.h"

#define IDLE_NS 200000000
#define EFFECT_US 40000 /* until the motors obey: the drive's message and its controller */
#define CELLS_PER_M2 (1000000 / ALE_GRID_CELL_UM * 1000000 / ALE_GRID_CELL_UM)

enum { SCAN_SLOTS = 8, CM_PER_M = 100 };

typedef struct {
    ale_estimate_t estimate;
    ale_scan_t scan;
} seen_t;

typedef struct {
    ale_explorer_state_t state;
    bool lost;
    bool looks;       /* drives about to find its place, while it is lost */
    uint32_t request; /* that it has heard of */
    uint32_t cells;
    uint32_t refused;
    uint32_t way_cm;
} doing_t;

struct ale_explore {
    ale_exchange_t *exchange;
    ale_ring_t *seen;
    ale_snapshot_t *doing;
    ale_background_t thread;
    /* Counts requests; odd: on. */
    atomic_uint request;
    uint32_t heard; /* the request that is being obeyed */
    /* The map of the newest estimate: epoch << 32 | corrections. */
    atomic_ullong known;
    ale_explorer_t explorer;
};

static void publish_doing(ale_explore_t *explore, bool lost)
{
    const ale_explorer_t *explorer = &explore->explorer;
    *(doing_t *)ale_snapshot_back(explore->doing) =
        (doing_t){.state = explorer->state,
                  .lost = lost,
                  .looks = ale_wander_is_active(&explorer->wander),
                  .request = explore->heard,
                  .cells = explorer->begun ? explorer->grid.seen : 0,
                  .refused = explorer->planner.refused_count,
                  .way_cm = explorer->route.cost};
    ale_snapshot_publish(explore->doing);
}

static void publish_request(ale_explore_t *explore, ale_velocity_t velocity, int64_t valid_until_us)
{
    *(ale_velocity_request_t *)ale_snapshot_back(explore->exchange->exploration) = (ale_velocity_request_t){
        .v_um_s = velocity.speed_um_s, .w_urad_s = velocity.turn_urad_s, .valid_until_us = valid_until_us};
    ale_snapshot_publish(explore->exchange->exploration);
    ale_wake_post(explore->exchange->drive_again);
}

static void hear_request(ale_explore_t *explore)
{
    const uint32_t request = atomic_load_explicit(&explore->request, memory_order_acquire);
    if (request != explore->heard) {
        explore->heard = request;
        ale_explorer_request(&explore->explorer, request % 2 == 1);
        publish_request(explore, (ale_velocity_t){0, 0}, 0);
        publish_doing(explore, false);
    }
}

static uint64_t known_of(uint32_t epoch, uint32_t corrections)
{
    return (uint64_t)epoch << 32 | corrections;
}

/* Corrections that are in the map of the scan that comes next: what lies in the grid moves as it did. */
static void take_corrections(ale_explore_t *explore, uint64_t known)
{
    ale_ring_t *corrections = explore->exchange->grid_corrections;
    for (uint32_t ready = ale_ring_ready(corrections); ready > 0; ready--) {
        const ale_correction_t *correction = ale_ring_at(corrections, 0);
        if (known_of(correction->epoch, correction->number) > known) {
            return;
        }
        ale_explorer_correct(&explore->explorer, correction);
        ale_ring_release(corrections);
    }
}

static void use(ale_explore_t *explore, const seen_t *seen)
{
    take_corrections(explore, known_of(seen->estimate.epoch, seen->estimate.corrections));
    const int64_t now_us = ale_clock_now_us(&explore->exchange->clock);
    const ale_velocity_t velocity =
        ale_explorer_step(&explore->explorer, &seen->scan, &seen->estimate, now_us + EFFECT_US);
    publish_request(explore, velocity, now_us + ALE_EXPLORE_REQUEST_LIFE_US);
    publish_doing(explore, seen->estimate.state == ALE_STATE_LOST);
}

static void run(ale_rt_task_t *self, void *user)
{
    ale_explore_t *explore = user;
    while (!ale_rt_task_stopping(self)) {
        ale_background_wait(&explore->thread, IDLE_NS);
        hear_request(explore);
        if (!ale_explorer_is_active(&explore->explorer)) {
            take_corrections(explore, atomic_load_explicit(&explore->known, memory_order_acquire));
        }
        for (uint32_t ready = ale_ring_ready(explore->seen); ready > 0; ready--) {
            use(explore, ale_ring_at(explore->seen, 0));
            ale_ring_release(explore->seen);
        }
    }
    publish_request(explore, (ale_velocity_t){0, 0}, 0);
}

ale_explore_t *ale_explore_start(const ale_config_t *config, ale_exchange_t *exchange)
{
    ale_explore_t *explore = calloc(1, sizeof *explore);
    if (!explore) {
        return NULL;
    }
    explore->exchange = exchange;
    explore->seen = ale_ring_create(sizeof(seen_t), SCAN_SLOTS);
    explore->doing = ale_snapshot_create(sizeof(doing_t));
    const ale_explorer_config_t explorer = ale_config_explorer(config);
    ale_explorer_init(&explore->explorer, &explorer);
    if (!explore->seen || !explore->doing ||
        ale_background_start(&explore->thread, "ale-explore", run, explore, 0) < 0) {
        ale_explore_stop(explore);
        return NULL;
    }
    return explore;
}

void ale_explore_stop(ale_explore_t *explore)
{
    if (!explore) {
        return;
    }
    ale_background_stop(&explore->thread);
    ale_ring_destroy(explore->seen);
    ale_snapshot_destroy(explore->doing);
    free(explore);
}

void ale_explore_request(ale_explore_t *explore, bool on)
{
    const uint32_t request = atomic_load_explicit(&explore->request, memory_order_relaxed);
    const uint32_t step = (request % 2 == 1) == on ? 2 : 1;
    atomic_store_explicit(&explore->request, request + step, memory_order_release);
    ale_background_wake(&explore->thread);
}

static doing_t newest_doing(ale_explore_t *explore)
{
    bool fresh = false;
    return *(const doing_t *)ale_snapshot_newest(explore->doing, &fresh);
}

bool ale_explore_is_on(ale_explore_t *explore)
{
    const uint32_t request = atomic_load_explicit(&explore->request, memory_order_relaxed);
    const doing_t doing = newest_doing(explore);
    return request % 2 == 1 && (doing.request != request || doing.state != ALE_EXPLORER_FINISHED);
}

void ale_explore_take(ale_explore_t *explore, const ale_scan_t *scan, const ale_estimate_t *estimate)
{
    atomic_store_explicit(&explore->known, known_of(estimate->epoch, estimate->corrections),
                          memory_order_release);
    if (!ale_explore_is_on(explore)) {
        return;
    }
    seen_t *seen = ale_ring_reserve(explore->seen);
    if (seen) {
        seen->scan = *scan;
        seen->estimate = *estimate;
        ale_ring_commit(explore->seen);
        ale_background_wake(&explore->thread);
    }
}

static void area_words(const doing_t *doing, const char *what, char text[ALE_ANSWER_BYTES])
{
    const uint32_t m2 = doing->cells / CELLS_PER_M2;
    if (doing->refused > 0) {
        snprintf(text, ALE_ANSWER_BYTES, "%s: %u m2 seen, %u place%s given up", what, m2, doing->refused,
                 doing->refused == 1 ? "" : "s");
    } else {
        snprintf(text, ALE_ANSWER_BYTES, "%s: %u m2 seen", what, m2);
    }
}

void ale_explore_words(ale_explore_t *explore, char text[ALE_ANSWER_BYTES])
{
    const doing_t doing = newest_doing(explore);
    text[0] = '\0';
    if (doing.lost && doing.state != ALE_EXPLORER_OFF && doing.state != ALE_EXPLORER_FINISHED) {
        snprintf(text, ALE_ANSWER_BYTES, "%s: the pose is lost",
                 doing.looks ? "looks for its place" : "waits");
        return;
    }
    switch (doing.state) {
    case ALE_EXPLORER_OFF:
        break;
    case ALE_EXPLORER_EXPLORING:
        area_words(&doing, "explores", text);
        break;
    case ALE_EXPLORER_RETURNING:
    case ALE_EXPLORER_TURNING:
        snprintf(text, ALE_ANSWER_BYTES, "all seen, drives back: %u m to go", doing.way_cm / CM_PER_M);
        break;
    case ALE_EXPLORER_FINISHED:
        area_words(&doing, "finished", text);
        break;
    case ALE_EXPLORER_BLOCKED:
        snprintf(text, ALE_ANSWER_BYTES, "all seen, but the way back is closed");
        break;
    }
}
