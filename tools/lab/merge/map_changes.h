/* What is not as it was: two maps of one frame, wall by wall. */
#ifndef ALE_LAB_MERGE_MAP_CHANGES_H
#define ALE_LAB_MERGE_MAP_CHANGES_H

#include <vector>

#include "common/export/map_image.h"

namespace merge
{

/* Cells of 5 cm: a cell of a wall is as it was where the other map has a wall within 80 mm that faces the
 * same way. Runs of at least 200 mm of others are new or gone. A gone and a new one that are walls of their
 * own and no parts of longer ones, face alike, are alike in length and lie within 2 m of each other are one
 * that was moved, the nearest first.
 *
 * Both maps tidied (map_tidy.h), so that a wall counts once. O(walls^2 * cells of a wall). */
std::vector<ale::ChangedWall> changes_between(const ale_map_t &before, const ale_map_t &now);

/* Length of all walls, each rounded to whole millimetres. */
int64_t walls_um(const ale_map_t &map);

} // namespace merge

#endif
