#include "operator/explore_thread.h"

#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/fixed.h"
#include "exchange/ring.h"
#include "exchange/snapshot.h"
#include "exchange/wake.h"
#include "operator/drive_arbiter.h"
#include "plan/explorer.h"
#include "system/background.h"

#define IDLE_NS 200000000
#define EFFECT_US 40000 /* until the motors obey: the drive's message and its controller */
#define CELLS_PER_M2 (1000000 / ALE_GRID_CELL_UM * 1000000 / ALE_GRID_CELL_UM)

enum { SCAN_SLOTS = 8, CM_PER_M = 100, UM_PER_CM = 10000, PLACE_BYTES = 32 };

typedef struct {
    ale_estimate_t estimate;
    ale_scan_t scan;
} seen_t;

/* What is asked for by an odd request that is no exploration. */
typedef struct {
    uint32_t request;
    ale_point_t place;
    bool has_map;
    ale_map_t map;
} order_t;

typedef struct {
    ale_explorer_state_t state;
    ale_given_up_t why;
    ale_point_t place;
    uint32_t plans; /* so many, with changes of the state */
    uint32_t points;
    ale_point_t point[ALE_OUTLINE_POINTS];
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
    ale_snapshot_t *order;
    ale_background_t thread;
    /* Counts requests; odd: on. */
    atomic_uint request;
    uint32_t heard; /* the request that is being obeyed */
    uint32_t goal;  /* the newest request that was for a place; for telemetry */
    doing_t now;    /* what is published */
    /* The map of the newest estimate: epoch << 32 | corrections. */
    atomic_ullong known;
    ale_explorer_t explorer;
};

/* The path as planned last; a new plan has a path anew, or another state. */
static void note_path(const ale_explorer_t *explorer, doing_t *doing)
{
    const bool active = explorer->begun && ale_explorer_is_active(explorer);
    if (active && explorer->steps_since_plan == 0) {
        doing->points =
            ale_planner_outline(&explorer->planner, &explorer->grid, &explorer->route, doing->point);
        doing->plans++;
    } else if (!active) {
        doing->points = 0;
    }
}

