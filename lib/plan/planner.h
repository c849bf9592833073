/* Paths over the grid: to what is worth seeing next, or to a place; always with room for the robot's disc.
 *
 *   ale_planner_update(planner, grid);                        the grid has changed
 *   if (ale_planner_explore(planner, grid, robot, last_goal, &route)) ...    else: all is seen
 *
 * The robot's centre may go where cells are free and the nearest occupied one is `body_cm` away; paths that
 * keep `comfort_cm` are cheaper, and where there is none `tight_cm` will do, at a price. Worth seeing is
 * every unknown patch within `see_cm` of where the centre may go: when there is none left, all that the disc
 * could sweep is known. The nearest goal by the cost of its path is taken, and kept until another is clearly
 * nearer. Frontiers: Yamauchi, CIRA 1997.
 *
 * Positions are in the map frame, um. No function allocates or keeps a pointer; routes are the caller's. One
 * owner thread. */
#ifndef ALE_PLAN_PLANNER_H
#define ALE_PLAN_PLANNER_H

#include "plan/clearance.h"
#include "plan/grid.h"
#include "plan/wavefront.h"
#include "track/correction.h"

enum { ALE_ROUTE_CELLS = 64, ALE_MAX_REFUSED = 64, ALE_OUTLINE_POINTS = 64 };

typedef struct {
    int32_t body_cm;    /* below ALE_CLEARANCE_FAR_CM, as all of these */
    int32_t tight_cm;   /* at most body_cm */
    int32_t squeeze_cm; /* at most tight_cm: enough within half a metre of both ends of a path */
    int32_t comfort_cm; /* above body_cm */
    int32_t see_cm;
} ale_planner_config_t;

/* A path's first cells, from the robot on. */
typedef struct {
    uint32_t count; /* 1..ALE_ROUTE_CELLS; 0: no path */
    ale_cell_t cell[ALE_ROUTE_CELLS];
    ale_cell_t goal;
    uint32_t cost; /* of the whole path: centimetres, more where it is narrow */
} ale_route_t;

typedef struct {
    ale_planner_config_t config;
    ale_clearance_t clearance;
    ale_wavefront_t front;
    uint32_t refused_count;
    ale_cell_t refused[ALE_MAX_REFUSED];
    uint32_t refused_in[ALE_MAX_REFUSED]; /* number of the scan */
} ale_planner_t;

/* No grid taken in, nothing refused; the configuration is copied. O(cells). */
void ale_planner_init(ale_planner_t *planner, const ale_planner_config_t *config);

/* Takes the grid's changes: before paths are asked for. O(cells changed, and those around them). */
void ale_planner_update(ale_planner_t *planner, ale_grid_t *grid);

/* The path from `robot` to what is to be seen next. last_goal: of the path before, ALE_GRID_NONE at first.
 * False, with route->count 0: there is nothing left, or the robot stands outside the grid. O(cells seen). */
bool ale_planner_explore(ale_planner_t *planner, const ale_grid_t *grid, ale_point_t robot,
                         ale_cell_t last_goal, ale_route_t *route);

/* The path from `robot` to `place`. False, with route->count 0: there is none, or one of them lies outside
 * the grid. O(cells seen). */
bool ale_planner_go(ale_planner_t *planner, const ale_grid_t *grid, ale_point_t robot, ale_point_t place,
                    ale_route_t *route);

/* The same also through what has not been seen, at a price: it may turn out to be closed. O(cells). */
bool ale_planner_venture(ale_planner_t *planner, const ale_grid_t *grid, ale_point_t robot, ale_point_t place,
                         ale_route_t *route);

/* Whether the robot could stand there, as far as is known. Constant time. */
bool ale_planner_has_room(const ale_planner_t *planner, const ale_grid_t *grid, ale_point_t place);

/* The whole of the path that was found last, in equal steps from the robot to its goal, map frame. The number
 * of points, 2 or more; 0: there is no path. O(cells of the path). */
uint32_t ale_planner_outline(const ale_planner_t *planner, const ale_grid_t *grid, const ale_route_t *route,
                             ale_point_t out[ALE_OUTLINE_POINTS]);

/* Goals within 30 cm of this one are not taken any more; number: of the newest scan. False: no room, already
 * ALE_MAX_REFUSED. Constant time. */
bool ale_planner_refuse(ale_planner_t *planner, ale_cell_t goal, uint32_t number);

/* The grid lies elsewhere now and is drawn anew: its first cell was at `corner`. What was refused stays where
 * it is; other cells must not be used any more. O(cells). */
void ale_planner_move(ale_planner_t *planner, const ale_grid_t *grid, ale_point_t corner);

/* What was refused moves as the map did. O(ALE_MAX_REFUSED). */
void ale_planner_correct(ale_planner_t *planner, const ale_grid_t *grid, const ale_correction_t *correction);

/* Whether the path leads through less room than body_cm within its first reach_um. route->count > 0.
 * O(ALE_ROUTE_CELLS). */
bool ale_planner_is_tight(const ale_planner_t *planner, const ale_route_t *route, int32_t reach_um);

/* The look-ahead point: the farthest cell of the path, at most so many straight cells along it as fit
 * reach_um, that the robot may head for in a straight line with the room that the path has; the next one when
 * there is none. count > 0. O(ALE_ROUTE_CELLS^2). */
ale_point_t ale_planner_lookahead(const ale_planner_t *planner, const ale_grid_t *grid,
                                  const ale_route_t *route, ale_point_t robot, int32_t reach_um);

#endif
