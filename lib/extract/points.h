/* The points of a scan: the beams that have a value, in beam order, numbered from 0 without gaps.
 *
 * In a scan of a whole turn the order begins where a surface most likely ends (seam.h); beams before that one
 * are numbered on, by turn_beams more.
 *
 * Points are in 1/16 mm (Q4), in a frame whose x axis lies midway between the first and the last of them, so
 * that neither the angle at which a scan begins nor empty beams around it change any number. */
#ifndef ALE_EXTRACT_POINTS_H
#define ALE_EXTRACT_POINTS_H

#include <stdbool.h>
#include <stdint.h>

#include "base/limits.h"
#include "base/scan.h"

/* Points are 1/16 mm: Q4. The largest product of the fits is 2 n^2 max^2 (see moments.c). */
#define ALE_POINT_SHIFT 4
#define ALE_POINT_MAX_Q4 ((int64_t)(ALE_MAX_RANGE_UM / 1000) << ALE_POINT_SHIFT)

/* Nearer than this no scanner measures, and 2^44 / range would not fit. */
#define ALE_MIN_RANGE_UM 16384

/* Directions of multiples of half a step to either side of straight ahead, every other one: those of beams
 * that follow one another lie side by side. Points a micrometre of range, Q36, the highest bit the sign. */
typedef struct {
    uint32_t cos_q36[ALE_MAX_BEAMS + 1];
    uint32_t sin_q36[ALE_MAX_BEAMS + 1];
} ale_beam_directions_t;

typedef struct {
    /* As many multiples as were needed, even and odd ones, kept as long as the scanner stays the same. */
    int32_t directions;
    int32_t direction_step_bam;
    ale_beam_directions_t direction[2];

    int64_t step_nrad;  /* from beam to beam, without sign */
    int32_t turn_beams; /* of a whole turn, after which the beams repeat; 0: the scan has two ends */
    uint32_t frame_bam; /* direction of the x axis of the points, in the sensor's frame */
    uint16_t count;
    uint16_t beam[ALE_MAX_BEAMS];
    int32_t range_um[ALE_MAX_BEAMS];
    int32_t inverse_q44[ALE_MAX_BEAMS]; /* 2^44 / range_um */
    int32_t x_q4[ALE_MAX_BEAMS];
    int32_t y_q4[ALE_MAX_BEAMS];

    bool sparse; /* see ale_scan_is_sparse */
    uint16_t gap_count;
    uint16_t
        gap_after[ALE_MAX_BEAMS / ALE_MAX_GAP_BEAMS + 1]; /* points before more missing beams than that */
} ale_points_t;

/* The beam of the scan that a point is. */
static inline uint16_t ale_points_beam(const ale_points_t *points, int32_t i)
{
    const uint16_t beam = points->beam[i];
    const bool beyond_seam = points->turn_beams > 0 && beam >= points->turn_beams;
    return (uint16_t)(beam - (beyond_seam ? points->turn_beams : 0));
}

/* Beams between two points i <= j, of those that a row of beams, which ascends, is of. */
/*@ assigns \nothing;
  @ ensures j - i <= \result; */
static inline int32_t ale_beams_between(const uint16_t *beam, int32_t i, int32_t j)
{
    return beam[j] - beam[i];
}

/* Lists the valid beams of a scan: all but x_q4, y_q4, frame_bam. bearing_bam as in ale_extract_scan.
 * O(beams). */
void ale_points_list(ale_points_t *points, const ale_scan_t *scan, const uint32_t *bearing_bam);

/* Notes after which points more than ALE_MAX_GAP_BEAMS have no value. O(points). */
void ale_points_note_gaps(ale_points_t *points);

/* frame_bam, and x_q4, y_q4 of the listed points. O(points). */
void ale_points_place(ale_points_t *points, const ale_scan_t *scan, const uint32_t *bearing_bam);

/* Moves the placed points along their beams to the smoothed ranges, 2^44 / smooth_q44; where a regression
 * over a change of range says 0 or less, or farther than ALE_MAX_RANGE_UM, to that. O(points). */
void ale_points_place_smoothed(ale_points_t *points, const int32_t *smooth_q44);

/* A surface is read from its nearer end, so that both directions of a scan give the same lines: 1 when that
 * is the first of the points first..last, else -1. O(points) where both halves are alike, else a few steps.
 */
int32_t ale_points_reading_direction(const ale_points_t *points, int32_t first, int32_t last);

#endif
