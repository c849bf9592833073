#include "recorder.h"

#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "flight_file.h"
#include "flight_ring.h"
#include "flight_words.h"
#include "realtime/rt.h"
#include "store/little_endian.h"
#include "wake.h"

#define NS_PER_MS 1000000LL
#define LOOK_NS 50000000
#define PATIENCE_NS (1000 * NS_PER_MS)  /* after which bytes are taken that make no scan */
#define AFTERMATH_NS (3000 * NS_PER_MS) /* recorded on after a fault */
#define QUIET_NS (60000 * NS_PER_MS)    /* between recordings that nobody asked for */

/* Six seconds of a disk that does not answer: the line gives 21 kB/s, odometry comes at 100 Hz. */
enum { BYTES_SLOTS = 512, WORDS_SLOTS = 1024, ITEM_BYTES = 512, MEGABYTE = 1 << 20 };

typedef enum { ITEM_CHUNK, ITEM_SCAN, ITEM_RESULT } item_type_t;

typedef struct {
    item_type_t type;
    ale_chunk_kind_t kind; /* CHUNK */
    uint32_t number;       /* of the sample of odometry, or of the scan */
    int64_t stamp_us;
    uint32_t length;
    uint8_t bytes[ITEM_BYTES]; /* RESULT: an ale_flight_result_t */
} item_t;

_Static_assert(sizeof(ale_flight_result_t) <= ITEM_BYTES, "a result is one item");

struct ale_recorder {
    const ale_config_t *config;
    char *config_text;
    ale_ring_t *acquired; /* item_t, from the acquire thread */
    ale_ring_t *told;     /* item_t, from telemetry */
    ale_ring_t *later;    /* item_t: odometry that no scan written so far was estimated with */
    ale_flight_ring_t *flight;
    int wake; /* event descriptor: a recording is wanted, or the end */
    ale_rt_task_t *task;
    atomic_uint wanted; /* a bit a reason */
    atomic_uint written;
    int64_t moved_ns; /* when items were last moved to the flight ring */
    int64_t write_ns; /* when the recording that is due is to be written; 0: none is */
    int64_t quiet_until_ns;
    ale_record_reason_t reason; /* of the one that is due */
};

static const char *const reason_words[] = {"command", "fault", "deadline"};

/* ---- what the writers call ---- */

static void put(ale_ring_t *queue, const item_t *head, const void *bytes)
{
    item_t *item = ale_ring_reserve(queue);
    if (item) {
        item->type = head->type;
        item->kind = head->kind;
        item->number = head->number;
        item->stamp_us = head->stamp_us;
        item->length = head->length;
        memcpy(item->bytes, bytes, head->length);
        ale_ring_commit(queue);
    }
}

static void put_chunk(ale_ring_t *queue, ale_chunk_kind_t kind, int64_t stamp_us, const void *bytes,
                      uint32_t length)
{
    const item_t head = {.type = ITEM_CHUNK, .kind = kind, .stamp_us = stamp_us, .length = length};
    put(queue, &head, bytes);
}

void ale_recorder_bytes(ale_recorder_t *recorder, bool sent, const uint8_t *bytes, uint32_t count,
                        int64_t now_us)
{
    while (recorder && count > 0) {
        const uint32_t part = count < ITEM_BYTES ? count : ITEM_BYTES;
        put_chunk(recorder->acquired, sent ? ALE_CHUNK_SENT : ALE_CHUNK_RECEIVED, now_us, bytes, part);
        bytes += part;
        count -= part;
    }
}

void ale_recorder_scan(ale_recorder_t *recorder, uint32_t number)
{
    if (recorder) {
        put(recorder->acquired, &(item_t){.type = ITEM_SCAN, .number = number}, "");
    }
}

void ale_recorder_odometry(ale_recorder_t *recorder, uint32_t number, const ale_odometry_t *sample)
{
    if (recorder) {
        uint8_t payload[ALE_CHUNK_ODOMETRY_BYTES];
        ale_chunk_put_odometry(payload, sample);
        const item_t head = {.type = ITEM_CHUNK,
                             .kind = ALE_CHUNK_ODOMETRY,
                             .number = number,
                             .stamp_us = sample->stamp_us,
                             .length = sizeof payload};
        put(recorder->told, &head, payload);
    }
}

