/* What is known of the robot after a scan, as it is published. */
#ifndef ALE_TRACK_ESTIMATE_H
#define ALE_TRACK_ESTIMATE_H

#include <stdbool.h>
#include <stdint.h>

#include "base/pose.h"
#include "motion/wheel_monitor.h"

typedef enum { ALE_STATE_LOST = 0, ALE_STATE_WEAK = 1, ALE_STATE_GOOD = 2 } ale_state_t;

/* What is published for every scan, also for a dropped one. Pose of the robot at stamp_us. */
typedef struct {
    int64_t stamp_us;
    uint32_t scan;           /* number of the scan, from 0, dropped ones counted */
    uint32_t epoch;          /* of the map: grows when it is begun anew */
    uint32_t corrections;    /* taken in by the map since then */
    ale_pose_t smooth;       /* continuous: no step exceeds what the robot can do */
    ale_pose_t map;          /* takes corrections and relocations */
    int64_t cov[9];          /* of the map pose, row by row: um^2, um*nrad, nrad^2 */
    int64_t information[6];  /* what the scan alone determines, robot frame: xx xy xt yy yt tt; 1/mm^2, 1/(mm
                                mrad),  1/mrad^2, all times 2^20 */
    int32_t velocity_x_um_s; /* robot's frame */
    int32_t velocity_y_um_s;
    int32_t velocity_theta_urad_s;
    int32_t lag_us; /* odometry lag as estimated so far */
    uint16_t matched_lines;
    uint16_t matched_corners;
    uint8_t state;  /* ale_state_t */
    bool predicted; /* no scan stood behind this pose */
    bool map_changed;
    uint8_t maps;          /* that are not joined, this one counted */
    uint8_t wheel_fault;   /* ale_wheel_fault_t: what the wheels do wrong at present */
    uint32_t map_id;       /* of the map that the map pose is in; 0: the first, or the loaded one */
    uint32_t wheel_faults; /* so often they began to */
} ale_estimate_t;

#endif
