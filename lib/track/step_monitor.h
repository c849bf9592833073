/* Step 5 of a scan: whether it can be believed, and what it leaves open. */
#ifndef ALE_TRACK_STEP_MONITOR_H
#define ALE_TRACK_STEP_MONITOR_H

#include "match/observability.h"
#include "track/pipeline_state.h"
#include "track/step_predict.h"

typedef enum {
    ALE_SCENE_KNOWN,     /* the map holds a good part of what the scan shows */
    ALE_SCENE_STRANGE,   /* it does not, and the last scan does not contradict */
    ALE_SCENE_UNDECIDED, /* another pose explains more of it, but not by enough against the prediction */
    ALE_SCENE_CHANGED    /* the last scan contradicts: the scan is not to be believed */
} ale_scene_verdict_t;

/* Evaluates the last scan when the map knows little of this one. Writes p->monitor alone. Bounded by the
 * surfaces that the last scan is asked for. */
ale_scene_verdict_t ale_step_monitor(ale_pipeline_t *p, const ale_prediction_t *prediction, bool counted,
                                     const ale_fit_t *fit);

/* Good, weak or lost after a scan that went into the map; counts: what it says of the walls not matched.
 * Writes p->monitor alone. */
void ale_monitor_judge(ale_pipeline_t *p, const ale_fit_t *fit, const ale_visibility_counts_t *counts);

#endif
