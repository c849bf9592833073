#include "recorder/flight_order.h"

#include <stdlib.h>
#include <string.h>

#include "exchange/ring.h"
#include "realtime/rt.h"
#include "recorder/flight_words.h"

#define PATIENCE_NS 1000000000LL /* after which bytes are taken that make no scan */

/* Six seconds of a disk that does not answer: the line gives 21 kB/s, odometry comes at 100 Hz. */
enum { BYTES_SLOTS = 512, WORDS_SLOTS = 1024 };

typedef struct {
    ale_flight_head_t head;
    uint8_t bytes[ALE_FLIGHT_ITEM_BYTES];
} item_t;

_Static_assert(sizeof(ale_flight_result_t) <= ALE_FLIGHT_ITEM_BYTES, "a result is one item");

struct ale_flight_order {
    ale_flight_ring_t *flight;
    ale_ring_t *acquired; /* item_t, from the acquire thread */
    ale_ring_t *told;     /* item_t, from telemetry */
    ale_ring_t *later;    /* item_t: odometry that no scan moved so far was estimated with */
    int64_t moved_ns;     /* when items were last moved */
};

static void put(ale_ring_t *queue, const ale_flight_head_t *head, const void *bytes)
{
    item_t *item = ale_ring_reserve(queue);
    if (item) {
        item->head = *head;
        memcpy(item->bytes, bytes, head->length);
        ale_ring_commit(queue);
    }
}

/* Where the first item of a type lies in a queue; `ready` when there is none. */
static uint32_t find(ale_ring_t *queue, ale_flight_item_type_t type, uint32_t ready)
{
    uint32_t k = 0;
    while (k < ready && ((const item_t *)ale_ring_at(queue, k))->head.type != type) {
        k++;
    }
    return k;
}

static void keep_chunk(ale_flight_order_t *order, const item_t *item)
{
    ale_flight_ring_put(order->flight, item->head.kind, item->head.stamp_us, item->bytes, item->head.length);
}

static void keep_result(ale_flight_order_t *order, const item_t *item)
{
    ale_flight_result_t result;
    char text[ALE_FLIGHT_MAX_PAYLOAD];
    memcpy(&result, item->bytes, sizeof result);
    const uint32_t decision = ale_flight_decision(&result, text);
    ale_flight_ring_put(order->flight, ALE_CHUNK_DECISION, result.estimate.stamp_us, text, decision);
    const uint32_t stages = ale_flight_stages(&result, text);
    ale_flight_ring_put(order->flight, ALE_CHUNK_STAGES, result.estimate.stamp_us, text, stages);
}

/* Odometry that the estimate task had not yet seen when it used the scan. */
static bool came_later(const item_t *item, uint32_t odometry_taken)
{
    return item->head.kind == ALE_CHUNK_ODOMETRY && (int32_t)(item->head.number - odometry_taken) >= 0;
}

/* What waits from the scans before, as far as the estimate task has seen it by now. */
static void keep_later(ale_flight_order_t *order, uint32_t odometry_taken)
{
    for (uint32_t ready = ale_ring_ready(order->later); ready > 0; ready--) {
        const item_t *item = ale_ring_at(order->later, 0);
        if (came_later(item, odometry_taken)) {
            return;
        }
        keep_chunk(order, item);
        ale_ring_release(order->later);
    }
}

/* What was told before the result: what was known to it goes before its scan, the rest waits. */
static void keep_told(ale_flight_order_t *order, uint32_t count, uint32_t odometry_taken)
{
    for (uint32_t k = 0; k < count; k++) {
        const item_t *item = ale_ring_at(order->told, k);
        if (came_later(item, odometry_taken)) {
            put(order->later, &item->head, item->bytes);
        } else {
            keep_chunk(order, item);
        }
    }
}

static void keep_acquired(ale_flight_order_t *order, uint32_t count)
{
    for (; count > 0; count--) {
        const item_t *item = ale_ring_at(order->acquired, 0);
        if (item->head.type == ALE_FLIGHT_CHUNK) {
            keep_chunk(order, item);
        }
        ale_ring_release(order->acquired);
    }
}

