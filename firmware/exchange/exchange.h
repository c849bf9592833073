/* What passes between the threads, and nothing else does.
 *
 *            scans, lost scans                  results
 *   acquire ───────────────────► estimate ───────────────────► telemetry
 *      │                            ▲  └──── map (newest) ────────►  ▲
 *      │                            └─────── odometry ───────────────┤
 *      └──────────── health of the scanner (newest) ─────────────────┘
 *
 *              requests                  orders, scan (newest)
 *   estimate ◄──────────── telemetry ──────────────────────────► drive ◄── request (newest) ── exploration
 *      ▲                      ▲ jobs  └──── scans with poses, on or off ───────────────────────►┘
 *      └── loaded map ── map storage ── the same map ──► mapper, drawer
 *   estimate ── keyframes ──► mapper ── corrections ──► estimate, exploration
 *      └── sightings ──► drawer ◄── keyframe poses (newest) ──┘
 *                          └── drawn map (newest) ──► telemetry
 *
 * Rings and snapshots have one writer and one reader each. Times are of the clock inside (clock.h). */
#ifndef ALE_FIRMWARE_EXCHANGE_EXCHANGE_H
#define ALE_FIRMWARE_EXCHANGE_EXCHANGE_H

#include <stdbool.h>
#include <stdint.h>

#include "base/scan.h"
#include "base/stage.h"
#include "config/config.h"
#include "exchange/ring.h"
#include "exchange/snapshot.h"
#include "realtime/rt.h"
#include "system/clock.h"
#include "system/heartbeat.h"
#include "track/correction.h"
#include "track/keyframe.h"
#include "track/pipeline.h"
#include "track/scan_observation.h"

/* Several seconds of scans at 10 Hz, and of odometry at 100 Hz; requests are those of people. */
enum { ALE_SCAN_SLOTS = 64, ALE_RESULT_SLOTS = 64, ALE_ODOMETRY_SLOTS = 512, ALE_REQUEST_SLOTS = 16 };

/* Keyframes of several metres, should the mapper be at work on a large map. */
enum { ALE_KEYFRAME_SLOTS = 16, ALE_CORRECTION_SLOTS = 4 };

/* Sightings of several metres, should a large map be drawn just now. */
enum { ALE_SIGHTING_SLOTS = 32 };

typedef struct {
    bool lost;          /* the device sent it, it cannot be used: scan.stamp_us alone counts */
    int64_t arrival_us; /* last byte */
    ale_scan_t scan;
} ale_scan_record_t;

typedef struct {
    ale_estimate_t estimate;
    int64_t first_beam_us;
    int64_t arrival_us;
    int32_t stage_ns[ALE_STAGES];
    int32_t stage_start_ns[ALE_STAGES]; /* first start and last end of each stage after the arrival, real */
    int32_t stage_end_ns[ALE_STAGES];   /* time; 0: it did not run */
    int32_t total_ns;
    uint32_t overloaded;     /* scans set aside since the start, for newer ones */
    uint32_t late;           /* scans answered after their deadline, since the start */
    uint32_t answered;       /* scans answered before this one, since the start: its number in `scans` */
    uint32_t odometry_taken; /* samples of `odometry` known to this answer, since the start */
    bool corrected;          /* the map was corrected before this answer: */
    ale_pose_t correction;   /* how the robot moved with it */
    bool has_scan;           /* a scan stands behind it: features and scan are set */
    ale_features_t features;
    ale_scan_t scan; /* only when scans are published */
} ale_result_t;

/* A map that was read from a file. Each has a number of its own: who is told of a map, and later of what was
 * seen in it, knows whether both are the same. */
typedef struct {
    uint32_t number; /* from 1; 0: none yet */
    ale_map_t map;
} ale_loaded_map_t;

/* The map as it was drawn anew. */
typedef struct {
    uint32_t epoch; /* 0: nothing was drawn yet */
    ale_map_t map;
} ale_drawn_map_t;

typedef enum {
    ALE_REQUEST_RESET,
    ALE_REQUEST_RELOCATE, /* the robot is at `pose` of the map */
    ALE_REQUEST_LOAD_MAP, /* at `pose`, if that is known; otherwise lost until found */
    ALE_REQUEST_FREEZE,   /* the map is only looked at, while `on` */
} ale_request_kind_t;

/* What an operator wants of the estimate task, done between two scans. */
typedef struct {
    ale_request_kind_t kind;
    bool pose_known;
    bool on;
    ale_pose_t pose;
} ale_request_t;

typedef struct {
    ale_clock_t clock;
    ale_ring_t *scans;                   /* ale_scan_record_t: acquire to estimate */
    ale_ring_t *odometry;                /* ale_odometry_t: telemetry to estimate */
    ale_ring_t *results;                 /* ale_result_t: estimate to telemetry */
    ale_ring_t *keyframes;               /* ale_keyframe_t: estimate to mapper */
    ale_ring_t *corrections;             /* ale_correction_t: mapper to estimate */
    ale_ring_t *grid_corrections;        /* the same: mapper to exploration, when there is one */
    ale_ring_t *sightings;               /* ale_scan_observation_t: estimate to drawer */
    ale_snapshot_t *keyframe_poses;      /* ale_mapper_poses_t: mapper to drawer */
    ale_snapshot_t *drawn_map;           /* ale_drawn_map_t: drawer to telemetry */
    ale_snapshot_t *map;                 /* ale_map_t, the tracker's: estimate to telemetry */
    ale_snapshot_t *health;              /* ale_scanner_health_t: acquire to telemetry */
    ale_ring_t *requests;                /* ale_request_t: telemetry to estimate */
    ale_snapshot_t *loaded_map;          /* ale_loaded_map_t: map storage to estimate */
    ale_snapshot_t *known_to_mapper;     /* ale_loaded_map_t, the one that is or will be driven in: */
    ale_snapshot_t *known_to_drawer;     /* map storage to both */
    ale_snapshot_t *drive_orders;        /* ale_drive_orders_t: telemetry to drive */
    ale_snapshot_t *drive_scan;          /* ale_scan_t: telemetry to drive */
    ale_snapshot_t *exploration;         /* ale_velocity_request_t: exploration to drive */
    ale_rt_release_t *arrived;           /* releases the estimate task */
    struct ale_explore *explore;         /* is told by telemetry; NULL: nobody may ask for it */
    struct ale_recorder *recorder;       /* is told by acquire and telemetry; NULL: none is wanted */
    struct ale_persistence *persistence; /* is offered map and pose by telemetry; NULL: none is wanted */
    ale_heartbeat_t *heartbeat;          /* of the estimate task: ten beats a second or more */
    int drive_again;                     /* wakes the drive thread (wake.h): something has changed */
    int under_way;        /* event descriptor: a scan has gone to the estimate task, or health has changed */
    uint32_t maps_loaded; /* so far */
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
