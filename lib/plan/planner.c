#include "plan/planner.h"

#include "base/fixed.h"

enum { STRAIGHT_CM = 5, DIAGONAL_CM = 7, FULL_PENALTY = 3 };
enum { UNSEEN_FACTOR = 3 }; /* a detour of that much through what has been seen is worth it */
enum { TIGHT_FACTOR = 5, MOST_FACTOR = 9, STOOD_SLACK_CM = 5 };
enum { END_CELLS = 10, REFUSED_CELLS = 6, SAME_GOAL_CELLS = 8, KEEP_COST = 150 };
_Static_assert(DIAGONAL_CM *MOST_FACTOR <= ALE_WAVEFRONT_MAX_STEP, "steps must fit the wavefront's buckets");
_Static_assert(END_CELLS > 0 && STRAIGHT_CM * 10000 == ALE_GRID_CELL_UM, "clearance counts in centimetres");

typedef struct {
    const ale_planner_t *planner;
    const ale_grid_t *grid;
    ale_cell_t start;
    ale_cell_t end; /* ALE_GRID_NONE: not known yet */
    bool ventures;  /* through what has not been seen, too */
} search_t;

void ale_planner_init(ale_planner_t *planner, const ale_planner_config_t *config)
{
    planner->config = *config;
    planner->refused_count = 0;
    ale_clearance_init(&planner->clearance);
}

void ale_planner_update(ale_planner_t *planner, ale_grid_t *grid)
{
    ale_clearance_update(&planner->clearance, grid, ale_grid_take_changed(grid));
}

static bool within(ale_cell_t a, ale_cell_t b, int64_t cells)
{
    const int64_t dx = (int64_t)(a % ALE_GRID_SIDE) - b % ALE_GRID_SIDE;
    const int64_t dy = (int64_t)(a / ALE_GRID_SIDE) - b / ALE_GRID_SIDE;
    return dx * dx + dy * dy <= cells * cells;
}

static bool near_an_end(const search_t *search, ale_cell_t cell)
{
    return within(cell, search->start, END_CELLS) ||
           (search->end != ALE_GRID_NONE && within(cell, search->end, END_CELLS));
}

/* Less than the body wants: enough in a passage, near an end of the path, or where the robot has been before.
 */
static bool is_enough(const search_t *search, ale_cell_t cell, int32_t room_cm)
{
    const ale_planner_config_t *config = &search->planner->config;
    if (room_cm >= config->tight_cm) {
        return true;
    }
    return (room_cm >= config->squeeze_cm && near_an_end(search, cell)) ||
           (room_cm >= config->squeeze_cm - STOOD_SLACK_CM && ale_grid_was_visited(search->grid, cell));
}

/* What the room about a cell costs; 0: there is too little. */
static uint32_t factor_of_room(const search_t *search, ale_cell_t cell)
{
    const ale_planner_config_t *config = &search->planner->config;
    const int32_t room_cm = search->planner->clearance.to_occupied_cm[cell];
    if (room_cm >= config->comfort_cm) {
        return 1;
    }
    if (room_cm >= config->body_cm) {
        const int32_t band_cm = config->comfort_cm - config->body_cm;
        return 1 + (uint32_t)((FULL_PENALTY * (config->comfort_cm - room_cm) + band_cm / 2) / band_cm);
    }
    if (!is_enough(search, cell, room_cm)) {
        return 0;
    }
    return (uint32_t)ale_min64(TIGHT_FACTOR + (config->body_cm - room_cm) / 2, MOST_FACTOR);
}

/* What a step into the cell costs, as a factor on its length; 0: not there. */
static uint32_t factor_of(const search_t *search, ale_cell_t cell)
{
    if (ale_grid_is_free(search->grid, cell)) {
        return factor_of_room(search, cell);
    }
    if (!search->ventures || !ale_grid_is_unknown(search->grid, cell)) {
        return 0;
    }
    const uint32_t factor = factor_of_room(search, cell);
    return factor > 0 && factor < UNSEEN_FACTOR ? UNSEEN_FACTOR : factor;
}

static void enter_neighbours(const search_t *search, ale_wavefront_t *front, ale_cell_t cell)
{
    for (int32_t dy = -1; dy <= 1; dy++) {
        for (int32_t dx = -1; dx <= 1; dx++) {
            const ale_cell_t next = (ale_cell_t)((int32_t)cell + dy * ALE_GRID_SIDE + dx);
            const uint32_t factor = next != cell ? factor_of(search, next) : 0;
            if (factor > 0) {
                const uint32_t length_cm = dx != 0 && dy != 0 ? DIAGONAL_CM : STRAIGHT_CM;
                ale_wavefront_enter(front, next, cell, factor * length_cm);
            }
        }
    }
}

static bool is_refused(const ale_planner_t *planner, ale_cell_t cell)
{
    for (uint32_t k = 0; k < planner->refused_count; k++) {
        if (within(cell, planner->refused[k], REFUSED_CELLS)) {
            return true;
        }
    }
    return false;
}

