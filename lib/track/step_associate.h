/* Steps 3 and 4 of a scan, a robot that is tracked: which wall each observation shows, and the pose by least
 * squares. */
#ifndef ALE_TRACK_STEP_ASSOCIATE_H
#define ALE_TRACK_STEP_ASSOCIATE_H

#include "track/pipeline_state.h"
#include "track/step_predict.h"

/* Lists the walls within reach of a sensor at this pose. */
void ale_pipeline_approach(ale_pipeline_t *p, ale_pose_t pose, int32_t reach_um);

/* Fits the scan at hand to the walls within reach, from a predicted motion. The first scan and the search. */
void ale_pipeline_fit(ale_pipeline_t *p, const ale_motion_t *predicted, int32_t reach_um, ale_fit_t *fit);

/* Associates the observations with the map from the selected hypothesis and, where the map explains too
 * little of the scan, once more from another pose. fit: what explains most, not yet weighed. Returns the
 * hypotheses with the one selected that the fit started from. Bounded by ALE_SCAN_WORK. */
ale_ways_t ale_step_associate(ale_pipeline_t *p, const ale_prediction_t *prediction, ale_fit_t *fit);

/* What the last scan says of this one if it was taken from a pose, and the robot was before where it was last
 * told to be. As ale_witness_hear. */
ale_testimony_t ale_step_testimony(const ale_pipeline_t *p, ale_pose_t before, ale_pose_t pose);

/* The information of the associations and the covariance of the pose; paper section IV. */
void ale_step_solve(ale_pipeline_t *p, ale_fit_t *fit);

#endif
