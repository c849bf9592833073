/* Cheapest paths from one cell over all others, in the order of their cost: Dijkstra with a queue of buckets.
 *
 *   ale_wavefront_begin(front, grid, start);
 *   while ((cell = ale_wavefront_next(front)) != ALE_GRID_NONE) {
 *       if (goal(cell)) break;
 *       ale_wavefront_enter(front, neighbour, cell, step_cost);        for its neighbours
 *   }
 *
 * Steps cost 1..ALE_WAVEFRONT_MAX_STEP, so the open cells lie in that many buckets, and everything but begin
 * is constant time. The memory is the caller's; no function fails. One owner thread. */
#ifndef ALE_PLAN_WAVEFRONT_H
#define ALE_PLAN_WAVEFRONT_H

#include "plan/grid.h"

enum { ALE_WAVEFRONT_MAX_STEP = 63, ALE_WAVEFRONT_BUCKETS = ALE_WAVEFRONT_MAX_STEP + 1 };

typedef struct {
    uint32_t now;                             /* cost that the wave has reached */
    uint32_t open;                            /* cells in buckets */
    ale_cell_t bucket[ALE_WAVEFRONT_BUCKETS]; /* first open cell of a cost, by cost modulo buckets */
    ale_cell_t later[ALE_GRID_CELLS];         /* neighbours in a bucket's list */
    ale_cell_t earlier[ALE_GRID_CELLS];
    ale_cell_t from[ALE_GRID_CELLS]; /* the cell before on the cheapest path; of the start: itself */
    uint32_t cost[ALE_GRID_CELLS];   /* UINT32_MAX: not reached */
} ale_wavefront_t;

/* Forgets all; start (which may lie outside what the grid has seen) costs 0. O(cells seen). */
void ale_wavefront_begin(ale_wavefront_t *front, const ale_grid_t *grid, ale_cell_t start);

/* The open cell with the least cost, which is final now; ALE_GRID_NONE when there is none. */
ale_cell_t ale_wavefront_next(ale_wavefront_t *front);

/* The cell may be entered from the final cell `from` for `step`, 1..ALE_WAVEFRONT_MAX_STEP; kept when it is
 * cheaper than what was known. */
void ale_wavefront_enter(ale_wavefront_t *front, ale_cell_t cell, ale_cell_t from, uint32_t step);

#endif
