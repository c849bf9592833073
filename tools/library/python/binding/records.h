/* What Python sees of the core's types: metres, radians, seconds. NumPy reads these structures as they lie
 * (describe.cpp names their fields). */
#ifndef ALE_PYTHON_RECORDS_H
#define ALE_PYTHON_RECORDS_H

#include <stdint.h>

typedef struct {
    double first_bearing;
    double step;
    double range_min;
    double range_max;
    double beam_time;
    int32_t stamp_beam;
} ale_scanner_record_t;

typedef struct {
    double x1, y1, x2, y2;
    double alpha, rho;
    double cov[3]; /* alpha alpha, alpha rho, rho rho */
    double rmse;
    double var_start, var_end; /* of the ends along the line */
    uint16_t first, last, points;
    uint8_t first_end, last_end; /* ale_end_kind_t */
} ale_line_record_t;

typedef struct {
    double x, y;
    double cov[3]; /* xx, xy, yy */
    double angle, bisector;
    uint16_t first_line, second_line;
    uint8_t kind; /* ale_corner_kind_t */
} ale_corner_record_t;

typedef struct {
    double x, y, radius; /* radius 0: not a circle */
    uint16_t first, last;
} ale_curve_record_t;

typedef struct {
    double t;
    double x, y, theta;             /* smooth pose */
    double map_x, map_y, map_theta; /* map pose */
    double cov[9];                  /* of the map pose, row by row */
    double information[6];          /* robot's frame: xx xy xt yy yt tt */
    double velocity[3];             /* robot's frame */
    double cpu_s;                   /* thread time of the tracker */
    uint32_t scan;
    uint32_t map_id;
    int32_t lag_us;
    uint16_t matched_lines, matched_corners;
    uint8_t state; /* ale_state_t */
    uint8_t predicted;
    uint8_t maps;
    uint8_t wheel_fault; /* ale_wheel_fault_t */
} ale_estimate_record_t;

typedef struct {
    double t, x, y, theta;
    uint8_t measured;
} ale_pose_record_t;

typedef struct {
    double x1, y1, x2, y2;
    double cov[3]; /* alpha alpha, alpha rho, rho rho */
    uint32_t id, seen, map_id;
} ale_wall_record_t;

typedef struct {
    double x, y;
    double cov[3];
    double angle, bisector;
    uint32_t seen;
    uint8_t kind;
} ale_map_corner_record_t;

#endif
