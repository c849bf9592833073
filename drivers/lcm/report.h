/* What goes out over LCM, still in the core's integers: filled by those who know, turned into messages by
 * convert.h. Times are microseconds of the messages' clock (utime): since 1970, of the robot. */
#ifndef ALE_LCM_REPORT_H
#define ALE_LCM_REPORT_H

#include <stdbool.h>
#include <stdint.h>

#include "base/stage.h"
#include "command/command.h"
#include "graph/mapper_graph.h"
#include "track/pipeline.h"

/* ALE_POSE: the estimate (its stamp_us already a utime) and how long its scan was under way. */
typedef struct {
    ale_estimate_t estimate;
    int64_t first_beam_us;
    int64_t arrival_us; /* last byte of the scan */
    int64_t sent_us;
    int32_t stage_ns[ALE_STAGES];
    int32_t stage_start_ns[ALE_STAGES]; /* after the arrival, real time; 0: did not run */
    int32_t stage_end_ns[ALE_STAGES];
} ale_pose_report_t;

/* ALE_MAP: number of parts that a map needs, at least 1. */
int16_t ale_map_parts(const ale_map_t *map);

/* ALE_MAP_PIECES: number of parts for its lines that are in other maps than the first, at least 1. */
int16_t ale_map_pieces_parts(const ale_map_t *map);

enum { ALE_STATUS_STAGES = ALE_STAGES + 1, ALE_STATUS_COUNTERS = 48 };

enum { ALE_ANSWER_BYTES = 160 }; /* of an answer in words, with its end */

typedef struct {
    const char *name; /* a constant text */
    uint64_t value;
} ale_counter_t;

/* ALE_SPEAKER: a program that is a robot's firmware. */
typedef struct {
    int64_t now_us;
    int64_t boot; /* nonce of its start */
    int32_t process;
    char host[64];
    char robot[ALE_NAME_BYTES];
} ale_speaker_t;

/* The operator's side of the robot. */
typedef struct {
    char robot[ALE_NAME_BYTES];
    bool takes_commands;
    char who_drives[ALE_NAME_BYTES]; /* empty: nobody */
    char exploration[ALE_ANSWER_BYTES];
    bool map_frozen;
    char command_operator[ALE_NAME_BYTES]; /* of the last genuine command; empty: none yet */
    int64_t command_counter;
    bool command_obeyed;
    char command_result[ALE_ANSWER_BYTES];
} ale_operation_report_t;

enum { ALE_PLAN_POINTS = 64 };

typedef enum {
    ALE_PLAN_OFF,
    ALE_PLAN_EXPLORES,
    ALE_PLAN_RETURNS,
    ALE_PLAN_GOES,
    ALE_PLAN_ARRIVED,
    ALE_PLAN_GIVEN_UP
} ale_plan_state_t;

/* ALE_PLAN: what the robot drives by itself. */
typedef struct {
    int64_t now_us;
    ale_plan_state_t state;
    char words[ALE_ANSWER_BYTES];
    bool has_place;
    ale_point_t place;
    uint32_t points; /* 0: no path */
    ale_point_t point[ALE_PLAN_POINTS];
} ale_plan_report_t;

/* ALE_STATUS. The last of the stages is their sum. */
typedef struct {
    int64_t now_us;
    int64_t boot; /* nonce of this start */
    uint32_t scans;
    uint32_t poses;
    uint8_t state; /* ale_state_t */
    int64_t stage_last_ns[ALE_STATUS_STAGES];
    int64_t stage_p99_ns[ALE_STATUS_STAGES];
    int64_t stage_worst_ns[ALE_STATUS_STAGES];
    int64_t latency_p50_ns; /* last byte of a scan to its pose on the wire */
    int64_t latency_p99_ns;
    int64_t latency_worst_ns;
    uint32_t deadline_misses;
    bool realtime;
    char realtime_detail[440];
    char driver_state[192];
    char device[160];
    int32_t scan_period_us; /* 0: unknown */
    uint32_t counters;
    ale_counter_t counter[ALE_STATUS_COUNTERS];
    ale_operation_report_t operation;
} ale_status_report_t;

#endif
