/* What of a scan moves, goes along with the robot, or has only just come is left out of the map. The filter
 * owns the earlier scans that tell it. */
#ifndef ALE_TRACK_STEP_FILTER_H
#define ALE_TRACK_STEP_FILTER_H

#include <stdbool.h>

#include "track/pipeline_state.h"

/* A pose of the map in the smooth frame, which no correction of the map bends; before: the map pose of the
 * last scan. */
ale_pose_t ale_pipeline_smooth_pose(const ale_pipeline_t *p, ale_pose_t before, ale_pose_t pose);

/* The scan at hand as an earlier one is compared with it, if it was taken from a pose of the map. */
ale_seen_t ale_pipeline_seen_from(const ale_pipeline_t *p, ale_pose_t before, ale_pose_t pose);

/* Starts anew: no earlier scan is known. */
void ale_filter_clear(ale_pipeline_t *p);

/* Blanks the beams that meet what goes along with the robot. O(beams). */
void ale_filter_mask(ale_pipeline_t *p, ale_scan_t *scan);

/* All that was observed stands still, as far as is known. O(beams). */
void ale_filter_begin(ale_pipeline_t *p);

/* What has come since the last scan, and was not there when it looked, is left out: it may go along with the
 * robot. fit: its associations are thinned alike. */
void ale_filter_attached(ale_pipeline_t *p, ale_pose_t before, ale_fit_t *fit);

/* Keeps the scan at hand as the one that the next is compared with. A scan that shows nothing (the scanner is
 * covered) could say nothing of the next: the last that did stays. True: it is kept. */
bool ale_filter_keep(ale_pipeline_t *p, ale_pose_t before, const ale_motion_t *found);

/* What has come while the robot stood begins no wall. good: the pose is known. */
void ale_filter_newcomers(ale_pipeline_t *p, ale_pose_t before, bool good, ale_fit_t *fit);

/* The scan that is kept was taken from here, in the smooth frame. */
void ale_filter_set_pose(ale_pipeline_t *p, ale_pose_t robot);

#endif
