#include "exchange/exchange.h"

#include <stddef.h>
#include <string.h>

#include "base/fixed.h"
#include "exchange/wake.h"
#include "graph/mapper.h"
#include "scanner/scanner.h"

#define LOOK_NS 250000

/* A ring or a snapshot of the exchange: which member it is, and the size of what lies in it. */
typedef struct {
    size_t member;
    uint32_t bytes;
    uint32_t slots; /* of a ring */
} channel_t;

#define SNAPSHOT(name, type)                                                                                 \
    {                                                                                                        \
        .member = offsetof(ale_exchange_t, name), .bytes = sizeof(type)                                      \
    }
#define RING(name, type, count)                                                                              \
    {                                                                                                        \
        offsetof(ale_exchange_t, name), sizeof(type), count                                                  \
    }

static const channel_t rings[] = {
    RING(scans, ale_scan_record_t, ALE_SCAN_SLOTS),
    RING(odometry, ale_odometry_t, ALE_ODOMETRY_SLOTS),
    RING(results, ale_result_t, ALE_RESULT_SLOTS),
    RING(requests, ale_request_t, ALE_REQUEST_SLOTS),
    RING(keyframes, ale_keyframe_t, ALE_KEYFRAME_SLOTS),
    RING(corrections, ale_correction_t, ALE_CORRECTION_SLOTS),
    RING(grid_corrections, ale_correction_t, ALE_CORRECTION_SLOTS),
    RING(observations, ale_scan_observation_t, ALE_OBSERVATION_SLOTS),
    RING(whereabouts, ale_whereabouts_t, ALE_WHEREABOUTS_SLOTS),
    RING(tiles, ale_tile_change_t, ALE_TILE_SLOTS),
    RING(tiles_to_mapper, ale_tile_change_t, ALE_TILE_SLOTS),
};

static const channel_t snapshots[] = {
    SNAPSHOT(health, ale_scanner_health_t),        SNAPSHOT(map, ale_tracked_map_t),
    SNAPSHOT(keyframe_poses, ale_mapper_poses_t),  SNAPSHOT(graph, ale_mapper_graph_t),
    SNAPSHOT(drawn_map, ale_drawn_map_t),          SNAPSHOT(loaded_map, ale_loaded_map_t),
    SNAPSHOT(known_to_mapper, ale_loaded_map_t),   SNAPSHOT(known_to_drawer, ale_loaded_map_t),
    SNAPSHOT(drive_orders, ale_drive_orders_t),    SNAPSHOT(drive_scan, ale_scan_t),
    SNAPSHOT(exploration, ale_velocity_request_t), SNAPSHOT(motor_line, int),
};

enum { RINGS = sizeof rings / sizeof rings[0], SNAPSHOTS = sizeof snapshots / sizeof snapshots[0] };

static ale_ring_t **ring_of(ale_exchange_t *exchange, int k)
{
    return (ale_ring_t **)(void *)((char *)exchange + rings[k].member);
}

static ale_snapshot_t **snapshot_of(ale_exchange_t *exchange, int k)
{
    return (ale_snapshot_t **)(void *)((char *)exchange + snapshots[k].member);
}

static bool open_rings(ale_exchange_t *exchange)
{
    bool complete = true;
    for (int k = 0; k < RINGS; k++) {
        *ring_of(exchange, k) = ale_ring_create(rings[k].bytes, rings[k].slots);
        complete = complete && *ring_of(exchange, k);
    }
    return complete;
}

static bool open_snapshots(ale_exchange_t *exchange)
{
    bool complete = true;
    for (int k = 0; k < SNAPSHOTS; k++) {
        *snapshot_of(exchange, k) = ale_snapshot_create(snapshots[k].bytes);
        complete = complete && *snapshot_of(exchange, k);
    }
    return complete;
}

static bool open_signals(ale_exchange_t *exchange)
{
    exchange->arrived = ale_rt_release_create();
    exchange->heartbeat = ale_heartbeat_create();
    exchange->drive_again = ale_wake_open();
    exchange->under_way = ale_wake_open();
    return exchange->arrived && exchange->heartbeat && exchange->drive_again >= 0 && exchange->under_way >= 0;
}

int ale_exchange_open(ale_exchange_t *exchange, ale_clock_t clock)
{
    *exchange = (ale_exchange_t){.clock = clock, .drive_again = -1, .under_way = -1};
    if (open_rings(exchange) && open_snapshots(exchange) && open_signals(exchange)) {
        return 0;
    }
    ale_exchange_close(exchange);
    return -1;
}

void ale_exchange_close(ale_exchange_t *exchange)
{
    for (int k = 0; k < RINGS; k++) {
        ale_ring_destroy(*ring_of(exchange, k));
    }
    for (int k = 0; k < SNAPSHOTS; k++) {
        ale_snapshot_destroy(*snapshot_of(exchange, k));
    }
    ale_rt_release_destroy(exchange->arrived);
    ale_heartbeat_destroy(exchange->heartbeat);
    ale_wake_close(exchange->drive_again);
    ale_wake_close(exchange->under_way);
    *exchange = (ale_exchange_t){.drive_again = -1, .under_way = -1};
}

static void hand_over(ale_snapshot_t *snapshot, const ale_map_t *map, uint32_t number)
{
    ale_loaded_map_t *back = ale_snapshot_back(snapshot);
    back->number = number;
    memcpy(&back->map, map, sizeof *map);
    ale_snapshot_publish(snapshot);
}

uint32_t ale_exchange_know(ale_exchange_t *exchange, const ale_map_t *map)
{
    const uint32_t number = ++exchange->maps_loaded;
    hand_over(exchange->known_to_mapper, map, number);
    hand_over(exchange->known_to_drawer, map, number);
    return number;
}

void ale_exchange_load(ale_exchange_t *exchange, const ale_map_t *map)
{
    hand_over(exchange->loaded_map, map, ale_exchange_know(exchange, map));
}

/* What is on its way is read first: a result that comes in between is then seen as ready. */
int64_t ale_exchange_result_wait_ns(const ale_exchange_t *exchange, int64_t otherwise_ns)
{
    const bool on_its_way = ale_ring_committed(exchange->scans) !=
                            ale_ring_committed(exchange->results) + ale_ring_refused(exchange->results);
    if (ale_ring_ready(exchange->results) > 0) {
        return 0;
    }
    return on_its_way ? ale_min64(otherwise_ns, LOOK_NS) : otherwise_ns;
}
