/* Step 6 of a scan: what it teaches about wheels and uncertainty, and what it adds to the map. Only the
 * functions here write the map, its uncertainty, and what is learnt of the wheels. */
#ifndef ALE_TRACK_STEP_UPDATE_H
#define ALE_TRACK_STEP_UPDATE_H

#include <stdbool.h>
#include <stdint.h>

#include "match/observability.h"
#include "track/pipeline_state.h"
#include "track/step_predict.h"

/* How far the map may be off here, and what the scale error of the wheels has made of the pose. ways: as the
 * fit has selected them. */
void ale_update_uncertainty(ale_pipeline_t *p, const ale_prediction_t *prediction, const ale_ways_t *ways,
                            const ale_observability_t *observability, const ale_fit_t *fit);

/* What a credible scan teaches: process noise; lag and scale of the wheels. before: the scale error before
 * this scan. */
void ale_update_learn(ale_pipeline_t *p, const ale_prediction_t *prediction, const ale_ways_t *ways,
                      const ale_scale_error_t *before, const ale_fit_t *fit);

/* Where the scan shows enough, but too little of it is in the map to hold the pose, the map goes on from
 * here: new walls determine the pose as exactly as old ones, and how far they may be off is the map
 * uncertainty that they are born with. */
void ale_update_reanchor(ale_pipeline_t *p, ale_fit_t *fit);

/* The static scene goes into the map at fit->motion. Returns how many corners were known. */
uint16_t ale_update_map(ale_pipeline_t *p, const ale_fit_t *fit, bool grow);

/* Asks the near walls that were not matched whether they are there; those that are not decay. */
ale_visibility_counts_t ale_update_decay(ale_pipeline_t *p, ale_pose_t robot);

/* The robot is in another map: what wheels and walls have made of the last one is void. */
void ale_update_restart(ale_pipeline_t *p);

#endif
