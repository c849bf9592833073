/* The story of one scan, from ranges and odometry to pose, features and map; the paper's section IV.
 *
 *   ale_pipeline_init(p, &config);
 *   ale_pipeline_odometry(p, &sample);          (whenever one arrives; optional)
 *   ale_pipeline_scan(p, &scan, &estimate);     (every scan, in order)
 *   ale_pipeline_dropped(p, stamp_us, &estimate);  (a scan that was lost: answered by prediction)
 *
 * One owner: the estimate task, or ale-replay. No allocation, no lock, no clock, no floating point;
 * every loop bounded by a capacity. The same calls give the same bytes on every machine. */
#ifndef ALE_TRACK_PIPELINE_H
#define ALE_TRACK_PIPELINE_H

#include <stdbool.h>
#include <stdint.h>

#include "base/limits.h"
#include "base/pose.h"
#include "base/scan.h"
#include "base/stage.h"
#include "extract/extract.h"
#include "map/line_map.h"
#include "motion/odometry_sample.h"
#include "observe/seen.h"
#include "track/estimate.h"
#include "track/pipeline_config.h"

typedef struct ale_pipeline ale_pipeline_t;
typedef struct ale_keyframe ale_keyframe_t;
typedef struct ale_correction ale_correction_t;
typedef struct ale_scan_observation ale_scan_observation_t;
typedef struct ale_tile_change ale_tile_change_t;
typedef struct ale_whereabouts ale_whereabouts_t;

/* What keyframes and scan observations of a drive through a map of tiles say in `loaded`. */
#define ALE_LOADED_TILES UINT32_MAX

uint32_t ale_pipeline_size(void);

/* 0, or -1 when a value of the configuration is out of range (then nothing is changed). */
int ale_pipeline_init(ale_pipeline_t *pipeline, const ale_pipeline_config_t *config);

/* How rough the scans are from the next one on. 0, or -1 where that is out of range: nothing has changed. */
int ale_pipeline_set_noise(ale_pipeline_t *pipeline, const ale_noise_t *noise);
void ale_pipeline_set_hook(ale_pipeline_t *pipeline, const ale_stage_hook_t *hook);

/* Forgets map and pose; keeps the configuration. The next scan is the origin. */
void ale_pipeline_reset(ale_pipeline_t *pipeline);

/* A sample with the very stamp of the scan that comes next was taken with it: it is of the instant of that
 * scan, however late both were stamped. */
void ale_pipeline_odometry(ale_pipeline_t *pipeline, const ale_odometry_t *sample);
void ale_pipeline_scan(ale_pipeline_t *pipeline, const ale_scan_t *scan, ale_estimate_t *out);
void ale_pipeline_dropped(ale_pipeline_t *pipeline, int64_t stamp_us, ale_estimate_t *out);

/* For the mapper: the scan last handed over, when it is worth keeping (see keyframe.h). Copies at most
 * sizeof(ale_keyframe_t). False: it is not, and *out is untouched. */
bool ale_pipeline_keyframe(ale_pipeline_t *pipeline, ale_keyframe_t *out);

/* For the mapper, which draws the map anew: what the scan last handed over has shown (see
 * scan_observation.h). Copies at most sizeof(ale_scan_observation_t). False, and *out is untouched: there was
 * no scan, the robot is in no map or may not be where its pose says, no keyframe was taken since it was put
 * elsewhere, or the map is frozen. */
bool ale_pipeline_scan_observation(const ale_pipeline_t *pipeline, ale_scan_observation_t *out);

/* From the mapper, between two scans: map and map pose move as loops have shown; the smooth pose does not.
 * False: not due yet, offer it again before the next scan. One made for another map (epoch) is ignored. O(map
 * * log count). */
bool ale_pipeline_correct(ale_pipeline_t *pipeline, const ale_correction_t *correction);

/* "You are here", within about 0.4 m and 0.2 rad: the map stays, the map pose is put there. The robot is
 * lost, in a new map, until a scan fits there or it is found elsewhere. */
void ale_pipeline_relocate(ale_pipeline_t *pipeline, ale_pose_t pose);

/* Pure localisation: while frozen the map stays byte for byte as it is, corrections apart. */
void ale_pipeline_freeze_map(ale_pipeline_t *pipeline, bool frozen);

/* Features of the scan last handed over: sensor frame at the scan's stamp, straightened. */
const ale_features_t *ale_pipeline_features(const ale_pipeline_t *pipeline);

/* The scan last handed over as it was straightened and taken into account (see seen.h), at its map pose;
 * borrowed until the next one is handed over. False, and *out untouched: the last answer had no scan, or
 * nobody knows where it was taken (the robot is in no map, or scans deny its pose). */
bool ale_pipeline_seen(const ale_pipeline_t *pipeline, ale_seen_t *out);

/* The map as it stands: walls and corners worth showing. Copies at most sizeof(ale_map_t). */
void ale_pipeline_copy_map(const ale_pipeline_t *pipeline, ale_map_t *out);

/* Starts from a known map, lost until found; known: the robot is said to be at this pose, which is looked at
 * first and believed once a scan fits the map there. number: what keyframes and scan observations of this map
 * say in `loaded`, not 0; whoever loads more than one numbers them. */
void ale_pipeline_load_map(ale_pipeline_t *pipeline, const ale_map_t *map, uint32_t number, ale_pose_t pose,
                           bool known);

/* Starts in a map of tiles (map/tile_change.h), of which nothing is loaded yet; pose, known: as above, but
 * where nothing is said of the robot's place it looks for it only once all of the map is loaded. */
void ale_pipeline_load_tiles(ale_pipeline_t *pipeline, ale_pose_t pose, bool known);

/* For the loader of tiles, after a scan: where the robot is. False: it need not know (no map of tiles, or it
 * was told a few scans ago), and *out is untouched. */
bool ale_pipeline_whereabouts(const ale_pipeline_t *pipeline, ale_whereabouts_t *out);

/* From that loader, after a scan: one piece of what comes and goes; one a scan. False: not due yet, or the
 * scan was searched elsewhere than it was tracked, which leaves no time for both; offer it again after the
 * next, which is not searched then unless nobody watched it. One for another map (epoch) is ignored. See
 * ale_tile_change_apply. */
bool ale_pipeline_change_tiles(ale_pipeline_t *pipeline, const ale_tile_change_t *change);

#endif
