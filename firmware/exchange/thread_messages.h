/* What the threads hand to each other through the exchange: one structure for each kind of message. What is
 * not here is a type of lib's: odometry, keyframes, corrections, scan observations, maps. Times are of the
 * clock inside (realtime/clock.h). */
#ifndef ALE_FIRMWARE_EXCHANGE_THREAD_MESSAGES_H
#define ALE_FIRMWARE_EXCHANGE_THREAD_MESSAGES_H

#include <stdbool.h>
#include <stdint.h>

#include "base/noise.h"
#include "base/scan.h"
#include "base/stage.h"
#include "track/pipeline.h"

/* From acquire to estimate: a scan as the device sent it. */
typedef struct {
    bool lost;          /* the device sent it, it cannot be used: scan.stamp_us alone counts */
    int64_t arrival_us; /* last byte */
    ale_noise_t noise;  /* of the scanner that sent it; out of range: no other than before */
    ale_scan_t scan;
} ale_scan_record_t;

/* From estimate to telemetry: the answer to one scan. */
typedef struct {
    ale_estimate_t estimate;
    int64_t first_beam_us;
    int64_t arrival_us;
    int32_t stage_ns[ALE_STAGES];
    int32_t stage_start_ns[ALE_STAGES]; /* first start and last end of each stage after the arrival, real */
    int32_t stage_end_ns[ALE_STAGES];   /* time; 0: it did not run */
    int32_t total_ns;
    uint32_t overloaded;       /* scans set aside since the start, for newer ones */
    uint32_t corrections_late; /* of the map, since the start */
    uint32_t late;             /* scans answered after their deadline, since the start */
    uint32_t answered;         /* scans answered before this one, since the start: its number in `scans` */
    uint32_t map_moves;      /* so often the map was moved under the robot, or taken away, before this pose */
    uint32_t odometry_taken; /* samples of `odometry` known to this answer, since the start */
    bool corrected;          /* the map was corrected before this answer: */
    ale_pose_t correction;   /* how the robot moved with it */
    bool has_scan;           /* a scan stands behind it: features and scan are set */
    ale_features_t features;
    ale_scan_t scan; /* only when scans are published */
} ale_result_t;

/* From estimate to telemetry: the tracker's map. A pose belongs to it whose result tells the same moves. */
typedef struct {
    ale_map_t map;
    uint32_t moves;
} ale_tracked_map_t;

/* A map that was read from a file. Each has a number of its own: who is told of a map, and later of what was
 * seen in it, knows whether both are the same. */
typedef struct {
    uint32_t number; /* from 1; 0: none yet */
    ale_map_t map;
} ale_loaded_map_t;

/* The map that the robot is in as it was drawn anew. */
typedef struct {
    uint32_t epoch; /* 0: nothing was drawn yet */
    ale_map_t map;  /* its lines name the map that they are in */
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

/* A velocity that an operator or the exploration asks for, until a moment. All zero: none. */
typedef struct {
    int32_t v_um_s;
    int32_t w_urad_s;
    int64_t valid_until_us;
} ale_velocity_request_t;

/* From telemetry to drive. */
typedef struct {
    ale_velocity_request_t operator_request;
    bool exploring; /* exploration may drive when the operator does not */
} ale_drive_orders_t;

#endif
