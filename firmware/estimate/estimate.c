#include "estimate/estimate.h"

#include <stdlib.h>
#include <string.h>

#include "base/fixed.h"
#include "base/trig.h"

#define IDLE_NS 100000000

/* What a scan has shown is worth telling when the robot has gone on so far, or turned. Where it stays: soon
 * again, so that walls are seen often enough to count, and then now and then. */
enum {
    OBSERVATION_STEP_UM = 100000,
    OBSERVATION_TURN_BAM = 100 * ALE_BAM_PER_MRAD,
    OBSERVATIONS_SOON = 3,
    OBSERVATION_SOON_US = 300000,
    OBSERVATION_WAIT_US = 5000000
};

/* The last scan observation that was handed over. */
typedef struct {
    uint32_t epoch;
    ale_pose_t from;
    uint32_t count; /* from there */
    int64_t stamp_us;
} ale_offered_t;

struct ale_estimator {
    ale_exchange_t *exchange;
    ale_pipeline_t *pipeline;
    bool keep_scans;
    uint32_t overloaded;
    uint32_t late;
    uint32_t corrections_late;
    uint32_t tiles_late;
    uint32_t tiles_waiting; /* pieces, that were counted */
    uint32_t answered;
    uint32_t next_scan; /* by the pipeline's count, which corrections go by */
    uint32_t odometry_taken;
    uint32_t map_moves; /* so often the map was moved under the robot, or another one began */
    uint32_t epoch;     /* of the last answer */
    bool corrected;     /* since the last answer, by: */
    ale_pose_t correction;
    ale_offered_t offered;
    bool map_waits;     /* changed since it was last handed over */
    int64_t map_ns;     /* when it was handed over */
    int64_t arrival_ns; /* of the scan at hand, by the clock of ale_rt_now_ns */
    int64_t stage_start_ns;
    ale_result_t *result; /* being made */
    ale_result_t spare;   /* where a result goes that has no room */
};

static int32_t clamp_ns(int64_t span_ns)
{
    return (int32_t)ale_clamp64(span_ns, 0, INT32_MAX);
}

static void end_of_stage(void *user, ale_stage_t stage)
{
    ale_estimator_t *estimator = user;
    ale_result_t *result = estimator->result;
    const int64_t start_ns = estimator->stage_start_ns;
    const int64_t now_ns = ale_rt_now_ns();
    if (result->stage_end_ns[stage] == 0) {
        result->stage_start_ns[stage] = clamp_ns(start_ns - estimator->arrival_ns);
    }
    result->stage_end_ns[stage] = clamp_ns(now_ns - estimator->arrival_ns);
    result->stage_ns[stage] = clamp_ns(result->stage_ns[stage] + now_ns - start_ns);
    estimator->stage_start_ns = now_ns;
}

static void begin_stages(ale_estimator_t *estimator, ale_result_t *result, int64_t start_ns)
{
    const ale_clock_t *clock = &estimator->exchange->clock;
    const int64_t waited_us = ale_clock_now_us(clock) - result->arrival_us;
    estimator->arrival_ns = start_ns - ale_clock_real_ns(clock, waited_us);
    estimator->stage_start_ns = start_ns;
    estimator->result = result;
    memset(result->stage_ns, 0, sizeof result->stage_ns);
    memset(result->stage_start_ns, 0, sizeof result->stage_start_ns);
    memset(result->stage_end_ns, 0, sizeof result->stage_end_ns);
}

ale_estimator_t *ale_estimator_create(const ale_config_t *config, ale_exchange_t *exchange)
{
    ale_estimator_t *estimator = calloc(1, sizeof *estimator);
    ale_pipeline_t *pipeline = calloc(1, ale_pipeline_size());
    if (!estimator || !pipeline || ale_pipeline_init(pipeline, &config->pipeline) < 0) {
        free(estimator);
        free(pipeline);
        return NULL;
    }
    estimator->exchange = exchange;
    estimator->map_ns = -ALE_MAP_PERIOD_NS;
    estimator->pipeline = pipeline;
    estimator->keep_scans = config->publish_scan || config->publish_bot_core || config->keys[0] != '\0';
    estimator->result = &estimator->spare;
    const ale_stage_hook_t hook = {.end_of = end_of_stage, .user = estimator};
    ale_pipeline_set_hook(pipeline, &hook);
    return estimator;
}

void ale_estimator_destroy(ale_estimator_t *estimator)
{
    if (estimator) {
        free(estimator->pipeline);
        free(estimator);
    }
}

ale_shortfall_t ale_estimator_shortfall(const ale_estimator_t *estimator)
{
    return (ale_shortfall_t){.scans = estimator->answered,
                             .overloaded = estimator->overloaded,
                             .corrections_late = estimator->corrections_late,
                             .tiles_late = estimator->tiles_late};
}

void ale_estimator_load_map(ale_estimator_t *estimator, const ale_map_t *map, const ale_pose_t *pose)
{
    const ale_pose_t unknown = {0};
    ale_pipeline_load_map(estimator->pipeline, map, ale_exchange_know(estimator->exchange, map),
                          pose ? *pose : unknown, pose != NULL);
    estimator->map_waits = true;
}