static void release_told(ale_flight_order_t *order, uint32_t count)
{
    for (; count > 0; count--) {
        ale_ring_release(order->told);
    }
}

/* One scan: what the estimate task knew before it, its bytes, and what came of it; odometry that came
 * meanwhile waits for the scan that knows it. A scan whose result found no room, or a result whose scan did
 * not, goes alone. False: nothing is complete. */
static bool keep_scan(ale_flight_order_t *order)
{
    const uint32_t acquired = ale_ring_ready(order->acquired);
    const uint32_t told = ale_ring_ready(order->told);
    const uint32_t scan_at = find(order->acquired, ALE_FLIGHT_SCAN, acquired);
    const uint32_t result_at = find(order->told, ALE_FLIGHT_RESULT, told);
    if (scan_at == acquired || result_at == told) {
        return false;
    }
    const item_t *scan = ale_ring_at(order->acquired, scan_at);
    const item_t *result = ale_ring_at(order->told, result_at);
    const int32_t ahead = (int32_t)(scan->head.number - result->head.number);
    ale_flight_result_t kept;
    memcpy(&kept, result->bytes, sizeof kept);
    if (ahead >= 0) {
        keep_later(order, kept.odometry_taken);
        keep_told(order, result_at, kept.odometry_taken);
    }
    if (ahead <= 0) {
        keep_acquired(order, scan_at + 1);
    }
    if (ahead >= 0) {
        keep_result(order, result);
        release_told(order, result_at + 1);
    }
    return true;
}

void ale_flight_order_flush(ale_flight_order_t *order)
{
    for (uint32_t count = ale_ring_ready(order->later); count > 0; count--) {
        keep_chunk(order, ale_ring_at(order->later, 0));
        ale_ring_release(order->later);
    }
    for (uint32_t count = ale_ring_ready(order->told); count > 0; count--) {
        const item_t *item = ale_ring_at(order->told, 0);
        if (item->head.type == ALE_FLIGHT_RESULT) {
            keep_result(order, item);
        } else {
            keep_chunk(order, item);
        }
        ale_ring_release(order->told);
    }
    keep_acquired(order, ale_ring_ready(order->acquired));
}

static bool crowded(const ale_flight_order_t *order)
{
    return ale_ring_ready(order->acquired) > BYTES_SLOTS / 2 || ale_ring_ready(order->told) > WORDS_SLOTS / 2;
}

void ale_flight_order_move(ale_flight_order_t *order, int64_t now_ns)
{
    while (keep_scan(order)) {
        order->moved_ns = now_ns;
    }
    if (crowded(order) || now_ns - order->moved_ns > PATIENCE_NS) {
        ale_flight_order_flush(order);
        order->moved_ns = now_ns;
    }
}

ale_flight_order_t *ale_flight_order_create(ale_flight_ring_t *flight)
{
    ale_flight_order_t *order = calloc(1, sizeof *order);
    if (!order) {
        return NULL;
    }
    order->flight = flight;
    order->acquired = ale_ring_create(sizeof(item_t), BYTES_SLOTS);
    order->told = ale_ring_create(sizeof(item_t), WORDS_SLOTS);
    order->later = ale_ring_create(sizeof(item_t), WORDS_SLOTS);
    order->moved_ns = ale_rt_now_ns();
    if (!order->acquired || !order->told || !order->later) {
        ale_flight_order_destroy(order);
        return NULL;
    }
    return order;
}

void ale_flight_order_destroy(ale_flight_order_t *order)
{
    if (order) {
        ale_ring_destroy(order->acquired);
        ale_ring_destroy(order->told);
        ale_ring_destroy(order->later);
        free(order);
    }
}

void ale_flight_order_acquired(ale_flight_order_t *order, const ale_flight_head_t *head, const void *bytes)
{
    put(order->acquired, head, bytes);
}

void ale_flight_order_told(ale_flight_order_t *order, const ale_flight_head_t *head, const void *bytes)
{
    put(order->told, head, bytes);
}

uint32_t ale_flight_order_refused(const ale_flight_order_t *order)
{
    return ale_ring_refused(order->acquired) + ale_ring_refused(order->told) + ale_ring_refused(order->later);
}
