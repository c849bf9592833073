/* Stray points: gross errors, mixed pixels at depth edges. They go before segments are cut. */
#ifndef ALE_EXTRACT_OUTLIER_H
#define ALE_EXTRACT_OUTLIER_H

#include "extract/workspace.h"

/* Removes from the points every piece of one or two beams between jumps (e->jump_after as set by
 * ale_segment, which is to be called again afterwards). Sets e->outliers. O(points). */
void ale_outlier_remove(ale_extractor_t *e);

/* Removes points within a segment that stand out from both neighbours. Adds to e->outliers. O(points). */
void ale_outlier_remove_spikes(ale_extractor_t *e);

#endif