void ale_estimator_load_tiles(ale_estimator_t *estimator, const ale_pose_t *pose)
{
    const ale_pose_t unknown = {0};
    ale_pipeline_load_tiles(estimator->pipeline, pose ? *pose : unknown, pose != NULL);
    estimator->map_waits = true;
}

static void take_odometry(ale_estimator_t *estimator)
{
    ale_ring_t *odometry = estimator->exchange->odometry;
    for (uint32_t ready = ale_ring_ready(odometry); ready > 0; ready--) {
        ale_pipeline_odometry(estimator->pipeline, ale_ring_at(odometry, 0));
        ale_ring_release(odometry);
        estimator->odometry_taken++;
    }
}

/* Corrections take effect at the scan they are due at, so that a recording replays to the same poses. */
static void take_corrections(ale_estimator_t *estimator)
{
    ale_ring_t *corrections = estimator->exchange->corrections;
    for (uint32_t ready = ale_ring_ready(corrections); ready > 0; ready--) {
        const ale_correction_t *correction = ale_ring_at(corrections, 0);
        if (!ale_pipeline_correct(estimator->pipeline, correction)) {
            return;
        }
        estimator->corrections_late += correction->due < estimator->next_scan;
        estimator->correction = correction->shift[correction->count - 1].shift;
        estimator->corrected = true;
        estimator->map_moves++;
        estimator->map_waits = true;
        ale_ring_release(corrections);
    }
}

/* Pieces of tiles, likewise; one a scan, so that a scan never waits for all that is loaded around the robot.
 */
static void take_tiles(ale_estimator_t *estimator)
{
    ale_ring_t *tiles = estimator->exchange->tiles;
    const uint32_t ready = ale_ring_ready(tiles);
    for (; estimator->tiles_waiting < ready; estimator->tiles_waiting++) {
        const ale_tile_change_t *change = ale_ring_at(tiles, estimator->tiles_waiting);
        estimator->tiles_late += change->due < estimator->next_scan;
    }
    if (ready > 0 && ale_pipeline_change_tiles(estimator->pipeline, ale_ring_at(tiles, 0))) {
        estimator->map_waits = true;
        estimator->tiles_waiting--;
        ale_ring_release(tiles);
    }
}

static void offer_whereabouts(ale_estimator_t *estimator)
{
    ale_whereabouts_t *slot =
        estimator->exchange->has_tiles ? ale_ring_reserve(estimator->exchange->whereabouts) : NULL;
    if (slot && ale_pipeline_whereabouts(estimator->pipeline, slot)) {
        ale_ring_commit(estimator->exchange->whereabouts);
    }
}

static void offer_keyframe(ale_estimator_t *estimator)
{
    ale_keyframe_t *slot = ale_ring_reserve(estimator->exchange->keyframes);
    if (slot && ale_pipeline_keyframe(estimator->pipeline, slot)) {
        ale_ring_commit(estimator->exchange->keyframes);
    }
}

static bool is_still_there(const ale_offered_t *offered, const ale_estimate_t *estimate)
{
    return offered->epoch == estimate->epoch &&
           ale_are_near(offered->from, estimate->smooth, OBSERVATION_STEP_UM, OBSERVATION_TURN_BAM);
}

static void offer_observation(ale_estimator_t *estimator, const ale_estimate_t *estimate)
{
    ale_offered_t *offered = &estimator->offered;
    const bool there = is_still_there(offered, estimate);
    const int64_t wait_us = offered->count < OBSERVATIONS_SOON ? OBSERVATION_SOON_US : OBSERVATION_WAIT_US;
    if (there && ale_abs64(estimate->stamp_us - offered->stamp_us) < wait_us) {
        return;
    }
    ale_scan_observation_t *slot = ale_ring_reserve(estimator->exchange->observations);
    if (slot && ale_pipeline_scan_observation(estimator->pipeline, slot)) {
        ale_ring_commit(estimator->exchange->observations);
        *offered = (ale_offered_t){.epoch = estimate->epoch,
                                   .from = there ? offered->from : estimate->smooth,
                                   .count = there ? offered->count + 1 : 1,
                                   .stamp_us = estimate->stamp_us};
    }
}

static void use_scan(ale_estimator_t *estimator, const ale_scan_record_t *record, ale_result_t *result)
{
    const ale_scan_t *scan = &record->scan;
    ale_pipeline_set_noise(estimator->pipeline, &record->noise);
    ale_pipeline_scan(estimator->pipeline, scan, &result->estimate);
    result->features = *ale_pipeline_features(estimator->pipeline);
    result->has_scan = true;
    result->first_beam_us = scan->stamp_us + ale_scan_beam_offset_us(scan, 0);
    if (estimator->keep_scans) {
        result->scan = *scan;
    }
}

