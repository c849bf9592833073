/* A scan of a robot that is lost: the search for the pose that explains it. */
#ifndef ALE_TRACK_STEP_SEARCH_H
#define ALE_TRACK_STEP_SEARCH_H

#include <stdbool.h>

#include "track/pipeline_state.h"
#include "track/step_predict.h"

/* Looks for the place that fits, with bounded work a scan, and leaves the map alone. fit: of the last pose
 * that was tried, untouched when none was. True: fit->motion is where the robot is. Writes p->relocation and
 * p->claims; when found, the monitor is told and what the wheels' scale has brought is forgotten. */
bool ale_step_search(ale_pipeline_t *p, const ale_prediction_t *prediction, ale_fit_t *fit);

#endif
