/* Points of any ranges and noise, cut where the surface does not go on.
 *
 * proves: lib/extract/segment.c
 * with: lib/base/fixed.c
 * kernel: -no-warn-invalid-bool
 * options: -warn-invalid-bool -eva-precision 0 -eva-plevel 1100 */
#include "unknown.h"
#include "unknown_points.h"

#include "extract/segment.h"

static ale_points_t points;
static ale_scan_noise_t noise;
static ale_segments_t segments;
static ale_segments_t suspected;

void main(void)
{
    unknown_points(&points);
    unknown_noise(&noise);
    ale_segment_suspect(&suspected, &points, &noise);
    unknown_segments(&segments);
    ale_segment_cut(&segments, &points, &noise);
    points.count = (uint16_t)unknown(1, ALE_MAX_BEAMS);
    const int32_t i = (int32_t)unknown(0, ALE_MAX_BEAMS - 1);
    ale_segment_beyond(&points, &segments, i, unknown(0, 1) ? 1 : -1);
    ale_segment_joins(&segments, i, (int32_t)unknown(0, ALE_MAX_BEAMS - 1));
}
