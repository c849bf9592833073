#include "plan/grid.h"

#include <string.h>

#include "base/fixed.h"

enum { MOST_OCCUPIED = 30, MOST_FREE = -20 };
enum { AGREEING_BEAMS = 5, WORTH_MOVING = 60 };
#define UNCLEARED_UM 75000 /* before a hit: the wall's own cell and what noise makes of it */

static const ale_grid_part_t nothing = {ALE_GRID_SIDE, -1, ALE_GRID_SIDE, -1};

void ale_grid_init(ale_grid_t *grid, ale_point_t centre)
{
    memset(grid, 0, sizeof *grid);
    const int32_t half_um = ALE_GRID_SIDE / 2 * ALE_GRID_CELL_UM;
    grid->corner = (ale_point_t){centre.x_um - half_um, centre.y_um - half_um};
    grid->extent = nothing;
    grid->changed = nothing;
}

void ale_grid_clear(ale_grid_t *grid)
{
    const ale_grid_part_t seen = grid->extent;
    const ale_point_t corner = grid->corner;
    memset(grid, 0, sizeof *grid);
    grid->corner = corner;
    grid->extent = seen;
    grid->changed = seen;
}

static bool is_lopsided(int32_t first, int32_t last)
{
    const int32_t before = first - ALE_GRID_RIM;
    const int32_t after = ALE_GRID_SIDE - 1 - ALE_GRID_RIM - last;
    return (before <= 0 && after >= WORTH_MOVING) || (after <= 0 && before >= WORTH_MOVING);
}

bool ale_grid_is_cramped(const ale_grid_t *grid, ale_point_t *middle)
{
    const ale_grid_part_t *seen = &grid->extent;
    middle->x_um = grid->corner.x_um + (seen->first_x + seen->last_x) / 2 * ALE_GRID_CELL_UM;
    middle->y_um = grid->corner.y_um + (seen->first_y + seen->last_y) / 2 * ALE_GRID_CELL_UM;
    return is_lopsided(seen->first_x, seen->last_x) || is_lopsided(seen->first_y, seen->last_y);
}

/* Column or row, rounded down, also left of the corner. */
static int32_t line_of(int64_t from_corner_um)
{
    const int64_t rest = from_corner_um % ALE_GRID_CELL_UM;
    return (int32_t)(from_corner_um / ALE_GRID_CELL_UM - (rest < 0));
}

static ale_cell_t cell_at(int32_t x, int32_t y)
{
    const int32_t last = ALE_GRID_SIDE - 1 - ALE_GRID_RIM;
    const bool inside = x >= ALE_GRID_RIM && y >= ALE_GRID_RIM && x <= last && y <= last;
    return inside ? (ale_cell_t)(y * ALE_GRID_SIDE + x) : ALE_GRID_NONE;
}

ale_cell_t ale_grid_cell(const ale_grid_t *grid, ale_point_t p)
{
    return cell_at(line_of((int64_t)p.x_um - grid->corner.x_um),
                   line_of((int64_t)p.y_um - grid->corner.y_um));
}

ale_point_t ale_grid_middle(const ale_grid_t *grid, ale_cell_t cell)
{
    const int32_t x = (int32_t)(cell % ALE_GRID_SIDE);
    const int32_t y = (int32_t)(cell / ALE_GRID_SIDE);
    return (ale_point_t){grid->corner.x_um + x * ALE_GRID_CELL_UM + ALE_GRID_CELL_UM / 2,
                         grid->corner.y_um + y * ALE_GRID_CELL_UM + ALE_GRID_CELL_UM / 2};
}

static void include(ale_grid_part_t *part, ale_cell_t cell)
{
    const int32_t x = (int32_t)(cell % ALE_GRID_SIDE);
    const int32_t y = (int32_t)(cell / ALE_GRID_SIDE);
    part->first_x = x < part->first_x ? x : part->first_x;
    part->last_x = x > part->last_x ? x : part->last_x;
    part->first_y = y < part->first_y ? y : part->first_y;
    part->last_y = y > part->last_y ? y : part->last_y;
}

ale_grid_part_t ale_grid_take_changed(ale_grid_t *grid)
{
    const ale_grid_part_t changed = grid->changed;
    grid->changed = nothing;
    return changed;
}

/* Free, unknown, perhaps occupied, occupied. */
static int32_t kind_of(int8_t evidence)
{
    return evidence < 0 ? -1 : (evidence > 0) + (evidence > ALE_GRID_HIT);
}

static void begin_scan(ale_grid_t *grid)
{
    grid->scan = grid->scan == UINT8_MAX ? 1 : (uint8_t)(grid->scan + 1);
}

/* Once a scan. 0 means never seen: evidence that cancels out leans to what was said last. */
static void change(ale_grid_t *grid, ale_cell_t cell, int32_t by)
{
    if (grid->changed_in[cell] == grid->scan) {
        return;
    }
    const int8_t before = grid->evidence[cell];
    const int64_t sum = ale_clamp64(before + by, MOST_FREE, MOST_OCCUPIED);
    const int8_t after = (int8_t)(sum != 0 ? sum : (by < 0 ? -1 : 1));
    grid->evidence[cell] = after;
    grid->changed_in[cell] = grid->scan;
    if (before == 0) {
        grid->seen++;
        include(&grid->extent, cell);
    }
    if (kind_of(before) != kind_of(after)) {
        include(&grid->changed, cell);
    }
}

