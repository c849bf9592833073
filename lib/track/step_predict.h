/* Step 1 of a scan: where wheels and time alone put the robot. */
#ifndef ALE_TRACK_STEP_PREDICT_H
#define ALE_TRACK_STEP_PREDICT_H

#include <stdbool.h>
#include <stdint.h>

#include "track/pipeline_state.h"

typedef struct {
    ale_motion_t before;       /* where the last scan has left the robot */
    ale_pose_t next;           /* where wheels and time have led from there */
    ale_ways_t ways;           /* motion hypotheses for the scan at hand */
    bool counted;              /* wheels tell what the robot has gone since the last scan: */
    ale_wheel_motion_t wheels; /* this */
    int64_t dt_us;             /* since the last scan; the usual period where the stamps are not credible */
} ale_prediction_t;

/* Writes the timestamp filter, and takes the odometry that is told. Constant time. */
ale_prediction_t ale_step_predict(ale_pipeline_t *p, int64_t stamp_us);

/* When a scan was taken, by its stamp: after the last one, unless the clock was set back. Odometry that was
 * told with it, by its stamp, was counted then; the wheels take it. Once a scan, in constant time. */
int64_t ale_pipeline_instant(ale_pipeline_t *p, int64_t stamp_us);

/* The wheels take the sample that was told last, if they have not yet. */
void ale_pipeline_take_odometry(ale_pipeline_t *p);

/* Whether scans are missing from a time without one: it is more than three usual ones, and than stamps are
 * off them. */
bool ale_pipeline_is_gap(const ale_pipeline_t *p, int64_t without_us);

/* Moves a motion on to stamp_us; wheels NULL: by its velocity alone. */
void ale_pipeline_predict_motion(const ale_pipeline_t *p, ale_motion_t *motion, int64_t stamp_us,
                                 const ale_wheel_motion_t *wheels);

/* The same with what the wheels say of the displacement since then. False: they say nothing of it, and the
 * velocity was used. */
bool ale_pipeline_predict_by_wheels(const ale_pipeline_t *p, ale_motion_t *motion, int64_t stamp_us,
                                    ale_wheel_motion_t *wheels);

#endif
