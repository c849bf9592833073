/* Distances in the grid: from every cell to the nearest occupied one, and to the nearest unknown one.
 *
 * Chamfer distance with steps of 5, 7 and 11 (straight, diagonal, knight's move): for cells of 5 cm that is
 * centimetres, at most 2 % off the true distance, in two passes over what has been seen. Distances from 1.5 m
 * on count as 1.5 m. No error; the memory is the caller's. */
#ifndef ALE_PLAN_CLEARANCE_H
#define ALE_PLAN_CLEARANCE_H

#include "plan/grid.h"

enum { ALE_CLEARANCE_FAR_CM = 150 };

typedef struct {
    uint8_t to_occupied_cm[ALE_GRID_CELLS];
    uint8_t
        to_unknown_cm[ALE_GRID_CELLS]; /* to unknown cells of a patch: a single one is a gap between beams */
} ale_clearance_t;

/* As of an unknown grid: nothing worked out. O(cells). */
void ale_clearance_init(ale_clearance_t *clearance);

/* Works both out anew where they follow from the changed part. O(cells of it and of 1.5 m around it). */
void ale_clearance_update(ale_clearance_t *clearance, const ale_grid_t *grid, ale_grid_part_t changed);

#endif
