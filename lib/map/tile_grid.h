/* Squares of the map's frame, of equal side, by which a large map is stored: its tiles.
 *
 *   y  | tile (0, 1) | tile (1, 1) |      tile (x, y) holds x * side <= p.x < (x + 1) * side, and y alike;
 *      | tile (0, 0) | tile (1, 0) |      a wall is in each tile that it touches
 *      0           side            x
 *
 * Around the robot a range of tiles, a rectangle, is loaded. Pure functions; constant time where none is
 * stated. */
#ifndef ALE_MAP_TILE_GRID_H
#define ALE_MAP_TILE_GRID_H

#include <stdbool.h>
#include <stdint.h>

#include "base/pose.h"

/* Sides of tiles: whole millimetres. */
enum { ALE_TILE_SIDE_LEAST_UM = 1000000, ALE_TILE_SIDE_MOST_UM = 1000000000 };

/* Tiles from first to last, both included; none when a first one exceeds its last. */
typedef struct {
    int32_t first_x;
    int32_t first_y;
    int32_t last_x;
    int32_t last_y;
} ale_tile_range_t;

/* The same in the map's frame: edges included. */
typedef struct {
    int64_t min_x_um;
    int64_t min_y_um;
    int64_t max_x_um;
    int64_t max_y_um;
} ale_box_t;

/* The tiles that touch the square of half width reach_um (0 to 2^31) around a place. */
ale_tile_range_t ale_tile_range_around(ale_point_t place, int64_t reach_um, int32_t side_um);

/* The range that is to be loaded next: all within near_um of the place, and of the present range what is
 * within far_um. So a robot that goes to and fro at an edge loads nothing twice. near_um <= far_um. */
ale_tile_range_t ale_tile_range_follow(ale_tile_range_t present, ale_point_t place, int64_t near_um,
                                       int64_t far_um, int32_t side_um);

bool ale_tile_range_has(ale_tile_range_t range, int32_t x, int32_t y);
bool ale_tile_range_equals(ale_tile_range_t a, ale_tile_range_t b);
ale_box_t ale_tile_range_box(ale_tile_range_t range, int32_t side_um);

bool ale_box_has(const ale_box_t *box, ale_point_t p);

/* Whether a segment touches a box of tiles, to 3 mm. What touches a box touches every box of tiles that holds
 * that one. */
bool ale_box_touches(const ale_box_t *box, ale_point_t start, ale_point_t end);

#endif
