/* Lines of any place, direction, covariance and beams, of a scan with two ends and of a whole turn.
 *
 * proves: lib/extract/corner.c
 * with: lib/base/fixed.c
 * options: -eva-plevel 300 -eva-auto-loop-unroll 140 */
#include "unknown.h"
#include "unknown_features.h"

#include "extract/corner.h"

void main(void)
{
    static ale_features_t features;
    //@ loop unroll 1;
    for (uint32_t k = 0; k < ALE_MAX_LINES; k++) {
        features.line[k] = unknown_line();
    }
    features.line_count = (uint16_t)unknown(0, ALE_MAX_LINES);
    ale_corner_find(unknown(0, 3141592654), (int32_t)unknown(0, 2 * ALE_MAX_BEAMS), &features);
}
