#include "plan/wavefront.h"

#include "base/fixed.h"

static ale_cell_t *bucket_of(ale_wavefront_t *front, uint32_t cost)
{
    return &front->bucket[cost % ALE_WAVEFRONT_BUCKETS];
}

static void put(ale_wavefront_t *front, ale_cell_t cell)
{
    ale_cell_t *first = bucket_of(front, front->cost[cell]);
    front->later[cell] = *first;
    front->earlier[cell] = ALE_GRID_NONE;
    if (*first != ALE_GRID_NONE) {
        front->earlier[*first] = cell;
    }
    *first = cell;
    front->open++;
}

static void take(ale_wavefront_t *front, ale_cell_t cell)
{
    const ale_cell_t later = front->later[cell];
    const ale_cell_t earlier = front->earlier[cell];
    if (later != ALE_GRID_NONE) {
        front->earlier[later] = earlier;
    }
    if (earlier != ALE_GRID_NONE) {
        front->later[earlier] = later;
    } else {
        *bucket_of(front, front->cost[cell]) = later;
    }
    front->open--;
}

void ale_wavefront_begin(ale_wavefront_t *front, const ale_grid_t *grid, ale_cell_t start)
{
    for (int32_t y = grid->extent.first_y - 1; y <= grid->extent.last_y + 1; y++) {
        for (int32_t x = grid->extent.first_x - 1; x <= grid->extent.last_x + 1; x++) {
            front->cost[y * ALE_GRID_SIDE + x] = UINT32_MAX;
        }
    }
    for (uint32_t k = 0; k < ALE_WAVEFRONT_BUCKETS; k++) {
        front->bucket[k] = ALE_GRID_NONE;
    }
    front->now = 0;
    front->open = 0;
    front->cost[start] = 0;
    front->from[start] = start;
    put(front, start);
}

ale_cell_t ale_wavefront_next(ale_wavefront_t *front)
{
    if (front->open == 0) {
        return ALE_GRID_NONE;
    }
    for (uint32_t k = 0; k < ALE_WAVEFRONT_BUCKETS && *bucket_of(front, front->now) == ALE_GRID_NONE; k++) {
        front->now++;
    }
    const ale_cell_t cell = *bucket_of(front, front->now);
    take(front, cell);
    return cell;
}

void ale_wavefront_enter(ale_wavefront_t *front, ale_cell_t cell, ale_cell_t from, uint32_t step)
{
    const uint32_t cost = front->now + step;
    if (cost >= front->cost[cell]) {
        return;
    }
    if (front->cost[cell] != UINT32_MAX) {
        take(front, cell);
    }
    front->cost[cell] = cost;
    front->from[cell] = from;
    put(front, cell);
}
