/* The steps of a scan's way that pipeline.c calls. For lib/track only. */
#ifndef ALE_TRACK_PIPELINE_STEPS_H
#define ALE_TRACK_PIPELINE_STEPS_H

#include <stdbool.h>
#include <stdint.h>

#include "track/pipeline_state.h"

enum { ALE_SCAN_PERIOD_MAX_US = 2000000 }; /* scans farther apart say nothing of speed */

/* How a motion goes on to stamp_us; wheels NULL: by its velocity alone. */
void ale_pipeline_predict_motion(const ale_pipeline_t *p, ale_motion_t *motion, int64_t stamp_us,
                                 const ale_wheel_motion_t *wheels);

/* Straightens the scan with a velocity, extracts, and turns lines and what is left into views. O(beams). */
void ale_pipeline_preprocess(ale_pipeline_t *p, const ale_scan_t *raw, const int32_t velocity[ALE_AXES]);

/* Bearings of the scan at hand, NULL when they are regular. */
const uint32_t *ale_pipeline_bearings(const ale_pipeline_t *p);

/* What the scan at hand shows, to be held against the map. */
ale_scene_t ale_pipeline_scene(ale_pipeline_t *p);

/* Fits the observations to the walls within reach, from a predicted motion. The result is p->fit. */
void ale_pipeline_match(ale_pipeline_t *p, const ale_motion_t *predicted, int32_t reach_um);

/* The first scan: it is where it is, and all that it shows is new. */
void ale_pipeline_first(ale_pipeline_t *p);

/* Matches where the prediction (p->ways) puts the robot, judges the result, and takes it into the map.
 * wheels: what they told of the way since `before`, if they did. */
void ale_pipeline_track(ale_pipeline_t *p, const ale_motion_t *before, const ale_wheel_motion_t *wheels);

/* Looks for the place that fits, with bounded work a scan, and leaves the map alone. way: how the robot went
 * since the scan before; counted: wheels told it. */
void ale_pipeline_search(ale_pipeline_t *p, ale_pose_t way, bool counted);

/* After the smooth pose has followed: what is kept of the scan at hand was seen from there, however the map
 * pose settles after a correction. */
void ale_pipeline_set_record_pose(ale_pipeline_t *p);

#endif
