/* Short segments and point features: what a scan shows besides lines.
 *
 * Beams in no line are grouped into runs along a surface, and each run is cut into segments of six points at
 * most. In a sparse scan a run goes on over beams without an echo. A short segment has a centre, a normal
 * (its own where its points have a clear direction, else towards the sensor) and a standard deviation of the
 * angle of 0.15 or 0.6 rad. A run of at most 150 mm whose neighbours on both sides are farther away is a
 * point feature: its position is known across the beams too. Single beams are left out, they are outliers as
 * often as not. Where there is no room for all an even choice is made. O(beams). */
#ifndef ALE_OBSERVE_SHORT_SEGMENT_H
#define ALE_OBSERVE_SHORT_SEGMENT_H

#include <stdbool.h>
#include <stdint.h>

#include "base/noise.h"
#include "observe/observation.h"
#include "observe/posed_scan.h"

/* Neighbouring points of one surface. */
typedef struct {
    uint16_t first; /* of beam[] */
    uint16_t last;
    uint16_t parts; /* segments that it is cut into; 0: it is a point feature */
} ale_surface_run_t;

/* Working memory, nothing in it lasts. */
typedef struct {
    uint16_t beam[ALE_MAX_BEAMS];     /* those with an echo that are in no line */
    ale_point_t point[ALE_MAX_BEAMS]; /* of these, sensor frame; computed where known */
    bool known[ALE_MAX_BEAMS];
    ale_surface_run_t surface_run[ALE_MAX_BEAMS / 2];
} ale_segment_workspace_t;

/* Short segments and point features of the beams of a deskewed scan that are in none of its lines, in the
 * frame of the sensor's pose (the robot's). noise: that of one beam. Returns their number, `room` at most.
 * O(beams). */
uint32_t ale_observe_segments(const ale_features_t *features, const ale_posed_scan_t *from,
                              const ale_noise_t *noise, ale_segment_workspace_t *memory, uint32_t room,
                              ale_observation_t out[]);

#endif