/* In a tight place only what lies right ahead counts: it may lead on. Beside it there are but corners. */
static bool is_worth_seeing(const ale_planner_t *planner, ale_cell_t cell)
{
    const int32_t room_cm = planner->clearance.to_occupied_cm[cell];
    const int32_t unknown_cm = planner->clearance.to_unknown_cm[cell];
    const int32_t see_cm = planner->config.see_cm;
    const bool worth = room_cm >= planner->config.body_cm
                           ? unknown_cm <= see_cm
                           : room_cm >= planner->config.tight_cm && unknown_cm <= see_cm / 2;
    return worth && !is_refused(planner, cell);
}

/* The path's cells beyond the route's room are left out: they are counted first, from the goal back. */
static void trace(const ale_wavefront_t *front, ale_cell_t start, ale_cell_t goal, ale_route_t *route)
{
    uint32_t length = 1;
    for (ale_cell_t cell = goal; cell != start && length < ALE_GRID_CELLS; cell = front->from[cell]) {
        length++;
    }
    ale_cell_t cell = goal;
    for (uint32_t k = length; k > 0; k--) {
        if (k <= ALE_ROUTE_CELLS) {
            route->cell[k - 1] = cell;
        }
        cell = front->from[cell];
    }
    route->count = length < ALE_ROUTE_CELLS ? length : ALE_ROUTE_CELLS;
    route->goal = goal;
    route->cost = front->cost[goal];
}

/* The nearest goal, or the last one while it is still worth it and not much farther. */
static ale_cell_t next_goal(const search_t *search, ale_wavefront_t *front, ale_cell_t last_goal)
{
    ale_cell_t best = ALE_GRID_NONE;
    for (uint32_t k = 0; k < ALE_GRID_CELLS; k++) {
        const ale_cell_t cell = ale_wavefront_next(front);
        if (cell == ALE_GRID_NONE ||
            (best != ALE_GRID_NONE && front->cost[cell] > front->cost[best] + KEEP_COST)) {
            break;
        }
        if (is_worth_seeing(search->planner, cell)) {
            const bool kept = last_goal == ALE_GRID_NONE || within(cell, last_goal, SAME_GOAL_CELLS);
            best = best == ALE_GRID_NONE || kept ? cell : best;
            if (kept) {
                break;
            }
        }
        enter_neighbours(search, front, cell);
    }
    return best;
}

bool ale_planner_explore(ale_planner_t *planner, const ale_grid_t *grid, ale_point_t robot,
                         ale_cell_t last_goal, ale_route_t *route)
{
    const search_t search = {planner, grid, ale_grid_cell(grid, robot), ALE_GRID_NONE, false};
    route->count = 0;
    if (search.start == ALE_GRID_NONE) {
        return false;
    }
    ale_wavefront_begin(&planner->front, grid, search.start);
    const ale_cell_t goal = next_goal(&search, &planner->front, last_goal);
    if (goal != ALE_GRID_NONE) {
        trace(&planner->front, search.start, goal, route);
    }
    return goal != ALE_GRID_NONE;
}

static bool find_path(const search_t *search, ale_wavefront_t *front, ale_route_t *route)
{
    route->count = 0;
    if (search->start == ALE_GRID_NONE || search->end == ALE_GRID_NONE) {
        return false;
    }
    ale_wavefront_begin(front, search->grid, search->start);
    ale_cell_t cell = ale_wavefront_next(front);
    for (uint32_t k = 0; k < ALE_GRID_CELLS && cell != ALE_GRID_NONE && cell != search->end; k++) {
        enter_neighbours(search, front, cell);
        cell = ale_wavefront_next(front);
    }
    if (cell != ALE_GRID_NONE) {
        trace(front, search->start, cell, route);
    }
    return cell != ALE_GRID_NONE;
}

bool ale_planner_go(ale_planner_t *planner, const ale_grid_t *grid, ale_point_t robot, ale_point_t place,
                    ale_route_t *route)
{
    const search_t search = {planner, grid, ale_grid_cell(grid, robot), ale_grid_cell(grid, place), false};
    return find_path(&search, &planner->front, route);
}

bool ale_planner_venture(ale_planner_t *planner, const ale_grid_t *grid, ale_point_t robot, ale_point_t place,
                         ale_route_t *route)
{
    const search_t search = {planner, grid, ale_grid_cell(grid, robot), ale_grid_cell(grid, place), true};
    return find_path(&search, &planner->front, route);
}

bool ale_planner_has_room(const ale_planner_t *planner, const ale_grid_t *grid, ale_point_t place)
{
    const ale_cell_t cell = ale_grid_cell(grid, place);
    return cell != ALE_GRID_NONE && !ale_grid_is_occupied(grid, cell) &&
           planner->clearance.to_occupied_cm[cell] >= planner->config.squeeze_cm;
}