void ale_recorder_command(ale_recorder_t *recorder, int64_t now_us, const char *text)
{
    if (recorder) {
        const size_t length = strnlen(text, ITEM_BYTES);
        put_chunk(recorder->told, ALE_CHUNK_COMMAND, now_us, text, (uint32_t)length);
    }
}

void ale_recorder_correction(ale_recorder_t *recorder, int64_t now_us, uint32_t scan, ale_pose_t pose)
{
    if (recorder) {
        uint8_t payload[16];
        ale_put_u32(payload, scan);
        ale_put_u32(payload + 4, (uint32_t)pose.x_um);
        ale_put_u32(payload + 8, (uint32_t)pose.y_um);
        ale_put_u32(payload + 12, pose.theta_bam);
        put_chunk(recorder->told, ALE_CHUNK_CORRECTION, now_us, payload, sizeof payload);
    }
}

void ale_recorder_result(ale_recorder_t *recorder, const ale_result_t *result)
{
    if (recorder) {
        const ale_flight_result_t kept = ale_flight_result(result);
        const item_t head = {.type = ITEM_RESULT, .number = result->answered, .length = sizeof kept};
        put(recorder->told, &head, &kept);
    }
}

void ale_recorder_trigger(ale_recorder_t *recorder, ale_record_reason_t reason)
{
    if (recorder) {
        atomic_fetch_or(&recorder->wanted, 1U << reason);
        ale_wake_post(recorder->wake);
    }
}

uint32_t ale_recorder_written(const ale_recorder_t *recorder)
{
    return recorder ? atomic_load(&recorder->written) : 0;
}

uint32_t ale_recorder_refused(const ale_recorder_t *recorder)
{
    return recorder ? ale_ring_refused(recorder->acquired) + ale_ring_refused(recorder->told) +
                          ale_ring_refused(recorder->later)
                    : 0;
}

/* ---- the recorder's thread: both queues into one order ---- */

/* Where the first item of a type lies in a queue; `ready` when there is none. */
static uint32_t find(ale_ring_t *queue, item_type_t type, uint32_t ready)
{
    uint32_t k = 0;
    while (k < ready && ((const item_t *)ale_ring_at(queue, k))->type != type) {
        k++;
    }
    return k;
}

static void keep_chunk(ale_recorder_t *recorder, const item_t *item)
{
    ale_flight_ring_put(recorder->flight, item->kind, item->stamp_us, item->bytes, item->length);
}

static void keep_result(ale_recorder_t *recorder, const item_t *item)
{
    ale_flight_result_t result;
    char text[ALE_FLIGHT_MAX_PAYLOAD];
    memcpy(&result, item->bytes, sizeof result);
    const uint32_t decision = ale_flight_decision(&result, text);
    ale_flight_ring_put(recorder->flight, ALE_CHUNK_DECISION, result.estimate.stamp_us, text, decision);
    const uint32_t stages = ale_flight_stages(&result, text);
    ale_flight_ring_put(recorder->flight, ALE_CHUNK_STAGES, result.estimate.stamp_us, text, stages);
}

/* Odometry that the estimate task had not yet seen when it used the scan. */
static bool came_later(const item_t *item, uint32_t odometry_taken)
{
    return item->kind == ALE_CHUNK_ODOMETRY && (int32_t)(item->number - odometry_taken) >= 0;
}

/* What waits from the scans before, as far as the estimate task has seen it by now. */
static void keep_later(ale_recorder_t *recorder, uint32_t odometry_taken)
{
    for (uint32_t ready = ale_ring_ready(recorder->later); ready > 0; ready--) {
        const item_t *item = ale_ring_at(recorder->later, 0);
        if (came_later(item, odometry_taken)) {
            return;
        }
        keep_chunk(recorder, item);
        ale_ring_release(recorder->later);
    }
}

