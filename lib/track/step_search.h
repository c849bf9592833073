/* A robot whose map is not joined with the first: the search for the place of an older map that it is at. */
#ifndef ALE_TRACK_STEP_SEARCH_H
#define ALE_TRACK_STEP_SEARCH_H

#include "track/pipeline_state.h"
#include "track/step_predict.h"

/* Searches the older map with the scan at hand, taken at p->motion, with bounded work; when the robot is
 * found there its map joins that one. */
void ale_step_search(ale_pipeline_t *p, const ale_prediction_t *prediction);

#endif
