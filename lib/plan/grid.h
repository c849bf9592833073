/* Free and occupied space from scans and poses: a square of cells about the place it was begun at.
 *
 *   ale_grid_init(grid, centre);
 *   ale_grid_add_scan(grid, &scan, bearing_bam, sensor_pose);      every scan with a good pose
 *   ale_grid_add_disc(grid, robot, radius_um);                     where the robot stands nothing else does
 *   if (ale_grid_is_free(grid, ale_grid_cell(grid, p))) ...
 *
 * A cell holds evidence, one signed byte: below 0 free, 0 never seen, above 0 perhaps occupied, from the
 * second hit on occupied (one alone may be a mixed pixel). A beam that ends in a cell counts more than one
 * that passes and comes before it, evidence is bounded, and a cell changes once a scan: what moves away is
 * forgotten after 1.5 s of looking at it. What lies beyond the square is never seen.
 * One owner thread; no allocation, every loop bounded; no function fails or keeps a pointer. The memory is
 * the caller's. */
#ifndef ALE_PLAN_GRID_H
#define ALE_PLAN_GRID_H

#include <stdbool.h>
#include <stdint.h>

#include "base/pose.h"
#include "base/scan.h"

/* 51.2 m square: a floor of a house. The outermost cells stay unknown, so that every cell looked at has its
 * neighbours. */
enum { ALE_GRID_SIDE = 1024, ALE_GRID_CELLS = ALE_GRID_SIDE * ALE_GRID_SIDE, ALE_GRID_RIM = 3 };
#define ALE_GRID_CELL_UM 50000

/* A hit outweighs two passes: beams that graze a wall run through its cells. */
enum { ALE_GRID_HIT = 5, ALE_GRID_PASS = -2 };

/* Index of a cell, row by row; ALE_GRID_NONE: outside. */
typedef uint32_t ale_cell_t;
#define ALE_GRID_NONE UINT32_MAX

/* Columns and rows, inclusive; nothing: first > last. */
typedef struct {
    int32_t first_x;
    int32_t last_x;
    int32_t first_y;
    int32_t last_y;
} ale_grid_part_t;

typedef struct {
    ale_point_t corner;      /* of the first cell, map frame */
    ale_grid_part_t extent;  /* all cells seen */
    ale_grid_part_t changed; /* cells that became free, occupied or seen since ale_grid_take_changed */
    uint32_t seen;           /* cells seen */
    uint8_t scan;            /* number of the scan being added, 1..255 */
    int8_t evidence[ALE_GRID_CELLS];
    uint32_t visited[ALE_GRID_CELLS / 32]; /* a bit a cell: the robot's centre has been there, or beside it */
    uint8_t changed_in[ALE_GRID_CELLS];    /* the scan that changed it last */
} ale_grid_t;

/* Everything unknown. centre: middle of the square, map frame, |x|, |y| up to 1 km. O(cells). */
void ale_grid_init(ale_grid_t *grid, ale_point_t centre);

/* Everything unknown again, at the same place: to be drawn anew. What had been seen counts as changed.
 * O(cells). */
void ale_grid_clear(ale_grid_t *grid);

/* True: what has been seen comes up to the square's border on one side and leaves 3 m or more on the opposite
 * one. *middle: what has been seen would have the same room all round in a square about it; whole cells away
 * from the square's own middle. */
bool ale_grid_is_cramped(const ale_grid_t *grid, ale_point_t *middle);

/* Adds a scan seen from `sensor` (map frame). bearing_bam[k]: bearing of beam k in the sensor's frame,
 * straightened with its range. Beams without return clear three quarters of the reach, up to the first cell
 * that was hit, where at least five neighbours agree. O(beams * reach / cell). */
void ale_grid_add_scan(ale_grid_t *grid, const ale_scan_t *scan, const uint32_t bearing_bam[],
                       ale_pose_t sensor);

/* The robot stood at p when the scan added last was taken: what lies within radius_um (up to 2 m) is free,
 * where that scan does not say otherwise. O(radius^2). */
void ale_grid_add_disc(ale_grid_t *grid, ale_point_t p, int32_t radius_um);

/* A wall that a map knows, from a to b: occupied until scans say otherwise. It counts as seen. O(length /
 * cell).
 */
void ale_grid_add_wall(ale_grid_t *grid, ale_point_t a, ale_point_t b);

/* The part with changes, which begins anew. Constant time. */
ale_grid_part_t ale_grid_take_changed(ale_grid_t *grid);

/* The cell that holds p, ALE_GRID_NONE outside the rim; the middle of a cell, map frame. Constant time. */
ale_cell_t ale_grid_cell(const ale_grid_t *grid, ale_point_t p);
ale_point_t ale_grid_middle(const ale_grid_t *grid, ale_cell_t cell);

static inline bool ale_grid_is_free(const ale_grid_t *grid, ale_cell_t cell)
{
    return grid->evidence[cell] < 0;
}

static inline bool ale_grid_is_occupied(const ale_grid_t *grid, ale_cell_t cell)
{
    return grid->evidence[cell] > ALE_GRID_HIT;
}

/* Where the robot was it may go again. */
static inline bool ale_grid_was_visited(const ale_grid_t *grid, ale_cell_t cell)
{
    return ((grid->visited[cell / 32] >> (cell % 32)) & 1U) != 0;
}

static inline bool ale_grid_is_unknown(const ale_grid_t *grid, ale_cell_t cell)
{
    return grid->evidence[cell] == 0;
}

#endif