/* What was told before the result: what was known to it goes before its scan, the rest waits. */
static void keep_told(ale_recorder_t *recorder, uint32_t count, uint32_t odometry_taken)
{
    for (uint32_t k = 0; k < count; k++) {
        const item_t *item = ale_ring_at(recorder->told, k);
        if (came_later(item, odometry_taken)) {
            put(recorder->later, item, item->bytes);
        } else {
            keep_chunk(recorder, item);
        }
    }
}

static void keep_acquired(ale_recorder_t *recorder, uint32_t count)
{
    for (; count > 0; count--) {
        const item_t *item = ale_ring_at(recorder->acquired, 0);
        if (item->type == ITEM_CHUNK) {
            keep_chunk(recorder, item);
        }
        ale_ring_release(recorder->acquired);
    }
}

static void release_told(ale_recorder_t *recorder, uint32_t count)
{
    for (; count > 0; count--) {
        ale_ring_release(recorder->told);
    }
}

/* One scan: what the estimate task knew before it, its bytes, and what came of it; odometry that came
 * meanwhile waits for the scan that knows it. A scan whose result found no room, or a result whose scan did
 * not, goes alone. False: nothing is complete. */
static bool keep_scan(ale_recorder_t *recorder)
{
    const uint32_t acquired = ale_ring_ready(recorder->acquired);
    const uint32_t told = ale_ring_ready(recorder->told);
    const uint32_t scan_at = find(recorder->acquired, ITEM_SCAN, acquired);
    const uint32_t result_at = find(recorder->told, ITEM_RESULT, told);
    if (scan_at == acquired || result_at == told) {
        return false;
    }
    const item_t *scan = ale_ring_at(recorder->acquired, scan_at);
    const item_t *result = ale_ring_at(recorder->told, result_at);
    const int32_t ahead = (int32_t)(scan->number - result->number);
    ale_flight_result_t kept;
    memcpy(&kept, result->bytes, sizeof kept);
    if (ahead >= 0) {
        keep_later(recorder, kept.odometry_taken);
        keep_told(recorder, result_at, kept.odometry_taken);
    }
    if (ahead <= 0) {
        keep_acquired(recorder, scan_at + 1);
    }
    if (ahead >= 0) {
        keep_result(recorder, result);
        release_told(recorder, result_at + 1);
    }
    return true;
}

/* What makes no scan, or waits too long for its result: as it came. */
static void keep_all(ale_recorder_t *recorder)
{
    for (uint32_t count = ale_ring_ready(recorder->later); count > 0; count--) {
        keep_chunk(recorder, ale_ring_at(recorder->later, 0));
        ale_ring_release(recorder->later);
    }
    for (uint32_t count = ale_ring_ready(recorder->told); count > 0; count--) {
        const item_t *item = ale_ring_at(recorder->told, 0);
        if (item->type == ITEM_RESULT) {
            keep_result(recorder, item);
        } else {
            keep_chunk(recorder, item);
        }
        ale_ring_release(recorder->told);
    }
    keep_acquired(recorder, ale_ring_ready(recorder->acquired));
}

static bool crowded(const ale_recorder_t *recorder)
{
    return ale_ring_ready(recorder->acquired) > BYTES_SLOTS / 2 ||
           ale_ring_ready(recorder->told) > WORDS_SLOTS / 2;
}

static void drain(ale_recorder_t *recorder, int64_t now_ns)
{
    while (keep_scan(recorder)) {
        recorder->moved_ns = now_ns;
    }
    if (crowded(recorder) || now_ns - recorder->moved_ns > PATIENCE_NS) {
        keep_all(recorder);
        recorder->moved_ns = now_ns;
    }
}

/* ---- and what is wanted onto the disk ---- */

