/* The flight recorder's two queues, brought into the order in which the estimate task used what lies in them:
 * odometry before the scan that knew it, the bytes of a scan before what came of it.
 *
 *   acquire thread ─── bytes, scans ───────► queue ─┐
 *                                                   ├─► recorder's thread ──► flight ring
 *   telemetry thread ─ odometry, results ──► queue ─┘
 *
 * Writers never wait: what finds its queue full is refused and counted. */
#ifndef ALE_FIRMWARE_RECORDER_FLIGHT_ORDER_H
#define ALE_FIRMWARE_RECORDER_FLIGHT_ORDER_H

#include "recorder/flight_ring.h"

enum { ALE_FLIGHT_ITEM_BYTES = 512 };

typedef enum {
    ALE_FLIGHT_CHUNK, /* goes to the ring as it is */
    ALE_FLIGHT_SCAN,  /* the bytes before it made this scan; no bytes of its own */
    ALE_FLIGHT_RESULT /* what came of a scan: an ale_flight_result_t */
} ale_flight_item_type_t;

typedef struct {
    ale_flight_item_type_t type;
    ale_chunk_kind_t kind; /* of a chunk */
    uint32_t number;       /* of the sample of odometry, or of the scan */
    int64_t stamp_us;      /* of a chunk */
    uint32_t length;       /* in bytes, at most ALE_FLIGHT_ITEM_BYTES */
} ale_flight_head_t;

typedef struct ale_flight_order ale_flight_order_t;

/* The ring, which must outlive it, is filled by ale_flight_order_move and _flush alone. NULL: out of memory.
 */
ale_flight_order_t *ale_flight_order_create(ale_flight_ring_t *flight);
void ale_flight_order_destroy(ale_flight_order_t *order); /* NULL: nothing */

/* Copies an item into the queue of the acquire thread: bytes and scans; and into that of the telemetry
 * thread: all else. Each from its thread alone; no waiting. */
void ale_flight_order_acquired(ale_flight_order_t *order, const ale_flight_head_t *head, const void *bytes);
void ale_flight_order_told(ale_flight_order_t *order, const ale_flight_head_t *head, const void *bytes);

/* Recorder's thread: moves all scans that are complete into the ring; and everything as it came when that
 * makes no scan for a second or a queue is half full. now_ns: of ale_rt_now_ns. */
void ale_flight_order_move(ale_flight_order_t *order, int64_t now_ns);

/* Recorder's thread: everything into the ring as it came. */
void ale_flight_order_flush(ale_flight_order_t *order);

/* Any thread: items that found no room. */
uint32_t ale_flight_order_refused(const ale_flight_order_t *order);

#endif
