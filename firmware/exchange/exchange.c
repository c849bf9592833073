#include "exchange/exchange.h"

#include <string.h>

#include "base/fixed.h"
#include "exchange/wake.h"
#include "graph/mapper.h"
#include "operator/drive.h"
#include "scanner/scanner.h"

#define LOOK_NS 250000

int ale_exchange_open(ale_exchange_t *exchange, ale_clock_t clock)
{
    *exchange = (ale_exchange_t){
        .clock = clock,
        .scans = ale_ring_create(sizeof(ale_scan_record_t), ALE_SCAN_SLOTS),
        .odometry = ale_ring_create(sizeof(ale_odometry_t), ALE_ODOMETRY_SLOTS),
        .results = ale_ring_create(sizeof(ale_result_t), ALE_RESULT_SLOTS),
        .keyframes = ale_ring_create(sizeof(ale_keyframe_t), ALE_KEYFRAME_SLOTS),
        .corrections = ale_ring_create(sizeof(ale_correction_t), ALE_CORRECTION_SLOTS),
        .grid_corrections = ale_ring_create(sizeof(ale_correction_t), ALE_CORRECTION_SLOTS),
        .sightings = ale_ring_create(sizeof(ale_scan_observation_t), ALE_SIGHTING_SLOTS),
        .keyframe_poses = ale_snapshot_create(sizeof(ale_mapper_poses_t)),
        .drawn_map = ale_snapshot_create(sizeof(ale_drawn_map_t)),
        .map = ale_snapshot_create(sizeof(ale_map_t)),
        .health = ale_snapshot_create(sizeof(ale_scanner_health_t)),
        .requests = ale_ring_create(sizeof(ale_request_t), ALE_REQUEST_SLOTS),
        .loaded_map = ale_snapshot_create(sizeof(ale_loaded_map_t)),
        .known_to_mapper = ale_snapshot_create(sizeof(ale_loaded_map_t)),
        .known_to_drawer = ale_snapshot_create(sizeof(ale_loaded_map_t)),
        .drive_orders = ale_snapshot_create(sizeof(ale_drive_orders_t)),
        .drive_scan = ale_snapshot_create(sizeof(ale_scan_t)),
        .exploration = ale_snapshot_create(sizeof(ale_velocity_request_t)),
        .drive_again = ale_wake_open(),
        .arrived = ale_rt_release_create(),
        .heartbeat = ale_heartbeat_create(),
        .under_way = ale_wake_open(),
    };
    const bool complete = exchange->scans && exchange->odometry && exchange->results && exchange->keyframes &&
                          exchange->corrections && exchange->grid_corrections && exchange->sightings &&
                          exchange->keyframe_poses && exchange->drawn_map && exchange->map &&
                          exchange->health && exchange->requests && exchange->loaded_map &&
                          exchange->known_to_mapper && exchange->known_to_drawer && exchange->drive_orders &&
                          exchange->drive_scan && exchange->exploration && exchange->drive_again >= 0 &&
                          exchange->arrived && exchange->heartbeat && exchange->under_way >= 0;
    if (!complete) {
        ale_exchange_close(exchange);
    }
    return complete ? 0 : -1;
}

void ale_exchange_close(ale_exchange_t *exchange)
{
    ale_ring_destroy(exchange->scans);
    ale_ring_destroy(exchange->odometry);
    ale_ring_destroy(exchange->results);
    ale_ring_destroy(exchange->keyframes);
    ale_ring_destroy(exchange->corrections);
    ale_ring_destroy(exchange->grid_corrections);
    ale_ring_destroy(exchange->sightings);
    ale_snapshot_destroy(exchange->keyframe_poses);
    ale_snapshot_destroy(exchange->drawn_map);
    ale_snapshot_destroy(exchange->map);
    ale_snapshot_destroy(exchange->health);
    ale_ring_destroy(exchange->requests);
    ale_snapshot_destroy(exchange->loaded_map);
    ale_snapshot_destroy(exchange->known_to_mapper);
    ale_snapshot_destroy(exchange->known_to_drawer);
    ale_snapshot_destroy(exchange->drive_orders);
    ale_snapshot_destroy(exchange->drive_scan);
    ale_snapshot_destroy(exchange->exploration);
    ale_wake_close(exchange->drive_again);
    ale_rt_release_destroy(exchange->arrived);
    ale_heartbeat_destroy(exchange->heartbeat);
    ale_wake_close(exchange->under_way);
    memset(exchange, 0, sizeof *exchange);
    exchange->drive_again = exchange->under_way = -1;
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
