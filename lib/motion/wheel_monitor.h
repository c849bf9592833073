/* What wheels do wrong: their displacements held against those that scans have found, over the last second or
 * two. While it lasts the robot is predicted by constant velocity, and wheels are the rival. Pure functions,
 * constant time. */
#ifndef ALE_MOTION_WHEEL_MONITOR_H
#define ALE_MOTION_WHEEL_MONITOR_H

#include <stdint.h>

#include "base/pose.h"

enum { ALE_WHEEL_MONITOR_DELAYS = 8 };

/* What wheels do that scans contradict. */
typedef enum {
    ALE_WHEELS_FINE,
    ALE_WHEELS_CONTRADICT, /* scans, in no way that has a name */
    ALE_WHEELS_STALLED,    /* tell nothing while the robot moves */
    ALE_WHEELS_REVERSED,   /* tell ahead as back, or left as right */
    ALE_WHEELS_LATE,       /* tell what was a while ago */
    ALE_WHEELS_SCALE       /* tell much too much, or too little */
} ale_wheel_fault_t;

/* Sums that forget: ways and turns together, a turn counted as what a wheel goes for it. */
typedef struct {
    int64_t counted_um;
    int64_t found_um;
    int64_t apart_um;                             /* found less counted */
    int64_t against_um;                           /* found plus counted */
    int64_t delayed_um[ALE_WHEEL_MONITOR_DELAYS]; /* found a while ago less counted now */
    ale_pose_t found[ALE_WHEEL_MONITOR_DELAYS];   /* the last ones, newest first */
    uint32_t faults;                              /* so often one began */
    ale_wheel_fault_t fault;
} ale_wheel_monitor_t;

void ale_wheel_monitor_init(ale_wheel_monitor_t *monitor);

/* The displacement between two scans, as counted by the wheels and as found by scans that determine it. */
void ale_wheel_monitor_compare(ale_wheel_monitor_t *monitor, ale_pose_t counted, ale_pose_t found);

#endif
