/* What passes between the threads, and nothing else does.
 *
 *            scans, lost scans                  results
 *   acquire ───────────────────► estimate ───────────────────► telemetry
 *      │                            ▲  └──── map (newest) ────────►  ▲
 *      │                            └─────── odometry ───────────────┤
 *      └──────────── health of the scanner (newest) ─────────────────┘
 *
 *              requests                  orders, scan (newest)
 *   estimate ◄──────────── telemetry ◄─ motor line ────► drive ◄── velocity request (newest) ── exploration
 *      ▲                      ▲ jobs  └──── scans with poses, on or off ───────────────────────────►┘
 *      └── loaded map ── map storage ── the same map ──► mapper, drawer
 *   estimate ── keyframes ──► mapper ── corrections ──► estimate, exploration
 *      └── scan observations ──► drawer ◄── keyframe poses (newest) ──┘
 *                                  └── drawn map (newest) ──► telemetry ◄── pose graph (newest) ── mapper
 *   estimate ── whereabouts ──► tile loader ── tiles ──► estimate, mapper
 *
 * Rings and snapshots have one writer and one reader each. Times are of the clock inside (clock.h). */
#ifndef ALE_FIRMWARE_EXCHANGE_EXCHANGE_H
#define ALE_FIRMWARE_EXCHANGE_EXCHANGE_H

#include <stdbool.h>
#include <stdint.h>

#include "exchange/heartbeat.h"
#include "exchange/ring.h"
#include "exchange/snapshot.h"
#include "exchange/thread_messages.h"
#include "map/tile_change.h"
#include "realtime/clock.h"
#include "realtime/rt.h"
#include "track/correction.h"
#include "track/keyframe.h"
#include "track/scan_observation.h"

/* A new map goes on to telemetry and the drawer this long after the last one at the earliest: maps are large.
 */
enum { ALE_MAP_PERIOD_NS = 1000000000 };

/* Several seconds of scans at 10 Hz, and of odometry at 100 Hz; requests are those of people. */
enum { ALE_SCAN_SLOTS = 64, ALE_RESULT_SLOTS = 64, ALE_ODOMETRY_SLOTS = 512, ALE_REQUEST_SLOTS = 16 };

/* Keyframes of several metres, should the mapper be at work on a large map. */
enum { ALE_KEYFRAME_SLOTS = 16, ALE_CORRECTION_SLOTS = 4 };

/* Scan observations of several metres, should a large map be drawn just now. */
enum { ALE_OBSERVATION_SLOTS = 32 };

/* Whereabouts of eight seconds, should a disk be slow; pieces of tiles for so many scans: the loader waits
 * for room. */
enum { ALE_WHEREABOUTS_SLOTS = 16, ALE_TILE_SLOTS = 32 };

typedef struct {
    ale_clock_t clock;
    /* A scan's way, from acquire to telemetry. */
    ale_ring_t *scans;          /* ale_scan_record_t: acquire to estimate */
    ale_ring_t *odometry;       /* ale_odometry_t: telemetry to estimate */
    ale_ring_t *requests;       /* ale_request_t: telemetry to estimate */
    ale_ring_t *results;        /* ale_result_t: estimate to telemetry */
    ale_snapshot_t *map;        /* ale_tracked_map_t: estimate to telemetry */
    ale_snapshot_t *health;     /* ale_scanner_health_t: acquire to telemetry */
    ale_rt_release_t *arrived;  /* releases the estimate task */
    ale_heartbeat_t *heartbeat; /* of the estimate task: ten beats a second or more */
    int under_way; /* wakes telemetry: a scan has gone to the estimate task, or health has changed */

    /* Mapping. */
    ale_ring_t *keyframes;           /* ale_keyframe_t: estimate to mapper */
    ale_ring_t *corrections;         /* ale_correction_t: mapper to estimate */
    ale_ring_t *grid_corrections;    /* the same: mapper to exploration, when there is one */
    ale_ring_t *observations;        /* ale_scan_observation_t: estimate to drawer */
    ale_snapshot_t *keyframe_poses;  /* ale_mapper_poses_t: mapper to drawer */
    ale_snapshot_t *graph;           /* ale_mapper_graph_t: mapper to telemetry */
    ale_snapshot_t *drawn_map;       /* ale_drawn_map_t: drawer to telemetry */
    ale_snapshot_t *loaded_map;      /* ale_loaded_map_t: map storage to estimate */
    ale_ring_t *whereabouts;         /* ale_whereabouts_t: estimate to tile loader, when there is one */
    ale_ring_t *tiles;               /* ale_tile_change_t: tile loader to estimate */
    ale_ring_t *tiles_to_mapper;     /* the same: to mapper */
    ale_snapshot_t *known_to_mapper; /* ale_loaded_map_t, the one that is or will be driven in: */
    ale_snapshot_t *known_to_drawer; /* map storage to both */

    /* Driving. */
    ale_snapshot_t *drive_orders; /* ale_drive_orders_t: telemetry to drive */
    ale_snapshot_t *drive_scan;   /* ale_scan_t: telemetry to drive */
    ale_snapshot_t *exploration;  /* ale_velocity_request_t: exploration to drive */
    ale_snapshot_t *motor_line;   /* int, ale_port_strerror knows it: drive to telemetry */
    int drive_again;              /* wakes the drive thread: something has changed */

    /* Who is spoken to by call, when he is wanted; NULL: not. */
    struct ale_explore *explore;         /* by telemetry */
    struct ale_recorder *recorder;       /* by acquire and telemetry */
    struct ale_persistence *persistence; /* by telemetry: map and pose */
    uint32_t maps_loaded;                /* so far */
    bool has_tiles;                      /* there is a tile loader */
} ale_exchange_t;

/* Everything allocated and touched. 0, or -1: out of memory or descriptors (nothing is left open). */
int ale_exchange_open(ale_exchange_t *exchange, ale_clock_t clock);
void ale_exchange_close(ale_exchange_t *exchange);

/* The map that is going to be driven in, for mapper and drawer; before the estimate task hears of it. Its
 * number. One thread at a time. */
uint32_t ale_exchange_know(ale_exchange_t *exchange, const ale_map_t *map);

/* The same, and for the estimate task, which takes it up when that is requested. */
void ale_exchange_load(ale_exchange_t *exchange, const ale_map_t *map);

/* Telemetry: how long it may sleep for the sake of results. Not at all when one is ready, a quarter of a
 * millisecond while a scan is on its way to become one, else `otherwise_ns`. */
int64_t ale_exchange_result_wait_ns(const ale_exchange_t *exchange, int64_t otherwise_ns);

#endif
