/* Configuration of the pipeline: the scanner, its mounting, the wheels, what the robot can do. */
#ifndef ALE_TRACK_PIPELINE_CONFIG_H
#define ALE_TRACK_PIPELINE_CONFIG_H

#include <stdbool.h>
#include <stdint.h>

#include "base/limits.h"
#include "base/pose.h"
#include "base/scan.h"
#include "extract/extract.h"

typedef struct {
    ale_extract_config_t extract;
    ale_pose_t sensor; /* mounting: pose of the laser in the robot's frame */
    bool use_odometry;
    int32_t odometry_scale_ppm;           /* one sigma of the distance's scale error; 0..500000 */
    int32_t odometry_turn_urad_m;         /* one sigma of the heading error for a metre driven; 0..1000000 */
    int32_t odometry_turn_ppm;            /* one sigma of the heading error in parts of the turn; 0..500000 */
    int32_t odometry_distance_factor_ppm; /* systematic errors, see wheel_factors.h; 500000..2000000, */
    int32_t odometry_turn_factor_ppm;     /* 1000000: none */
    int32_t odometry_turn_bias_urad_m;    /* +-1000000 */
    int32_t odometry_lag_us;              /* prior: odometry younger than scans by this much; refined on line;
                                             -100000..300000 */
    int32_t max_speed_mm_s;  /* what the robot can do: no step of the smooth pose exceeds it; 1..50000 */
    int32_t max_turn_mrad_s; /* 1..50000 */
    uint32_t blind_count;    /* 0..ALE_MAX_BLIND_SECTORS */
    ale_sector_t blind[ALE_MAX_BLIND_SECTORS];
} ale_pipeline_config_t;

/* A URG-04LX in the middle of a robot whose wheels err as is usual. */
ale_pipeline_config_t ale_pipeline_default_config(void);

/* Whether every value but those of `extract` is within its range. */
bool ale_pipeline_config_is_valid(const ale_pipeline_config_t *config);

#endif
