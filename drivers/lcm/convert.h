/* Between the core's integers and LCM's messages: SI units, radians, float. Pure functions.
 *
 * A message with arrays borrows the memory of its *_buffer_t: valid until that is used again. */
#ifndef ALE_LCM_CONVERT_H
#define ALE_LCM_CONVERT_H

#include <lcmtypes_ale_features_t.h>
#include <lcmtypes_ale_graph_t.h>
#include <lcmtypes_ale_map_pieces_t.h>
#include <lcmtypes_ale_map_t.h>
#include <lcmtypes_ale_odometry_t.h>
#include <lcmtypes_ale_plan_t.h>
#include <lcmtypes_ale_pose_t.h>
#include <lcmtypes_ale_scan_t.h>
#include <lcmtypes_ale_status_t.h>
#include <lcmtypes_ale_tracking_t.h>

#include "lcm/report.h"

/* Lines and corners of one part of a map, and lines of one part of its pieces: with its header each stays
 * below 1400 bytes. */
enum { ALE_MAP_PART_LINES = 36, ALE_MAP_PART_CORNERS = 44, ALE_PIECES_PART_LINES = 160 };

typedef struct {
    lcmtypes_ale_line_t line[ALE_MAX_LINES];
    lcmtypes_ale_corner_t corner[ALE_MAX_CORNERS];
} ale_features_buffer_t;

typedef struct {
    int16_t range[ALE_MAX_BEAMS];
    uint8_t code[ALE_MAX_BEAMS];
} ale_scan_buffer_t;

typedef struct {
    lcmtypes_ale_map_line_t line[ALE_MAP_PART_LINES];
    lcmtypes_ale_corner_t corner[ALE_MAP_PART_CORNERS];
} ale_map_buffer_t;

typedef struct {
    int32_t line_id[ALE_PIECES_PART_LINES];
    int32_t map_id[ALE_PIECES_PART_LINES];
} ale_pieces_buffer_t;

typedef struct {
    float x[ALE_PLAN_POINTS];
    float y[ALE_PLAN_POINTS];
} ale_plan_buffer_t;

typedef struct {
    int32_t scan[ALE_GRAPH_KEYFRAMES];
    float x[ALE_GRAPH_KEYFRAMES];
    float y[ALE_GRAPH_KEYFRAMES];
    float theta[ALE_GRAPH_KEYFRAMES];
    int32_t map_id[ALE_GRAPH_KEYFRAMES];
    int8_t tied[ALE_GRAPH_KEYFRAMES];
    int16_t loop_from[ALE_GRAPH_LOOPS];
    int16_t loop_to[ALE_GRAPH_LOOPS];
    int8_t loop_kind[ALE_GRAPH_LOOPS];
} ale_graph_buffer_t;

typedef struct {
    char *name[ALE_STATUS_COUNTERS];
    int64_t value[ALE_STATUS_COUNTERS];
} ale_status_buffer_t;

float ale_to_metres(int64_t um);
float ale_to_radians(uint32_t angle_bam); /* -pi to pi */
uint32_t ale_from_radians(double angle);  /* any finite angle */
int32_t ale_from_metres(double metres);   /* saturates at +-2147 m */

void ale_convert_pose(const ale_pose_report_t *report, lcmtypes_ale_pose_t *message);

/* estimate->stamp_us is already a utime. */
void ale_convert_tracking(const ale_estimate_t *estimate, lcmtypes_ale_tracking_t *message);

/* Features of scan number `scan` at `utime`; `sensor` is the mounting. */
void ale_convert_features(const ale_features_t *features, int64_t utime, uint32_t scan, ale_pose_t sensor,
                          ale_features_buffer_t *buffer, lcmtypes_ale_features_t *message);

/* Ranges in the smallest whole number of millimetres a unit that fits 16 bits; 0 where there is none, the
 * code then says why. utime: of the stamp beam. */
void ale_convert_scan(const ale_scan_t *scan, int64_t utime, uint32_t number, ale_pose_t sensor,
                      ale_scan_buffer_t *buffer, lcmtypes_ale_scan_t *message);

/* Part 0..parts-1: corners and lines in the order of the map, lines first. */
void ale_convert_map(const ale_map_t *map, int64_t utime, int16_t part, ale_map_buffer_t *buffer,
                     lcmtypes_ale_map_t *message);

/* Part 0..parts-1 of the lines that are in other maps than the first, in the order of the map. */
void ale_convert_map_pieces(const ale_map_t *map, int64_t utime, int16_t part, ale_pieces_buffer_t *buffer,
                            lcmtypes_ale_map_pieces_t *message);

/* The message points into the report, too. */
void ale_convert_plan(const ale_plan_report_t *report, ale_plan_buffer_t *buffer,
                      lcmtypes_ale_plan_t *message);

/* Keyframes and loops in their order. */
void ale_convert_graph(const ale_mapper_graph_t *graph, int64_t utime, uint32_t version,
                       ale_graph_buffer_t *buffer, lcmtypes_ale_graph_t *message);

/* The message points into the report. */
void ale_convert_status(const ale_status_report_t *report, ale_status_buffer_t *buffer,
                        lcmtypes_ale_status_t *message);

void ale_convert_odometry(const ale_odometry_t *sample, lcmtypes_ale_odometry_t *message);

/* What came in, taken as hostile: 0, or -1 when a number is not finite, beyond 2000 m or 10^6 radians, or the
 * time is not positive (then *sample is untouched). Its stamp is the message's utime. */
int ale_take_odometry(const lcmtypes_ale_odometry_t *message, ale_odometry_t *sample);

#endif