static void answer(ale_estimator_t *estimator, const ale_scan_record_t *record, bool use,
                   ale_result_t *result)
{
    ale_exchange_t *exchange = estimator->exchange;
    const int64_t start_ns = ale_rt_now_ns();
    result->arrival_us = record->arrival_us;
    begin_stages(estimator, result, start_ns);
    if (use) {
        use_scan(estimator, record, result);
    } else {
        ale_pipeline_dropped(estimator->pipeline, record->scan.stamp_us, &result->estimate);
        result->has_scan = false;
        result->first_beam_us = record->scan.stamp_us;
    }
    result->total_ns = clamp_ns(ale_rt_now_ns() - start_ns);
    estimator->late += ale_clock_now_us(&exchange->clock) - record->arrival_us > ALE_DEADLINE_US;
    estimator->map_waits = estimator->map_waits || result->estimate.map_changed;
    result->overloaded = estimator->overloaded;
    result->late = estimator->late;
    result->corrections_late = estimator->corrections_late;
    if (result->estimate.epoch != estimator->epoch) {
        estimator->epoch = result->estimate.epoch;
        estimator->map_moves++;
        estimator->map_waits = true;
    }
    result->map_moves = estimator->map_moves;
    result->odometry_taken = estimator->odometry_taken;
    result->answered = estimator->answered++;
    estimator->next_scan = result->estimate.scan + 1;
    result->corrected = estimator->corrected;
    result->correction = estimator->correction;
    estimator->corrected = false;
}

static void answer_oldest(ale_estimator_t *estimator, uint32_t waiting)
{
    ale_exchange_t *exchange = estimator->exchange;
    const ale_scan_record_t *record = ale_ring_at(exchange->scans, 0);
    const bool overload = !record->lost && waiting > ALE_MAX_BACKLOG;
    estimator->overloaded += overload;
    ale_result_t *result = ale_ring_reserve(exchange->results);
    answer(estimator, record, !record->lost && !overload, result ? result : &estimator->spare);
    const ale_estimate_t estimate = (result ? result : &estimator->spare)->estimate;
    if (result) {
        ale_ring_commit(exchange->results);
    }
    ale_ring_release(exchange->scans);
    offer_keyframe(estimator);
    offer_observation(estimator, &estimate);
    offer_whereabouts(estimator);
    take_corrections(estimator);
    take_tiles(estimator);
}

/* Hands the map over when it has changed, once a second at most: it is large. */
static void show_map(ale_estimator_t *estimator)
{
    const int64_t now_ns = ale_rt_now_ns();
    if (!estimator->map_waits || now_ns < estimator->map_ns + ALE_MAP_PERIOD_NS) {
        return;
    }
    ale_tracked_map_t *tracked = ale_snapshot_back(estimator->exchange->map);
    ale_pipeline_copy_map(estimator->pipeline, &tracked->map);
    tracked->moves = estimator->map_moves;
    ale_snapshot_publish(estimator->exchange->map);
    estimator->map_waits = false;
    estimator->map_ns = now_ns;
}

static void load_map(ale_estimator_t *estimator, const ale_request_t *request)
{
    bool fresh = false;
    const ale_loaded_map_t *loaded = ale_snapshot_newest(estimator->exchange->loaded_map, &fresh);
    ale_pipeline_load_map(estimator->pipeline, &loaded->map, loaded->number, request->pose,
                          request->pose_known);
}

static void fulfil(ale_estimator_t *estimator, const ale_request_t *request)
{
    switch (request->kind) {
    case ALE_REQUEST_RESET:
        ale_pipeline_reset(estimator->pipeline);
        break;
    case ALE_REQUEST_RELOCATE:
        ale_pipeline_relocate(estimator->pipeline, request->pose);
        break;
    case ALE_REQUEST_FREEZE:
        ale_pipeline_freeze_map(estimator->pipeline, request->on);
        break;
    case ALE_REQUEST_LOAD_MAP:
        load_map(estimator, request);
        break;
    }
    estimator->map_moves++;
    estimator->map_waits = true;
}

static void take_requests(ale_estimator_t *estimator)
{
    ale_ring_t *requests = estimator->exchange->requests;
    for (uint32_t ready = ale_ring_ready(requests); ready > 0; ready--) {
        fulfil(estimator, ale_ring_at(requests, 0));
        ale_ring_release(requests);
    }
}

void ale_estimator_step(ale_estimator_t *estimator)
{
    take_requests(estimator);
    take_odometry(estimator);
    take_corrections(estimator);
    for (uint32_t waiting = ale_ring_ready(estimator->exchange->scans); waiting > 0; waiting--) {
        answer_oldest(estimator, waiting - 1);
    }
    show_map(estimator);
}

void ale_estimator_run(ale_rt_task_t *self, void *user)
{
    ale_estimator_t *estimator = user;
    while (!ale_rt_task_stopping(self)) {
        ale_rt_release_wait(estimator->exchange->arrived, ale_rt_now_ns() + IDLE_NS);
        ale_estimator_step(estimator);
        ale_heartbeat_beat(estimator->exchange->heartbeat);
    }
    ale_estimator_step(estimator);
}
