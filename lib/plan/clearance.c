#include "plan/clearance.h"

#include <string.h>

#include "base/fixed.h"

enum { STRAIGHT = 5, DIAGONAL = 7, KNIGHT = 11, PATCH_NEIGHBOURS = 3 };
/* How far a change is felt; one more, because a patch is known by its neighbours. */
enum { FAR_CELLS = ALE_CLEARANCE_FAR_CM / STRAIGHT + 1 };

typedef struct {
    int32_t x;
    int32_t y;
    uint8_t cm;
} step_t;

/* The half of the neighbours that comes before a cell, row by row; the other half is opposite. */
static const step_t before[] = {{-1, 0, STRAIGHT}, {0, -1, STRAIGHT}, {-1, -1, DIAGONAL}, {1, -1, DIAGONAL},
                                {-2, -1, KNIGHT},  {2, -1, KNIGHT},   {-1, -2, KNIGHT},   {1, -2, KNIGHT}};
enum { STEPS = sizeof before / sizeof before[0] };

void ale_clearance_init(ale_clearance_t *clearance)
{
    memset(clearance->to_occupied_cm, ALE_CLEARANCE_FAR_CM, sizeof clearance->to_occupied_cm);
    memset(clearance->to_unknown_cm, 0, sizeof clearance->to_unknown_cm);
}

/* An unknown cell with at least three unknown ones around it. */
static bool is_unknown_patch(const ale_grid_t *grid, ale_cell_t cell)
{
    if (!ale_grid_is_unknown(grid, cell)) {
        return false;
    }
    int32_t unknown = -1; /* itself */
    for (int32_t dy = -1; dy <= 1; dy++) {
        for (int32_t dx = -1; dx <= 1; dx++) {
            unknown += ale_grid_is_unknown(grid, (ale_cell_t)((int32_t)cell + dy * ALE_GRID_SIDE + dx));
        }
    }
    return unknown >= PATCH_NEIGHBOURS;
}

static uint8_t through_neighbours(const uint8_t cm[], ale_cell_t cell, int32_t sign)
{
    int32_t least = cm[cell];
    for (int32_t k = 0; k < STEPS; k++) {
        const int32_t offset = sign * (before[k].y * ALE_GRID_SIDE + before[k].x);
        const int32_t through = cm[(int32_t)cell + offset] + before[k].cm;
        least = through < least ? through : least;
    }
    return (uint8_t)least;
}

static void spread_forward(uint8_t cm[], ale_grid_part_t part)
{
    for (int32_t y = part.first_y; y <= part.last_y; y++) {
        for (int32_t x = part.first_x; x <= part.last_x; x++) {
            const ale_cell_t cell = (ale_cell_t)(y * ALE_GRID_SIDE + x);
            cm[cell] = through_neighbours(cm, cell, 1);
        }
    }
}

static void spread_backward(uint8_t cm[], ale_grid_part_t part)
{
    for (int32_t y = part.last_y; y >= part.first_y; y--) {
        for (int32_t x = part.last_x; x >= part.first_x; x--) {
            const ale_cell_t cell = (ale_cell_t)(y * ALE_GRID_SIDE + x);
            cm[cell] = through_neighbours(cm, cell, -1);
        }
    }
}

static ale_grid_part_t widened(ale_grid_part_t part)
{
    const int64_t last = ALE_GRID_SIDE - ALE_GRID_RIM;
    return (ale_grid_part_t){(int32_t)ale_max64(part.first_x - FAR_CELLS, ALE_GRID_RIM - 1),
                             (int32_t)ale_min64(part.last_x + FAR_CELLS, last),
                             (int32_t)ale_max64(part.first_y - FAR_CELLS, ALE_GRID_RIM - 1),
                             (int32_t)ale_min64(part.last_y + FAR_CELLS, last)};
}

void ale_clearance_update(ale_clearance_t *clearance, const ale_grid_t *grid, ale_grid_part_t changed)
{
    if (changed.first_x > changed.last_x) {
        return;
    }
    const ale_grid_part_t part = widened(changed);
    for (int32_t y = part.first_y; y <= part.last_y; y++) {
        for (int32_t x = part.first_x; x <= part.last_x; x++) {
            const ale_cell_t cell = (ale_cell_t)(y * ALE_GRID_SIDE + x);
            clearance->to_occupied_cm[cell] = ale_grid_is_occupied(grid, cell) ? 0 : ALE_CLEARANCE_FAR_CM;
            clearance->to_unknown_cm[cell] = is_unknown_patch(grid, cell) ? 0 : ALE_CLEARANCE_FAR_CM;
        }
    }
    spread_forward(clearance->to_occupied_cm, part);
    spread_backward(clearance->to_occupied_cm, part);
    spread_forward(clearance->to_unknown_cm, part);
    spread_backward(clearance->to_unknown_cm, part);
}
