/* A scan of a robot that is about where the prediction puts it: associate, solve, monitor, update. */
#ifndef ALE_TRACK_STEP_TRACK_H
#define ALE_TRACK_STEP_TRACK_H

#include <stdbool.h>
#include <stdint.h>

#include "track/pipeline_state.h"
#include "track/step_predict.h"

/* What a scan came to. */
typedef struct {
    ale_fit_t fit; /* fit.motion: the pose, as it went into the map */
    uint16_t matched_corners;
    bool undecided;   /* another pose explains more, but not yet enough */
    bool determined;  /* every direction, by this scan */
    bool speed_known; /* a scan determined it, and the robot has gone on evenly since */
    bool slips;       /* wheels do, the last time that it could be told */
    bool kept;        /* the next scan is compared with this one */
} ale_tracked_t;

/* The scan at hand, which was observed with the velocity of this prediction. Bounded by ALE_SCAN_WORK. */
ale_tracked_t ale_step_track(ale_pipeline_t *p, const ale_prediction_t *prediction);

/* The first scan: it is where it is, and all that it shows is new. */
ale_tracked_t ale_step_track_first(ale_pipeline_t *p);

#endif
