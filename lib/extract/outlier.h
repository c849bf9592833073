/* Stray points: gross errors, mixed pixels at depth edges. They go before segments are cut for good. */
#ifndef ALE_EXTRACT_OUTLIER_H
#define ALE_EXTRACT_OUTLIER_H

#include "extract/workspace.h"

/* Removes the suspects (segment.h) that stand out from neighbours which agree. Adds to e->outliers.
 * O(points). */
void ale_outlier_remove_spikes(ale_extractor_t *e);

/* Removes every segment (as ale_segment left them) of so few points that it is no surface. True when there
 * were any: then segments are to be cut anew, and suspects are only the changes at the ends of those left.
 * Adds to e->outliers. O(points). */
bool ale_outlier_remove_strays(ale_extractor_t *e);

#endif
