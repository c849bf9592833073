/* What a scan shows besides lines: short segments of surfaces and small things that stand alone.
 *
 * Beams that made no line are taken in runs along the surface and cut into short segments of a few beams. A
 * piece has a centre, a normal (from its own direction where it has one, else towards the sensor), and hardly
 * an angle. A short run with nothing but distance on either side is a point feature: its place is known
 * across the beams too. Single beams are left out: they are stray points as often as not. Of more short
 * segments than there is room for an even choice is taken. O(beams). */
#ifndef ALE_OBSERVE_SHORT_SEGMENT_H
#define ALE_OBSERVE_SHORT_SEGMENT_H

#include <stdbool.h>
#include <stdint.h>

#include "base/noise.h"
#include "observe/observation.h"

/* Neighbouring beams along a surface. */
typedef struct {
    uint16_t first;
    uint16_t last;
    uint16_t parts; /* 0: a point feature */
} ale_surface_run_t;

/* Working memory. */
typedef struct {
    ale_point_t point[ALE_MAX_BEAMS]; /* of the beams that were asked for it, sensor frame */
    bool known[ALE_MAX_BEAMS];
    ale_surface_run_t surface_run[ALE_MAX_BEAMS / 2];
} ale_segment_workspace_t;

/* Pieces of a straightened scan (bearing_bam as for ale_extract_scan) in the robot's frame. Returns their
 * number, `room` at most. */
uint32_t ale_observe_segments(const ale_features_t *features, const ale_scan_t *scan,
                              const uint32_t *bearing_bam, ale_pose_t sensor, const ale_noise_t *noise,
                              ale_segment_workspace_t *memory, uint32_t room, ale_observation_t out[]);

#endif
