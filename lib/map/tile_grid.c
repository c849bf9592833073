#include "map/tile_grid.h"

#include "base/fixed.h"

enum { UM_PER_MM = 1000, TOUCHES_MM = 2 };

static int32_t tile_at(int64_t um, int32_t side_um)
{
    return (int32_t)((um >= 0 ? um : um - side_um + 1) / side_um);
}

ale_tile_range_t ale_tile_range_around(ale_point_t place, int64_t reach_um, int32_t side_um)
{
    return (ale_tile_range_t){
        tile_at(place.x_um - reach_um, side_um), tile_at(place.y_um - reach_um, side_um),
        tile_at(place.x_um + reach_um, side_um), tile_at(place.y_um + reach_um, side_um)};
}

static bool is_empty(ale_tile_range_t range)
{
    return range.first_x > range.last_x || range.first_y > range.last_y;
}

ale_tile_range_t ale_tile_range_follow(ale_tile_range_t present, ale_point_t place, int64_t near_um,
                                       int64_t far_um, int32_t side_um)
{
    const ale_tile_range_t wanted = ale_tile_range_around(place, near_um, side_um);
    const ale_tile_range_t kept = ale_tile_range_around(place, far_um, side_um);
    const bool apart = is_empty(present) || present.first_x > kept.last_x || present.last_x < kept.first_x ||
                       present.first_y > kept.last_y || present.last_y < kept.first_y;
    if (apart) {
        return wanted;
    }
    return (ale_tile_range_t){(int32_t)ale_clamp64(present.first_x, kept.first_x, wanted.first_x),
                              (int32_t)ale_clamp64(present.first_y, kept.first_y, wanted.first_y),
                              (int32_t)ale_clamp64(present.last_x, wanted.last_x, kept.last_x),
                              (int32_t)ale_clamp64(present.last_y, wanted.last_y, kept.last_y)};
}

bool ale_tile_range_has(ale_tile_range_t range, int32_t x, int32_t y)
{
    return x >= range.first_x && x <= range.last_x && y >= range.first_y && y <= range.last_y;
}

bool ale_tile_range_equals(ale_tile_range_t a, ale_tile_range_t b)
{
    return a.first_x == b.first_x && a.first_y == b.first_y && a.last_x == b.last_x && a.last_y == b.last_y;
}

ale_box_t ale_tile_range_box(ale_tile_range_t range, int32_t side_um)
{
    return (ale_box_t){(int64_t)range.first_x * side_um, (int64_t)range.first_y * side_um,
                       ((int64_t)range.last_x + 1) * side_um, ((int64_t)range.last_y + 1) * side_um};
}

bool ale_box_has(const ale_box_t *box, ale_point_t p)
{
    return p.x_um >= box->min_x_um && p.x_um <= box->max_x_um && p.y_um >= box->min_y_um &&
           p.y_um <= box->max_y_um;
}

static int64_t mm(int64_t um)
{
    return ale_round_div(um, UM_PER_MM);
}

/* All corners of the box lie on one side of the segment's line, more than TOUCHES_MM off. Millimetres, whose
 * products fit: each corner is a whole number of them, so that this grows with the box. */
static bool is_beside(const ale_box_t *box, ale_point_t start, ale_point_t end)
{
    const int64_t along_x = mm(end.x_um) - mm(start.x_um);
    const int64_t along_y = mm(end.y_um) - mm(start.y_um);
    const int64_t corner_x[2] = {mm(box->min_x_um) - mm(start.x_um), mm(box->max_x_um) - mm(start.x_um)};
    const int64_t corner_y[2] = {mm(box->min_y_um) - mm(start.y_um), mm(box->max_y_um) - mm(start.y_um)};
    const int64_t slack = TOUCHES_MM * (ale_abs64(along_x) + ale_abs64(along_y));
    int64_t least = INT64_MAX;
    int64_t most = INT64_MIN;
    for (int k = 0; k < 4; k++) {
        const int64_t side = along_x * corner_y[k / 2] - along_y * corner_x[k % 2];
        least = ale_min64(least, side);
        most = ale_max64(most, side);
    }
    return least > slack || most < -slack;
}

bool ale_box_touches(const ale_box_t *box, ale_point_t start, ale_point_t end)
{
    const bool apart =
        ale_min64(start.x_um, end.x_um) > box->max_x_um || ale_max64(start.x_um, end.x_um) < box->min_x_um ||
        ale_min64(start.y_um, end.y_um) > box->max_y_um || ale_max64(start.y_um, end.y_um) < box->min_y_um;
    return !apart && !is_beside(box, start, end);
}