static void publish_doing(ale_explore_t *explore, bool lost)
{
    const ale_explorer_t *explorer = &explore->explorer;
    doing_t *doing = &explore->now;
    doing->plans +=
        doing->state != explorer->state || doing->request != explore->heard || doing->lost != lost;
    note_path(explorer, doing);
    doing->state = explorer->state;
    doing->why = explorer->why;
    doing->place = (ale_point_t){explorer->home.x_um, explorer->home.y_um};
    doing->lost = lost;
    doing->looks = ale_wander_is_active(&explorer->wander);
    doing->request = explore->heard;
    doing->cells = explorer->begun ? explorer->grid.seen : 0;
    doing->refused = explorer->planner.refused_count;
    doing->way_cm = explorer->route.cost;
    *(doing_t *)ale_snapshot_back(explore->doing) = *doing;
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
        bool fresh = false;
        const order_t *order = ale_snapshot_newest(explore->order, &fresh);
        if (request % 2 == 1 && order->request == request) {
            ale_explorer_go(&explore->explorer, order->place, order->has_map ? &order->map : NULL);
        } else {
            ale_explorer_request(&explore->explorer, request % 2 == 1);
        }
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
    explore->order = ale_snapshot_create(sizeof(order_t));
    const ale_explorer_config_t explorer = ale_config_explorer(config);
    ale_explorer_init(&explore->explorer, &explorer);
    if (!explore->seen || !explore->doing || !explore->order ||
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
    ale_snapshot_destroy(explore->order);
    free(explore);
}

/* The next one that is odd, or even. */
static uint32_t next_request(const ale_explore_t *explore, bool on)
{
    const uint32_t request = atomic_load_explicit(&explore->request, memory_order_relaxed);
    return request + ((request % 2 == 1) == on ? 2 : 1);
}

static void ask(ale_explore_t *explore, uint32_t request)
{
    atomic_store_explicit(&explore->request, request, memory_order_release);
    ale_background_wake(&explore->thread);
}

void ale_explore_request(ale_explore_t *explore, bool on)
{
    ask(explore, next_request(explore, on));
}

void ale_explore_go(ale_explore_t *explore, ale_point_t place, const ale_map_t *map)
{
    explore->goal = next_request(explore, true);
    order_t *order = ale_snapshot_back(explore->order);
    order->request = explore->goal;
    order->place = place;
    order->has_map = map != NULL;
    if (map) {
        order->map = *map;
    }
    ale_snapshot_publish(explore->order);
    ask(explore, explore->goal);
}

static doing_t newest_doing(ale_explore_t *explore)
{
    bool fresh = false;
    return *(const doing_t *)ale_snapshot_newest(explore->doing, &fresh);
}

static bool is_over(ale_explorer_state_t state)
{
    return state == ALE_EXPLORER_FINISHED || state == ALE_EXPLORER_ARRIVED || state == ALE_EXPLORER_GIVEN_UP;
}

bool ale_explore_is_on(ale_explore_t *explore)
{
    const uint32_t request = atomic_load_explicit(&explore->request, memory_order_relaxed);
    const doing_t doing = newest_doing(explore);
    return request % 2 == 1 && (doing.request != request || !is_over(doing.state));
}

bool ale_explore_is_going(ale_explore_t *explore)
{
    return atomic_load_explicit(&explore->request, memory_order_relaxed) == explore->goal &&
           ale_explore_is_on(explore);
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

/* A place as people write it: metres, to the centimetre. */
static void place_words(ale_point_t place, char text[PLACE_BYTES])
{
    const ale_point_t cm = {(int32_t)ale_round_div(place.x_um, UM_PER_CM),
                            (int32_t)ale_round_div(place.y_um, UM_PER_CM)};
    snprintf(text, PLACE_BYTES, "%s%d.%02d %s%d.%02d", cm.x_um < 0 ? "-" : "", abs(cm.x_um) / CM_PER_M,
             abs(cm.x_um) % CM_PER_M, cm.y_um < 0 ? "-" : "", abs(cm.y_um) / CM_PER_M,
             abs(cm.y_um) % CM_PER_M);
}

static const char *const reasons[] = {
    [ALE_GIVEN_UP_NOT] = "",
    [ALE_GIVEN_UP_LOST] = "the pose is lost",
    [ALE_GIVEN_UP_FAR] = "too far away to plan a way there",
    [ALE_GIVEN_UP_TAKEN] = "there is no room for the robot there",
    [ALE_GIVEN_UP_CLOSED] = "no way leads there that is wide enough",
    [ALE_GIVEN_UP_STUCK] = "the way is blocked",
    [ALE_GIVEN_UP_MAP] = "the map is another one now",
};

static void going_words(const doing_t *doing, char text[ALE_ANSWER_BYTES])
{
    char place[PLACE_BYTES];
    place_words(doing->place, place);
    if (doing->state == ALE_EXPLORER_ARRIVED) {
        snprintf(text, ALE_ANSWER_BYTES, "is at %s", place);
    } else if (doing->state == ALE_EXPLORER_GOING && doing->lost) {
        snprintf(text, ALE_ANSWER_BYTES, "waits: the pose is lost");
    } else if (doing->state == ALE_EXPLORER_GIVEN_UP) {
        snprintf(text, ALE_ANSWER_BYTES, "gave up %s: %s", place, reasons[doing->why]);
    } else {
        snprintf(text, ALE_ANSWER_BYTES, "drives to %s: %u m to go", place,
                 (doing->way_cm + CM_PER_M / 2) / CM_PER_M);
    }
}

ale_goal_answer_t ale_explore_goal_answer(ale_explore_t *explore, char text[ALE_ANSWER_BYTES])
{
    const doing_t doing = newest_doing(explore);
    if (atomic_load_explicit(&explore->request, memory_order_relaxed) != explore->goal) {
        snprintf(text, ALE_ANSWER_BYTES, "called off");
        return ALE_GOAL_REFUSED;
    }
    if (doing.request != explore->goal || (doing.state == ALE_EXPLORER_GOING && doing.points == 0)) {
        return ALE_GOAL_PENDING;
    }
    going_words(&doing, text);
    return doing.state == ALE_EXPLORER_GIVEN_UP ? ALE_GOAL_REFUSED : ALE_GOAL_TAKEN;
}

static void exploring_words(const doing_t *doing, char text[ALE_ANSWER_BYTES])
{
    if (doing->lost) {
        snprintf(text, ALE_ANSWER_BYTES, "%s: the pose is lost",
                 doing->looks ? "looks for its place" : "waits");
        return;
    }
    switch (doing->state) {
    case ALE_EXPLORER_EXPLORING:
        area_words(doing, "explores", text);
        break;
    case ALE_EXPLORER_RETURNING:
    case ALE_EXPLORER_TURNING:
        snprintf(text, ALE_ANSWER_BYTES, "all seen, drives back: %u m to go", doing->way_cm / CM_PER_M);
        break;
    default:
        snprintf(text, ALE_ANSWER_BYTES, "all seen, but the way back is closed");
        break;
    }
}

void ale_explore_words(ale_explore_t *explore, char text[ALE_ANSWER_BYTES])
{
    const doing_t doing = newest_doing(explore);
    text[0] = '\0';
    switch (doing.state) {
    case ALE_EXPLORER_OFF:
        break;
    case ALE_EXPLORER_FINISHED:
        area_words(&doing, "finished", text);
        break;
    case ALE_EXPLORER_GOING:
    case ALE_EXPLORER_ARRIVED:
    case ALE_EXPLORER_GIVEN_UP:
        going_words(&doing, text);
        break;
    case ALE_EXPLORER_EXPLORING:
    case ALE_EXPLORER_RETURNING:
    case ALE_EXPLORER_TURNING:
    case ALE_EXPLORER_BLOCKED:
        exploring_words(&doing, text);
        break;
    }
}

uint32_t ale_explore_plan(ale_explore_t *explore, ale_plan_report_t *report)
{
    static const ale_plan_state_t states[] = {
        [ALE_EXPLORER_OFF] = ALE_PLAN_OFF,           [ALE_EXPLORER_EXPLORING] = ALE_PLAN_EXPLORES,
        [ALE_EXPLORER_RETURNING] = ALE_PLAN_RETURNS, [ALE_EXPLORER_TURNING] = ALE_PLAN_RETURNS,
        [ALE_EXPLORER_FINISHED] = ALE_PLAN_OFF,      [ALE_EXPLORER_BLOCKED] = ALE_PLAN_RETURNS,
        [ALE_EXPLORER_GOING] = ALE_PLAN_GOES,        [ALE_EXPLORER_ARRIVED] = ALE_PLAN_ARRIVED,
        [ALE_EXPLORER_GIVEN_UP] = ALE_PLAN_GIVEN_UP};
    const doing_t doing = newest_doing(explore);
    report->state = states[doing.state];
    report->has_place = report->state >= ALE_PLAN_GOES;
    report->place = doing.place;
    report->points = doing.points;
    _Static_assert(sizeof report->point == sizeof doing.point, "as many here as there");
    memcpy(report->point, doing.point, sizeof doing.point);
    ale_explore_words(explore, report->words);
    return doing.plans;
}
