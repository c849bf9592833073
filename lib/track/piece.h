/* What a scan shows besides lines: pieces of surfaces and small things that stand alone.
 *
 * Beams that made no line are taken in runs along the surface and cut into pieces of a few beams. A piece
 * has a centre, a normal (from its own direction where it has one, else towards the sensor), and hardly
 * an angle. A short run with nothing but distance on either side is a spot: its place is known across the
 * beams too. Single beams are left out: they are stray points as often as not. O(beams). */
#ifndef ALE_TRACK_PIECE_H
#define ALE_TRACK_PIECE_H

#include <stdint.h>

#include "base/noise.h"
#include "track/view.h"

enum { ALE_MAX_PIECES = 120 };

/* Pieces of a straightened scan (bearing_bam as for ale_extract_scan) in the robot's frame. point: working
 * memory for every beam. Returns their number, ALE_MAX_PIECES at most; further ones are left out. */
uint32_t ale_pieces_of(const ale_features_t *features, const ale_scan_t *scan, const uint32_t *bearing_bam,
                       ale_pose_t sensor, const ale_noise_t *noise, ale_point_t point[], ale_view_t out[]);

#endif
