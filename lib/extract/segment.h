/* Where a surface goes on from beam to beam and where it does not: paper III.A. */
#ifndef ALE_EXTRACT_SEGMENT_H
#define ALE_EXTRACT_SEGMENT_H

#include "extract/workspace.h"

/* Lists the suspects: points i whose range differs from the next one's by more than noise, or that are
 * followed by many beams without a value. Only there can a jump or a stray point be. Sets e->unruly.
 * O(points). */
void ale_segment_suspect(ale_extractor_t *e);

/* Sets e->segment, and e->jump_after for every point: the last point of a segment has it. A jump is a change
 * of range that neither the noise nor the incidence (the neighbouring changes) explains, or many beams
 * without a value. Looks at the suspects only. Local and the same in both directions. O(points). */
void ale_segment(ale_extractor_t *e, const ale_scan_t *scan);

/* Whether the points i and j >= i lie in one segment. O(j - i). */
bool ale_segment_joins(const ale_extractor_t *e, int32_t i, int32_t j);

#endif
