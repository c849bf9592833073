/* A scan that the prediction does not explain, or after a time in which nobody watched: where else can the
 * robot have got to in the time gone by. */
#ifndef ALE_TRACK_STEP_RECOVER_H
#define ALE_TRACK_STEP_RECOVER_H

#include <stdbool.h>

#include "track/pipeline_state.h"
#include "track/step_monitor.h"
#include "track/step_predict.h"

/* Whether more time than usual has gone since a scan last told where the robot is: what wheels and velocity
 * say of it is then not confirmed by anything. */
bool ale_recover_is_unwatched(const ale_pipeline_t *p, const ale_prediction_t *prediction);

/* Whether so much time has gone that somebody may have carried it anywhere. */
bool ale_recover_may_be_anywhere(const ale_pipeline_t *p, const ale_prediction_t *prediction);

/* Whether one pose within the reach of the vote explains the scan by the selected map clearly better than any
 * other: it is p->best then, solved. */
bool ale_recover_in_region(ale_pipeline_t *p, ale_pose_t centre);

typedef enum {
    ALE_RECOVER_STAYS, /* no other pose explains the scan clearly better */
    ALE_RECOVER_NEAR,  /* one does that the prediction could have led to: *fit is that one, solved */
    ALE_RECOVER_MOVED, /* one does, and no third one as well: *fit is that one, solved */
    ALE_RECOVER_OPEN   /* several do */
} ale_recovery_t;

/* Compares all poses that the robot can have reached. fit: what the prediction has led to, solved. ways: the
 * pose selected, where that is another. Bounded by the vote and four fits. */
ale_recovery_t ale_step_recover(ale_pipeline_t *p, const ale_prediction_t *prediction,
                                ale_scene_verdict_t verdict, ale_ways_t *ways, ale_fit_t *fit);

#endif
