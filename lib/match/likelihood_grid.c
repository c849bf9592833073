#include "match/likelihood_grid.h"

#include <string.h>

#include "base/fixed.h"

/* A surface in a cell, and half of it beside: cells are coarser than what least squares needs to begin. */
static void mark(ale_likelihood_grid_t *grid, ale_point_t p)
{
    const int64_t x = ((int64_t)p.x_um - grid->corner.x_um) / ALE_GRID_CELL_UM;
    const int64_t y = ((int64_t)p.y_um - grid->corner.y_um) / ALE_GRID_CELL_UM;
    if (p.x_um <= grid->corner.x_um || p.y_um <= grid->corner.y_um || x < 1 || y < 1 ||
        x > ALE_GRID_CELLS - 2 || y > ALE_GRID_CELLS - 2) {
        return;
    }
    for (int64_t v = y - 1; v <= y + 1; v++) {
        for (int64_t u = x - 1; u <= x + 1; u++) {
            grid->fine[v][u] = grid->fine[v][u] > 0 ? grid->fine[v][u] : ALE_GRID_SURFACE / 2;
        }
    }
    grid->fine[y][x] = ALE_GRID_SURFACE;
}

static void draw_walls(ale_likelihood_grid_t *grid, const ale_local_map_t *map)
{
    int32_t work = ALE_GRID_WORK;
    for (uint32_t n = 0; n < map->near_first[ALE_MAP_DIRECTIONS]; n++) {
        const ale_wall_t *wall = &map->wall[map->near[n]];
        for (int64_t t_um = wall->start_um; t_um < wall->end_um && work > 0;
             t_um += ALE_GRID_CELL_UM * 3 / 4) {
            mark(grid, ale_wall_point(wall, t_um));
            work--;
        }
        mark(grid, ale_wall_point(wall, wall->end_um));
    }
}

static void draw_landmarks(ale_likelihood_grid_t *grid, const ale_landmarks_t *landmarks)
{
    for (uint32_t i = 0; i < ALE_LANDMARK_SETS * ALE_LANDMARK_WAYS; i++) {
        const ale_landmark_t *landmark = &landmarks->landmark[i];
        if (landmark->seen > 0 && landmark->map == landmarks->selected) {
            mark(grid, landmark->p);
        }
    }
}

static void pool(ale_likelihood_grid_t *grid)
{
    for (int32_t y = 0; y < ALE_GRID_CELLS; y++) {
        uint8_t *row = grid->coarse[y / ALE_GRID_POOL];
        for (int32_t x = 0; x < ALE_GRID_CELLS; x++) {
            row[x / ALE_GRID_POOL] =
                row[x / ALE_GRID_POOL] > grid->fine[y][x] ? row[x / ALE_GRID_POOL] : grid->fine[y][x];
        }
    }
}

void ale_likelihood_grid_draw(ale_likelihood_grid_t *grid, const ale_local_map_t *map, ale_point_t centre)
{
    const int32_t half_um = ALE_GRID_CELLS / 2 * ALE_GRID_CELL_UM;
    memset(grid->fine, 0, sizeof grid->fine);
    memset(grid->coarse, 0, sizeof grid->coarse);
    grid->corner = (ale_point_t){(int32_t)ale_max64((int64_t)centre.x_um - half_um, INT32_MIN),
                                 (int32_t)ale_max64((int64_t)centre.y_um - half_um, INT32_MIN)};
    draw_walls(grid, map);
    draw_landmarks(grid, &map->landmarks);
    pool(grid);
}
