/* A grid around a place that tells, in constant time, whether a surface of the map is there: what a scan is
 * laid on to find where it was taken. Two resolutions: a coarse cell holds the most of its fine ones, so that
 * no place is overlooked on the coarse grid (Olson, "Real-Time Correlative Scan Matching", ICRA 2009). */
#ifndef ALE_MATCH_LIKELIHOOD_GRID_H
#define ALE_MATCH_LIKELIHOOD_GRID_H

#include <stdint.h>
#include <string.h>

#include "map/local_map.h"

enum {
    ALE_GRID_CELL_UM = 100000,
    ALE_GRID_CELLS = 256, /* a side */
    ALE_GRID_POOL = 4,    /* fine cells a side of a coarse one */
    ALE_GRID_COARSE = ALE_GRID_CELLS / ALE_GRID_POOL,
    ALE_GRID_SURFACE = 2, /* a surface is in this cell; beside it is half of that */
    ALE_GRID_WORK = 16384 /* cells of walls that are marked, at most: 1.2 km */
};

typedef struct {
    ale_point_t corner; /* of the grid, map frame */
    uint8_t fine[ALE_GRID_CELLS][ALE_GRID_CELLS];
    uint8_t coarse[ALE_GRID_COARSE][ALE_GRID_COARSE];
} ale_likelihood_grid_t;

/* Eight cells in a word, the first wherever it lies. Constant time. */
static inline uint64_t ale_grid_load(const uint8_t *cells)
{
    uint64_t word;
    memcpy(&word, cells, sizeof word);
    return word;
}

/* Draws the walls near and the landmarks of the map that is selected, with `centre` in the middle. Bounded by
 * ALE_GRID_WORK, the grid's cells, and the capacities of walls and landmarks. */
void ale_likelihood_grid_draw(ale_likelihood_grid_t *grid, const ale_local_map_t *map, ale_point_t centre);

#endif
