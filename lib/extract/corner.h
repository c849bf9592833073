/* Corners: real edges of two adjoining lines (paper IV). */
#ifndef ALE_EXTRACT_CORNER_H
#define ALE_EXTRACT_CORNER_H

#include "extract/extract.h"

/* Fills out->corner from out->line (in beam order). O(lines). */
void ale_corner_find(ale_features_t *out);

#endif
