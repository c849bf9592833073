/* A scan that the prediction does not explain, or after a time in which nobody watched: where else can the
 * robot have got to in the time gone by. */
#ifndef ALE_TRACK_STEP_RECOVER_H
#define ALE_TRACK_STEP_RECOVER_H

#include <stdbool.h>

#include "track/pipeline_state.h"
#include "track/step_predict.h"

/* Whether more time than usual has gone since a scan last told where the robot is: what wheels and velocity
 * say of it is then not confirmed by anything. */
bool ale_recover_is_unwatched(const ale_pipeline_t *p, const ale_prediction_t *prediction);

/* Whether so much time has gone that somebody may have carried it anywhere. */
bool ale_recover_may_be_anywhere(const ale_pipeline_t *p, const ale_prediction_t *prediction);

/* Whether wheels have told of a way through a time unwatched: they were on the floor, nobody has carried the
 * robot. */
bool ale_recover_has_driven(const ale_pipeline_t *p, const ale_prediction_t *prediction);

/* Whether one pose within the reach of the vote explains the scan by the selected map clearly better than any
 * other: it is p->best then, solved. */
bool ale_recover_in_region(ale_pipeline_t *p, ale_pose_t centre);

typedef enum {
    ALE_RECOVER_CONFIRMED, /* none explains as much as *fit does */
    ALE_RECOVER_STAYS,     /* none explains clearly more */
    ALE_RECOVER_UNDECIDED, /* one does, but the next scan must confirm it, or wheels told of late may */
    ALE_RECOVER_FOLLOWED,  /* one does, beside *fit or where the last scan has seen the robot go: *fit is
                              that one, solved */
    ALE_RECOVER_MOVED,     /* one does, elsewhere: *fit is that one, solved */
    ALE_RECOVER_OPEN       /* several do, or nothing but the map tells of *fit after a time unwatched */
} ale_recovery_t;

/* Compares all poses that the robot can have reached by what they explain of the scan, less what the
 * prediction weighs against them. Another pose is taken at once where the last scan has seen the robot go,
 * else proposed, and taken with the next scan that finds it again; what scans in a row say for it adds up.
 * fit: what the prediction has led to, solved. ways: the pose selected, where that is another. Writes
 * p->proposal, and p->unconfirmed_from where nothing but the prediction tells of *fit. Bounded by the vote,
 * four fits and the last scan heard of two poses. */
ale_recovery_t ale_step_recover(ale_pipeline_t *p, const ale_prediction_t *prediction, ale_ways_t *ways,
                                ale_fit_t *fit);

#endif
