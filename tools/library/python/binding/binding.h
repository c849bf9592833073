/* Between Python and the core: plain C functions, loaded by ctypes (ale/_core.py).
 *
 * Numbers cross in SI units, records as ale_binding_describe() tells; memory that is written is the caller's.
 * A function that may fail returns NULL or -1, and ale_binding_error() says why in one line. One thread at a
 * time for each object; objects share nothing. */
#ifndef ALE_PYTHON_BINDING_H
#define ALE_PYTHON_BINDING_H

#include <stdint.h>

#include "arguments.h"

#define ALE_BINDING __attribute__((visibility("default")))

#ifdef __cplusplus
extern "C" {
#endif

/* JSON: version, capacities, the fields of every record with format and offset, and the settings with
 * default, least and most. A constant text. */
ALE_BINDING const char *ale_binding_describe(void);

/* Of the last call of this thread that failed. */
ALE_BINDING const char *ale_binding_error(void);

typedef struct ale_binding_extractor ale_binding_extractor_t;
ALE_BINDING ale_binding_extractor_t *ale_binding_extractor_new(const ale_binding_config_t *config);
ALE_BINDING void ale_binding_extractor_free(ale_binding_extractor_t *extractor);
ALE_BINDING int ale_binding_extract(ale_binding_extractor_t *extractor, const ale_binding_scan_t *scan,
                                    const ale_binding_features_t *out);

typedef struct ale_binding_tracker ale_binding_tracker_t;
ALE_BINDING ale_binding_tracker_t *ale_binding_tracker_new(const ale_binding_config_t *config);
ALE_BINDING void ale_binding_tracker_free(ale_binding_tracker_t *tracker);
/* pose: x, y, theta. */
ALE_BINDING int ale_binding_odometry(ale_binding_tracker_t *tracker, double stamp_s, const double pose[3]);
ALE_BINDING int ale_binding_scan(ale_binding_tracker_t *tracker, const ale_binding_scan_t *scan,
                                 ale_estimate_record_t *out);
ALE_BINDING int ale_binding_dropped(ale_binding_tracker_t *tracker, double stamp_s,
                                    ale_estimate_record_t *out);
ALE_BINDING void ale_binding_features(const ale_binding_tracker_t *tracker,
                                      const ale_binding_features_t *out);
ALE_BINDING int ale_binding_finish(ale_binding_tracker_t *tracker);

/* Number of scans so far; `out`, unless NULL, holds as many. */
ALE_BINDING uint32_t ale_binding_trajectory(const ale_binding_tracker_t *tracker, ale_pose_record_t *out);
/* TUM, the same bytes as ale-replay --trajectory. */
ALE_BINDING int ale_binding_save_trajectory(const ale_binding_tracker_t *tracker, const char *path);

/* counts: walls, corners, refused. Arrays of ALE_MAP_MAX_LINES and ALE_MAP_MAX_CORNERS. */
ALE_BINDING int ale_binding_map(const ale_binding_tracker_t *tracker, ale_wall_record_t *walls,
                                ale_map_corner_record_t *corners, uint32_t counts[3]);
ALE_BINDING int ale_binding_save_map(const ale_binding_tracker_t *tracker, const char *path);
ALE_BINDING int ale_binding_load_map(ale_binding_tracker_t *tracker, const char *path);

#ifdef __cplusplus
}
#endif

#endif