/* A command does not wait, and does not take the place of a fault that is being recorded. */
static void plan(ale_recorder_t *recorder, int64_t now_ns)
{
    const unsigned wanted = atomic_exchange(&recorder->wanted, 0);
    const unsigned by_itself = wanted & ~(1U << ALE_RECORD_COMMAND);
    if (recorder->write_ns == 0 && by_itself != 0 && now_ns >= recorder->quiet_until_ns) {
        recorder->reason = by_itself & (1U << ALE_RECORD_FAULT) ? ALE_RECORD_FAULT : ALE_RECORD_DEADLINE;
        recorder->write_ns = now_ns + AFTERMATH_NS;
        recorder->quiet_until_ns = now_ns + QUIET_NS;
    }
    if (wanted & (1U << ALE_RECORD_COMMAND)) {
        recorder->reason = recorder->write_ns == 0 ? ALE_RECORD_COMMAND : recorder->reason;
        recorder->write_ns = now_ns;
    }
}

static void write_if_due(ale_recorder_t *recorder, int64_t now_ns)
{
    if (recorder->write_ns == 0 || now_ns < recorder->write_ns) {
        return;
    }
    char message[ALE_FLIGHT_MESSAGE];
    recorder->write_ns = 0;
    if (ale_flight_file_write(recorder->config->recorder_folder, reason_words[recorder->reason],
                              recorder->config_text, recorder->flight, message) == 0) {
        atomic_fetch_add(&recorder->written, 1);
    }
    fprintf(stderr, "ale-slamd: %s\n", message);
}

static void wait_for_work(const ale_recorder_t *recorder)
{
    ale_wake_wait(recorder->wake, LOOK_NS);
}

static void run(ale_rt_task_t *self, void *user)
{
    ale_recorder_t *recorder = user;
    while (!ale_rt_task_stopping(self)) {
        wait_for_work(recorder);
        const int64_t now_ns = ale_rt_now_ns();
        drain(recorder, now_ns);
        plan(recorder, now_ns);
        write_if_due(recorder, now_ns);
    }
    drain(recorder, ale_rt_now_ns());
    keep_all(recorder);
    plan(recorder, ale_rt_now_ns());
    write_if_due(recorder, INT64_MAX);
}

static char *print_config(const ale_config_t *config)
{
    char *text = NULL;
    size_t count = 0;
    FILE *out = open_memstream(&text, &count);
    if (!out) {
        return NULL;
    }
    ale_config_print(config, out);
    if (fclose(out) != 0) {
        free(text);
        return NULL;
    }
    return text;
}

static void destroy(ale_recorder_t *recorder)
{
    if (recorder->acquired) {
        ale_ring_destroy(recorder->acquired);
    }
    if (recorder->told) {
        ale_ring_destroy(recorder->told);
    }
    if (recorder->later) {
        ale_ring_destroy(recorder->later);
    }
    ale_flight_ring_destroy(recorder->flight);
    ale_wake_close(recorder->wake);
    free(recorder->config_text);
    free(recorder);
}

ale_recorder_t *ale_recorder_start(const ale_config_t *config)
{
    ale_recorder_t *recorder = calloc(1, sizeof *recorder);
    if (!recorder) {
        return NULL;
    }
    recorder->config = config;
    recorder->config_text = print_config(config);
    recorder->acquired = ale_ring_create(sizeof(item_t), BYTES_SLOTS);
    recorder->told = ale_ring_create(sizeof(item_t), WORDS_SLOTS);
    recorder->later = ale_ring_create(sizeof(item_t), WORDS_SLOTS);
    recorder->flight = ale_flight_ring_create((uint32_t)config->recorder_megabytes * MEGABYTE);
    recorder->wake = ale_wake_open();
    recorder->moved_ns = ale_rt_now_ns();
    if (recorder->config_text && recorder->acquired && recorder->told && recorder->later &&
        recorder->flight && recorder->wake >= 0) {
        recorder->task = ale_rt_task_start(&(ale_rt_task_config_t){
            .name = "ale-recorder", .kind = ALE_RT_BACKGROUND, .body = run, .user = recorder});
    }
    if (!recorder->task) {
        destroy(recorder);
        return NULL;
    }
    return recorder;
}

void ale_recorder_stop(ale_recorder_t *recorder)
{
    if (recorder) {
        ale_rt_task_stop(recorder->task);
        ale_wake_post(recorder->wake);
        ale_rt_task_join(recorder->task);
        destroy(recorder);
    }
}
