/* A robot whose map is not joined with the first: the search for the place of an older map that it is at. */
#ifndef ALE_TRACK_STEP_SEARCH_H
#define ALE_TRACK_STEP_SEARCH_H

#include "track/pipeline_state.h"
#include "track/step_predict.h"

/* Searches the older map with the scan at hand, taken at p->motion, with bounded work. When the next scan
 * confirms the place that is found there, or the robot is where it is said to be, its map joins that one. A
 * scan for which the robot's own map was searched (step_recover) is not searched here. */
void ale_step_search(ale_pipeline_t *p, const ale_prediction_t *prediction);

#endif
