/* Step 2 of a scan: from raw ranges to what they show. */
#ifndef ALE_TRACK_STEP_OBSERVE_H
#define ALE_TRACK_STEP_OBSERVE_H

#include <stdint.h>

#include "track/pipeline_state.h"

/* Straightens the scan with a velocity, extracts, and turns lines and what is left into observations: writes
 * p->observed. O(beams). */
void ale_step_observe(ale_pipeline_t *p, const ale_scan_t *raw, const int32_t velocity[ALE_AXES]);

/* What the scan at hand shows, to be held against the map. */
ale_scene_t ale_observed_scene(ale_pipeline_t *p);

#endif