void ale_grid_add_wall(ale_grid_t *grid, ale_point_t a, ale_point_t b)
{
    const int64_t dx_um = (int64_t)b.x_um - a.x_um;
    const int64_t dy_um = (int64_t)b.y_um - a.y_um;
    const int64_t steps = 1 + ale_max64(ale_abs64(dx_um), ale_abs64(dy_um)) / (ALE_GRID_CELL_UM / 2);
    begin_scan(grid);
    for (int64_t k = 0; k <= steps; k++) {
        const ale_point_t p = {(int32_t)(a.x_um + dx_um * k / steps), (int32_t)(a.y_um + dy_um * k / steps)};
        const ale_cell_t cell = ale_grid_cell(grid, p);
        if (cell != ALE_GRID_NONE) {
            change(grid, cell, 2 * ALE_GRID_HIT);
        }
    }
}

static ale_point_t end_of_beam(ale_pose_t sensor, uint32_t bearing_bam, int32_t range_um)
{
    const ale_point_t along = ale_rotate((ale_point_t){range_um, 0}, sensor.theta_bam + bearing_bam);
    return (ale_point_t){sensor.x_um + along.x_um, sensor.y_um + along.y_um};
}

/* Cell by cell along the longer axis, from the sensor on. */
static void clear_ray(ale_grid_t *grid, ale_pose_t sensor, uint32_t bearing_bam, int32_t range_um,
                      bool stops_at_hits)
{
    const ale_point_t end = end_of_beam(sensor, bearing_bam, range_um);
    const int64_t dx_um = (int64_t)end.x_um - sensor.x_um;
    const int64_t dy_um = (int64_t)end.y_um - sensor.y_um;
    const int64_t steps = ale_max64(ale_abs64(dx_um), ale_abs64(dy_um)) / ALE_GRID_CELL_UM;
    const int64_t x_um = (int64_t)sensor.x_um - grid->corner.x_um;
    const int64_t y_um = (int64_t)sensor.y_um - grid->corner.y_um;
    for (int64_t k = 0; k <= steps; k++) {
        const int64_t of = steps > 0 ? steps : 1;
        const ale_cell_t cell = cell_at(line_of(x_um + dx_um * k / of), line_of(y_um + dy_um * k / of));
        if (cell == ALE_GRID_NONE || (stops_at_hits && grid->evidence[cell] > 0)) {
            return;
        }
        change(grid, cell, ALE_GRID_PASS);
    }
}

static void add_hits(ale_grid_t *grid, const ale_scan_t *scan, const uint32_t bearing_bam[],
                     ale_pose_t sensor)
{
    for (int32_t k = 0; k < scan->beams; k++) {
        if (scan->flag[k] == ALE_BEAM_VALID) {
            const ale_point_t hit = end_of_beam(sensor, bearing_bam[k], scan->range_um[k]);
            const ale_cell_t cell = ale_grid_cell(grid, hit);
            if (cell != ALE_GRID_NONE) {
                change(grid, cell, ALE_GRID_HIT);
            }
        }
    }
}

void ale_grid_add_scan(ale_grid_t *grid, const ale_scan_t *scan, const uint32_t bearing_bam[],
                       ale_pose_t sensor)
{
    begin_scan(grid);
    add_hits(grid, scan, bearing_bam, sensor);
    int32_t silent = 0;
    for (int32_t k = 0; k < scan->beams; k++) {
        silent = scan->flag[k] == ALE_BEAM_NO_RETURN ? silent + 1 : 0;
        if (scan->flag[k] == ALE_BEAM_VALID && scan->range_um[k] > UNCLEARED_UM) {
            clear_ray(grid, sensor, bearing_bam[k], scan->range_um[k] - UNCLEARED_UM, false);
        } else if (silent >= AGREEING_BEAMS) {
            const int32_t middle = k - AGREEING_BEAMS / 2;
            clear_ray(grid, sensor, bearing_bam[middle], scan->range_max_um / 4 * 3, true);
        }
    }
}

static void note_place(ale_grid_t *grid, ale_point_t p)
{
    for (int32_t k = 0; k < 9; k++) {
        const ale_point_t q = {p.x_um + (k % 3 - 1) * ALE_GRID_CELL_UM,
                               p.y_um + (k / 3 - 1) * ALE_GRID_CELL_UM};
        const ale_cell_t cell = ale_grid_cell(grid, q);
        if (cell != ALE_GRID_NONE) {
            grid->visited[cell / 32] |= UINT32_C(1) << (cell % 32);
        }
    }
}

void ale_grid_add_disc(ale_grid_t *grid, ale_point_t p, int32_t radius_um)
{
    note_place(grid, p);
    const int32_t reach = radius_um / ALE_GRID_CELL_UM + 1;
    const int64_t radius2 = (int64_t)radius_um * radius_um;
    for (int32_t dy = -reach; dy <= reach; dy++) {
        for (int32_t dx = -reach; dx <= reach; dx++) {
            const ale_point_t q = {p.x_um + dx * ALE_GRID_CELL_UM, p.y_um + dy * ALE_GRID_CELL_UM};
            const ale_cell_t cell = ale_grid_cell(grid, q);
            const int64_t d2 = (int64_t)dx * dx + (int64_t)dy * dy;
            if (cell != ALE_GRID_NONE && d2 * ALE_GRID_CELL_UM * ALE_GRID_CELL_UM <= radius2) {
                change(grid, cell, ALE_GRID_PASS);
            }
        }
    }
}
