/* A map as people want to see it: one line for one wall.
 *
 * While it drives, the tracker may have begun a wall anew beside one that it knew, because its heading had
 * drifted or because the wall is less straight than the noise allows; for matching they are kept apart. Two
 * lines that face the same way, run side by side and lie less than ALE_TIDY_OFFSET_UM apart cannot both
 * be seen: the nearer one hides the other. They are drawn as one. Lines of maps that are not joined stay
 * apart.
 *
 * For ordinary threads: the work grows with the square of the lines (2048: some 10^7 steps). */
#ifndef ALE_COMMON_EXPORT_MAP_TIDY_H
#define ALE_COMMON_EXPORT_MAP_TIDY_H

#include "track/pipeline.h"

enum { ALE_TIDY_OFFSET_UM = 120000, ALE_TIDY_ANGLE_MRAD = 350 };

/* Joins the lines of *map that show the same wall; the rest stays as it is, in its order. A joined line has
 * the id and the covariance of the one with more evidence (scans times length), the mean direction and place
 * by evidence, and reaches as far as both did. */
#ifdef __cplusplus
extern "C"
#endif
    void
    ale_map_tidy(ale_map_t *map);

#endif
