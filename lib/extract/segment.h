/* Where a surface goes on from beam to beam and where it does not: paper III.A. */
#ifndef ALE_EXTRACT_SEGMENT_H
#define ALE_EXTRACT_SEGMENT_H

#include <stdbool.h>
#include <stdint.h>

#include "extract/points.h"
#include "extract/scan_noise.h"

/* A range of points, both ends included. */
typedef struct {
    uint16_t first;
    uint16_t last;
} ale_segment_t;

typedef struct {
    uint16_t suspect_count;
    uint16_t suspect[ALE_MAX_BEAMS]; /* points after which the range changes more than noise makes it */
    bool unruly; /* more of them than a scan of surfaces has: what is done for it is bounded more narrowly */
    bool jump_after[ALE_MAX_BEAMS]; /* the surface does not go on to the next point */
    bool jump_at_seam;              /* nor, in a whole turn, from the last point to the first */
    uint16_t count;
    ale_segment_t segment[ALE_MAX_BEAMS];
} ale_segments_t;

/* Lists the suspects: points i whose range differs from the next one's by more than noise, or that are
 * followed by many beams without a value. Only there can a jump or a stray point be. Sets unruly. O(points).
 */
/*@ requires points->count <= ALE_MAX_BEAMS && \separated(segments, points);
  @ ensures segments->suspect_count < ALE_MAX_BEAMS; */
void ale_segment_suspect(ale_segments_t *segments, const ale_points_t *points, const ale_scan_noise_t *noise);

/* Cuts the points into segments, and sets jump_after for every point: the last point of a segment has it. A
 * jump is a change of range that neither the noise nor the incidence (the neighbouring changes) explains, or
 * many beams without a value. Looks at the suspects only. Local and the same in both directions. O(points).
 */
/*@ requires segments->suspect_count < ALE_MAX_BEAMS && points->count <= ALE_MAX_BEAMS;
  @ requires \separated(segments, points); */
void ale_segment_cut(ale_segments_t *segments, const ale_points_t *points, const ale_scan_noise_t *noise);

/* What lies beyond a point on one side. */
typedef struct {
    int32_t point; /* -1: nothing, the scan ends */
    int32_t gap;   /* beams from the one to the other */
    bool jump;     /* the surface does not go on to it */
} ale_beyond_t;

/* The point on one side (1 or -1) of a point, also over the seam of a whole turn. */
static inline ale_beyond_t ale_segment_beyond(const ale_points_t *points, const ale_segments_t *segments,
                                              int32_t i, int32_t side)
{
    const int32_t beyond = i + side;
    if (beyond >= 0 && beyond < points->count) {
        const int32_t gap = side * (points->beam[beyond] - points->beam[i]);
        return (ale_beyond_t){beyond, gap, segments->jump_after[side > 0 ? i : beyond]};
    }
    if (points->turn_beams == 0) {
        return (ale_beyond_t){-1, 0, true};
    }
    const int32_t last = points->count - 1;
    return (ale_beyond_t){side > 0 ? 0 : last, points->beam[0] + points->turn_beams - points->beam[last],
                          segments->jump_at_seam};
}

/* Whether the points i and j >= i lie in one segment. O(j - i). */
static inline bool ale_segment_joins(const ale_segments_t *segments, int32_t i, int32_t j)
{
    for (int32_t k = i; k < j; k++) {
        if (segments->jump_after[k]) {
            return false;
        }
    }
    return true;
}

#endif
