/* Where a surface goes on from beam to beam and where it does not: paper III.A. */
#ifndef ALE_EXTRACT_SEGMENT_H
#define ALE_EXTRACT_SEGMENT_H

#include "extract/workspace.h"

/* Sets e->segment, and e->jump_after for every point: the last point of a segment has it. A jump is a change
 * of range that neither the noise nor the incidence (the neighbouring changes) explains, or many beams
 * without a value. Local and the same in both directions. O(points). */
void ale_segment(ale_extractor_t *e, const ale_scan_t *scan);

/* Whether the points i and j >= i lie in one segment. O(j - i). */
bool ale_segment_joins(const ale_extractor_t *e, int32_t i, int32_t j);

#endif
