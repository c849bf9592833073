/* Corners: real edges of two adjoining lines (paper IV). */
#ifndef ALE_EXTRACT_CORNER_H
#define ALE_EXTRACT_CORNER_H

#include "extract/features.h"

/* Fills out->corner from out->line (in beam order), and says how well the ends of adjoining lines are known,
 * which is what they are told apart by. step_nrad: from beam to beam, without sign; turn_beams: of a whole
 * turn, in which the first line follows the last one, or 0. O(lines). */
void ale_corner_find(int64_t step_nrad, int32_t turn_beams, ale_features_t *out);

#endif
