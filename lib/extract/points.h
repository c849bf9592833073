/* From a scan to points: which beams count, where they lie, and the noise measured among them. */
#ifndef ALE_EXTRACT_POINTS_H
#define ALE_EXTRACT_POINTS_H

#include "extract/workspace.h"

/* Lists the valid beams: beam, range_um, inverse_q44, count, and where many are missing: gap_after. */
void ale_points_list(ale_extractor_t *e, const ale_scan_t *scan);

/* Direction of the x axis of the points, in the sensor's frame: midway between the first and the last point,
 * so that neither the angle at which a scan begins nor empty beams around it change any number. */
uint32_t ale_points_frame_bam(const ale_extractor_t *e, const ale_scan_t *scan);

/* x_q4, y_q4 of the listed points. bearing_bam as in ale_extract_scan. O(points). */
void ale_points_place(ale_extractor_t *e, const ale_scan_t *scan, const uint32_t *bearing_bam);

/* Moves the placed points along their beams to the smoothed ranges, 1 / e->smooth_q44. O(points). */
void ale_points_place_smoothed(ale_extractor_t *e);

#endif
