#include "match/likelihood_grid.h"

#include <string.h>

#include "base/fixed.h"

enum {
    CELL_BITS = 24, /* fraction of a coordinate in cells */
    ALIKE = 8,      /* cells to a word that are worked on at once */
    BESIDE = ALE_GRID_SURFACE / 2
};

static const uint64_t surfaces = 0x0101010101010101u * ALE_GRID_SURFACE;
_Static_assert(ALE_GRID_SURFACE == 2 && ALE_GRID_CELLS % ALIKE == 0 && ALE_GRID_POOL == 4,
               "surface and beside are a bit each; words hold whole parts of rows, and two coarse cells");

/* A place on the grid, in cells. */
typedef struct {
    int64_t x;
    int64_t y;
} place_t;

static place_t place_of(const ale_likelihood_grid_t *grid, ale_point_t p)
{
    return (place_t){((int64_t)p.x_um - grid->corner.x_um) * (1 << CELL_BITS) / ALE_GRID_CELL_UM,
                     ((int64_t)p.y_um - grid->corner.y_um) * (1 << CELL_BITS) / ALE_GRID_CELL_UM};
}

/* The outermost cells stay free. */
static inline bool is_inside(int64_t x)
{
    const int64_t cell = (int64_t)1 << CELL_BITS;
    return (uint64_t)(x - cell) < (uint64_t)((ALE_GRID_CELLS - 2) * cell);
}

static inline void mark(ale_likelihood_grid_t *grid, place_t p)
{
    if (is_inside(p.x) && is_inside(p.y)) {
        grid->fine[(uint64_t)p.y >> CELL_BITS][(uint64_t)p.x >> CELL_BITS] = ALE_GRID_SURFACE;
    }
}

/* Both ends lie beyond the same border. */
static bool is_beyond(int64_t a, int64_t b)
{
    return ale_max64(a, b) < 0 || ale_min64(a, b) >= (int64_t)ALE_GRID_CELLS << CELL_BITS;
}

/* Every three quarters of a cell along the wall. */
static void draw_wall(ale_likelihood_grid_t *grid, const ale_wall_t *wall, int32_t *work)
{
    place_t p = place_of(grid, ale_wall_point(wall, wall->start_um));
    const place_t end = place_of(grid, ale_wall_point(wall, wall->end_um));
    if (is_beyond(p.x, end.x) || is_beyond(p.y, end.y)) {
        return;
    }
    const place_t step = {ale_round_shift((int64_t)wall->normal_y_q30 * 3, 32 - CELL_BITS),
                          ale_round_shift((int64_t)wall->normal_x_q30 * -3, 32 - CELL_BITS)};
    const int64_t length_um = (int64_t)wall->end_um - wall->start_um;
    const int64_t steps = ale_min64((length_um * 4 - 1) / ((int64_t)ALE_GRID_CELL_UM * 3) + 1, *work);
    *work -= (int32_t)steps;
    for (int64_t k = 0; k < steps; k++) {
        mark(grid, p);
        p.x += step.x;
        p.y += step.y;
    }
    mark(grid, end);
}

static void draw_walls(ale_likelihood_grid_t *grid, const ale_local_map_t *map)
{
    int32_t work = ALE_GRID_WORK;
    for (uint32_t n = 0; n < map->near_first[ALE_MAP_DIRECTIONS]; n++) {
        draw_wall(grid, &map->wall[map->near[n]], &work);
    }
}

static void draw_landmarks(ale_likelihood_grid_t *grid, const ale_landmarks_t *landmarks)
{
    for (uint32_t i = 0; i < ALE_LANDMARK_SETS * ALE_LANDMARK_WAYS; i++) {
        const ale_landmark_t *landmark = &landmarks->landmark[i];
        if (landmark->seen > 0 && landmark->map == landmarks->selected) {
            mark(grid, place_of(grid, landmark->p));
        }
    }
}

static inline void store(uint8_t *cells, uint64_t word)
{
    memcpy(cells, &word, sizeof word);
}

/* What lies beside a surface says half of one: cells are coarser than what least squares needs to begin. */
static void spread(ale_likelihood_grid_t *grid)
{
    uint8_t column[ALIKE + ALE_GRID_CELLS + ALIKE] = {0}; /* a surface above, below or in the cell */
    for (int32_t y = 1; y < ALE_GRID_CELLS - 1; y++) {
        for (int32_t x = 0; x < ALE_GRID_CELLS; x += ALIKE) {
            store(&column[ALIKE + x],
                  (ale_grid_load(&grid->fine[y - 1][x]) | ale_grid_load(&grid->fine[y][x]) |
                   ale_grid_load(&grid->fine[y + 1][x])) &
                      surfaces);
        }
        for (int32_t x = 0; x < ALE_GRID_CELLS; x += ALIKE) {
            const uint8_t *at = &column[ALIKE + x];
            const uint64_t own = ale_grid_load(&grid->fine[y][x]);
            store(&grid->fine[y][x],
                  own | ((ale_grid_load(at - 1) | ale_grid_load(at) | ale_grid_load(at + 1)) & ~own) >> 1);
        }
    }
}

/* Of cells that lie one upon the other in the lowest byte, each of which is none, beside or a surface. */
static inline uint8_t most_of(uint32_t any)
{
    return (uint8_t)(any & ALE_GRID_SURFACE ? ALE_GRID_SURFACE : any & BESIDE);
}

/* Two coarse cells at a time: a word of each of their four rows. */
static void pool(ale_likelihood_grid_t *grid)
{
    for (int32_t y = 0; y < ALE_GRID_COARSE; y++) {
        for (int32_t x = 0; x < ALE_GRID_COARSE; x += ALIKE / ALE_GRID_POOL) {
            uint64_t any = 0;
            for (int32_t v = 0; v < ALE_GRID_POOL; v++) {
                const uint8_t *fine = grid->fine[y * ALE_GRID_POOL + v];
                const int32_t first = x * ALE_GRID_POOL;
                any |= ale_grid_load(&fine[first]);
            }
            any |= any >> 16;
            any |= any >> 8;
            uint32_t half[ALIKE / ALE_GRID_POOL]; /* in the order of the cells, whatever that of the bytes */
            memcpy(half, &any, sizeof half);
            grid->coarse[y][x] = most_of(half[0]);
            grid->coarse[y][x + 1] = most_of(half[1]);
        }
    }
}

void ale_likelihood_grid_draw(ale_likelihood_grid_t *grid, const ale_local_map_t *map, ale_point_t centre)
{
    const int32_t half_um = ALE_GRID_CELLS / 2 * ALE_GRID_CELL_UM;
    memset(grid->fine, 0, sizeof grid->fine);
    grid->corner = (ale_point_t){(int32_t)ale_max64((int64_t)centre.x_um - half_um, INT32_MIN),
                                 (int32_t)ale_max64((int64_t)centre.y_um - half_um, INT32_MIN)};
    draw_walls(grid, map);
    draw_landmarks(grid, &map->landmarks);
    spread(grid);
    pool(grid);
}
