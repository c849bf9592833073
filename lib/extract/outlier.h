/* Stray points: gross errors, mixed pixels at depth edges. They go before segments are cut for good. */
#ifndef ALE_EXTRACT_OUTLIER_H
#define ALE_EXTRACT_OUTLIER_H

#include <stdint.h>

#include "extract/points.h"
#include "extract/scan_noise.h"
#include "extract/segment.h"

/* Removes the suspects (segment.h) that stand out from neighbours which agree. Returns how many. O(points).
 */
int32_t ale_outlier_remove_spikes(ale_points_t *points, ale_segments_t *segments,
                                  const ale_scan_noise_t *noise);

/* Removes every segment of so few points that it is no surface. Returns how many points: where there were
 * any, segments are to be cut anew, and suspects are only the changes at the ends of those left. O(points).
 */
int32_t ale_outlier_remove_strays(ale_points_t *points, ale_segments_t *segments);

#endif