uint32_t ale_planner_outline(const ale_planner_t *planner, const ale_grid_t *grid, const ale_route_t *route,
                             ale_point_t out[ALE_OUTLINE_POINTS])
{
    if (route->count == 0) {
        return 0;
    }
    const ale_wavefront_t *front = &planner->front;
    uint32_t steps = 1;
    for (ale_cell_t cell = route->goal; cell != route->cell[0] && steps < ALE_GRID_CELLS;
         cell = front->from[cell]) {
        steps++;
    }
    const uint32_t count = steps < 2 ? 2 : (steps < ALE_OUTLINE_POINTS ? steps : ALE_OUTLINE_POINTS);
    ale_cell_t cell = route->goal;
    uint32_t walked = 0; /* cells back from the goal */
    for (uint32_t k = count; k > 0; k--) {
        const uint32_t wanted = (count - k) * (steps - 1) / (count - 1);
        for (; walked < wanted; walked++) {
            cell = front->from[cell];
        }
        out[k - 1] = ale_grid_middle(grid, cell);
    }
    return count;
}

bool ale_planner_refuse(ale_planner_t *planner, ale_cell_t goal, uint32_t number)
{
    if (planner->refused_count == ALE_MAX_REFUSED) {
        return false;
    }
    planner->refused_in[planner->refused_count] = number;
    planner->refused[planner->refused_count++] = goal;
    return true;
}

void ale_planner_move(ale_planner_t *planner, const ale_grid_t *grid, ale_point_t corner)
{
    const int32_t columns = (corner.x_um - grid->corner.x_um) / ALE_GRID_CELL_UM;
    const int32_t rows = (corner.y_um - grid->corner.y_um) / ALE_GRID_CELL_UM;
    for (uint32_t k = 0; k < planner->refused_count; k++) {
        planner->refused[k] = (ale_cell_t)((int32_t)planner->refused[k] + rows * ALE_GRID_SIDE + columns);
    }
    ale_clearance_init(&planner->clearance);
}

void ale_planner_correct(ale_planner_t *planner, const ale_grid_t *grid, const ale_correction_t *correction)
{
    for (uint32_t k = 0; k < planner->refused_count; k++) {
        const ale_pose_t shift = ale_correction_at(correction, planner->refused_in[k]);
        const ale_point_t place = ale_pose_apply(shift, ale_grid_middle(grid, planner->refused[k]));
        const ale_cell_t cell = ale_grid_cell(grid, place);
        planner->refused[k] = cell != ALE_GRID_NONE ? cell : planner->refused[k];
    }
}

/* Half a cell at a time. */
static bool is_clear_line(const ale_planner_t *planner, const ale_grid_t *grid, ale_point_t from,
                          ale_point_t to, int32_t needed_cm)
{
    const int64_t dx_um = (int64_t)to.x_um - from.x_um;
    const int64_t dy_um = (int64_t)to.y_um - from.y_um;
    const int64_t steps = 1 + ale_max64(ale_abs64(dx_um), ale_abs64(dy_um)) / (ALE_GRID_CELL_UM / 2);
    for (int64_t k = 1; k <= steps; k++) {
        const ale_point_t p = {from.x_um + (int32_t)(dx_um * k / steps),
                               from.y_um + (int32_t)(dy_um * k / steps)};
        const ale_cell_t cell = ale_grid_cell(grid, p);
        if (cell == ALE_GRID_NONE || !ale_grid_is_free(grid, cell) ||
            planner->clearance.to_occupied_cm[cell] < needed_cm) {
            return false;
        }
    }
    return true;
}

static uint32_t cells_within(const ale_route_t *route, int32_t reach_um)
{
    const uint32_t reach = (uint32_t)(reach_um / ALE_GRID_CELL_UM);
    return reach < route->count - 1 ? reach : route->count - 1;
}

/* The least room of the path's cells up to the last one, and no more than body_cm. */
static int32_t room_up_to(const ale_planner_t *planner, const ale_route_t *route, uint32_t last)
{
    int32_t room_cm = planner->config.body_cm;
    for (uint32_t k = 0; k <= last; k++) {
        const int32_t here_cm = planner->clearance.to_occupied_cm[route->cell[k]];
        room_cm = here_cm < room_cm ? here_cm : room_cm;
    }
    return room_cm;
}

bool ale_planner_is_tight(const ale_planner_t *planner, const ale_route_t *route, int32_t reach_um)
{
    return room_up_to(planner, route, cells_within(route, reach_um)) < planner->config.body_cm;
}

ale_point_t ale_planner_lookahead(const ale_planner_t *planner, const ale_grid_t *grid,
                                  const ale_route_t *route, ale_point_t robot, int32_t reach_um)
{
    for (uint32_t k = cells_within(route, reach_um); k > 1; k--) {
        const ale_point_t p = ale_grid_middle(grid, route->cell[k]);
        if (is_clear_line(planner, grid, robot, p, room_up_to(planner, route, k))) {
            return p;
        }
    }
    return ale_grid_middle(grid, route->cell[route->count > 1 ? 1 : 0]);
}
