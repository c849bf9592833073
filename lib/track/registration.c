#include "track/registration.h"

#include <string.h>

#include "base/fixed.h"
#include "base/trig.h"

enum {
    MIDDLE = ALE_REGISTRATION_CELLS / 2,
    FACING_BAM = 12 * ALE_BAM_PER_DEGREE,       /* two lines that may be one wall */
    PIECE_FACING_BAM = 40 * ALE_BAM_PER_DEGREE, /* with a piece among them */
    LEAST_VOTES_MM = 800,
    FACING_WORK = 3, /* of a pair that faces the same way, */
    PAIR_WORK = 2,   /* and of one that votes, in votes */
    CELL_BITS = 14,
    HALF_CELL_Q14 = 1 << (CELL_BITS - 1),
    SUMS = 16, /* of a row: one for every cell but the first and the last, and one of none */
    DISCOUNT_CELLS2 = 6 * MIDDLE * MIDDLE /* a sixth of the votes at the edge of the grid */
};

static int32_t length_mm(const ale_view_t *v)
{
    return (v->end_um - v->start_um) / 1000;
}

/* Indices of the longest views, in order of length: insertion into a bounded list. */
static uint32_t longest(ale_views_t views, uint16_t out[ALE_REGISTRATION_VIEWS])
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < views.count; i++) {
        const int32_t length = length_mm(&views.view[i]);
        uint32_t at = count;
        while (at > 0 && length_mm(&views.view[out[at - 1]]) < length) {
            at--;
        }
        if (at == ALE_REGISTRATION_VIEWS) {
            continue;
        }
        const uint32_t moved = (uint32_t)ale_min64(count, ALE_REGISTRATION_VIEWS - 1) - at;
        memmove(&out[at + 1], &out[at], moved * sizeof out[0]);
        out[at] = (uint16_t)i;
        count = (uint32_t)ale_min64(count + 1, ALE_REGISTRATION_VIEWS);
    }
    return count;
}

/* The two surfaces as a pair; false when they are never one: spots have no sides, and are laid on spots
 * alone.
 */
static bool make_pair(const ale_view_t *before, const ale_view_t *now, uint32_t turn_bam, int32_t cell_um,
                      ale_registration_pair_t *out)
{
    const bool lines = before->kind == ALE_VIEW_WALL && now->kind == ALE_VIEW_WALL;
    const int64_t apart_um = ((int64_t)length_mm(now) + length_mm(before)) * 500;
    out->turned_bam = now->normal_bam + turn_bam - before->normal_bam;
    out->limit_bam = lines ? FACING_BAM : PIECE_FACING_BAM;
    out->along_um = (int32_t)ale_max64(apart_um / 2, cell_um / 2);
    out->weight_mm = (int32_t)ale_min64(length_mm(now), length_mm(before));
    return (before->kind == ALE_VIEW_SPOT) == (now->kind == ALE_VIEW_SPOT);
}

/* The pairs that face the same way at any heading within most_bam of the guess, in the order in which they
 * vote: the longest first. */
static void list_pairs(ale_registration_t *r, ale_views_t before, ale_views_t now, uint32_t guess_bam,
                       int64_t most_bam)
{
    uint16_t count = 0;
    for (uint32_t i = 0; i < r->now_count; i++) {
        const ale_view_t *view = &now.view[r->now[i]];
        r->pair_first[i] = count;
        for (uint32_t k = 0; k < r->before_count; k++) {
            ale_registration_pair_t *pair = &r->pair[count];
            const bool able = make_pair(&before.view[r->before[k]], view, guess_bam, r->cell_um, pair);
            pair->before = (uint16_t)k;
            if (able && ale_abs64((int32_t)pair->turned_bam) < pair->limit_bam + most_bam) {
                count++;
            }
        }
    }
    r->pair_first[r->now_count] = count;
}

static void note_surfaces(ale_registration_t *r, ale_views_t before)
{
    for (uint32_t k = 0; k < r->before_count; k++) {
        const ale_view_t *view = &before.view[r->before[k]];
        const ale_direction_t d = ale_direction(view->normal_bam);
        r->centre[k] = view->centre;
        r->normal_q14[k] =
            (ale_point_t){(int32_t)ale_round_shift(d.cos_q30, 16), (int32_t)ale_round_shift(d.sin_q30, 16)};
    }
}

/* Displacements along a line, in cells from the grid's corner, Q14. */
typedef struct {
    int64_t x_q14;
    int64_t y_q14;
    int64_t step_x_q14;
    int64_t step_y_q14;
    int32_t count;
} cells_t;

static inline void step(cells_t *c)
{
    c->x_q14 += c->step_x_q14;
    c->y_q14 += c->step_y_q14;
    c->count--;
}

/* Whether the line is at a cell of the grid; halves are rounded away from zero. */
static inline bool is_inside(const cells_t *c)
{
    const uint64_t most_q14 = ((uint64_t)ALE_REGISTRATION_CELLS << CELL_BITS) - 1;
    return (uint64_t)(c->x_q14 + HALF_CELL_Q14 - 1) < most_q14 &&
           (uint64_t)(c->y_q14 + HALF_CELL_Q14 - 1) < most_q14;
}

/* A view votes once for a cell. A line enters the grid once and leaves it once. */
static void vote_cells(ale_registration_t *r, cells_t c, uint16_t voter, int32_t weight_mm)
{
    while (c.count > 0 && !is_inside(&c)) {
        step(&c);
    }
    for (; c.count > 0 && is_inside(&c); step(&c)) {
        const uint64_t column = (uint64_t)(c.x_q14 + HALF_CELL_Q14) >> CELL_BITS;
        const uint64_t row = (uint64_t)(c.y_q14 + HALF_CELL_Q14) >> CELL_BITS;
        if (r->voter[row][column] != voter) {
            r->voter[row][column] = voter;
            r->votes_mm[row][column] += weight_mm;
        }
    }
}

/* All displacements that lay the pair on each other: the points offset + t * tangent, offset being the way
 * from the new view's centre to the other's. As far as the work that is left reaches. */
static void vote_line(ale_registration_t *r, const ale_registration_pair_t *pair, ale_point_t offset,
                      uint16_t voter)
{
    const int64_t nx = r->normal_q14[pair->before].x_um;
    const int64_t ny = r->normal_q14[pair->before].y_um;
    const int64_t distance_um = ale_round_shift(offset.x_um * nx + offset.y_um * ny, 14);
    const int64_t half_um = (int64_t)r->cell_um * ALE_REGISTRATION_CELLS * 3 / 4; /* of the grid's diagonal */
    if (ale_abs64(distance_um) > half_um) {
        return;
    }
    r->work -= PAIR_WORK;
    const int64_t along_um = ale_round_shift(offset.x_um * ny - offset.y_um * nx, 14);
    const int64_t from = ale_round_div(ale_max64(along_um - pair->along_um, -half_um), r->cell_um);
    const int64_t to = ale_round_div(ale_min64(along_um + pair->along_um, half_um), r->cell_um);
    const int32_t count = (int32_t)ale_clamp64(to + 1 - from, 0, r->work);
    const int64_t distance_q14 = ale_round_div(distance_um * (1 << CELL_BITS), r->cell_um);
    const int64_t middle_q14 = (int64_t)MIDDLE << CELL_BITS;
    r->work -= count;
    vote_cells(r,
               (cells_t){middle_q14 + ale_round_shift(distance_q14 * nx, 14) + from * ny,
                         middle_q14 + ale_round_shift(distance_q14 * ny, 14) - from * nx, ny, -nx, count},
               voter, pair->weight_mm);
}

/* One new view, its centre placed at a heading that is turned from the guess by turn_bam. */
static void vote_view(ale_registration_t *r, uint16_t i, ale_point_t centre, uint32_t turn_bam)
{
    for (uint16_t k = r->pair_first[i]; k < r->pair_first[i + 1] && r->work > FACING_WORK + PAIR_WORK; k++) {
        const ale_registration_pair_t *pair = &r->pair[k];
        if (ale_abs64((int32_t)(pair->turned_bam + turn_bam)) < pair->limit_bam) {
            r->work -= FACING_WORK;
            vote_line(r, pair, ale_minus(r->centre[pair->before], centre), i);
        }
    }
}

static void vote(ale_registration_t *r, ale_views_t now, ale_pose_t pose, uint32_t turn_bam)
{
    const ale_stand_t stand = ale_stand(pose);
    memset(r->votes_mm, 0, sizeof r->votes_mm);
    memset(r->voter, 0xff, sizeof r->voter);
    r->work = ALE_REGISTRATION_WORK;
    for (uint32_t i = 0; i < r->now_count; i++) {
        vote_view(r, (uint16_t)i, ale_point_from(now.view[r->now[i]].centre, &stand), turn_bam);
    }
}

/* Of displacements that explain the same, as along a corridor, the one nearest to the guess. */
static int64_t discounted(int64_t votes, int64_t x, int64_t y)
{
    const int64_t far2 = (x - MIDDLE) * (x - MIDDLE) + (y - MIDDLE) * (y - MIDDLE);
    return votes - votes * far2 / DISCOUNT_CELLS2;
}

/* Votes of the neighbourhood of each cell of a row, its own twice, left[x] being that of cell x + 1; whether
 * one has more than `most`. Loops of constant length without branches: the compiler makes vectors of them. */
static bool row_sums(const ale_registration_t *r, int32_t y, int32_t most, int32_t sum_mm[SUMS])
{
    int32_t column_mm[ALE_REGISTRATION_COLUMNS]; /* of three rows */
    int32_t more = 0;
    for (int32_t x = 0; x < ALE_REGISTRATION_COLUMNS; x++) {
        column_mm[x] = r->votes_mm[y - 1][x] + r->votes_mm[y][x] + r->votes_mm[y + 1][x];
    }
    for (int32_t x = 0; x < SUMS; x++) {
        sum_mm[x] = r->votes_mm[y][x + 1] + column_mm[x] + column_mm[x + 1] + column_mm[x + 2];
        more |= sum_mm[x] > most;
    }
    return more != 0;
}

/* The cell whose neighbourhood has most votes, with them. */
static int64_t best_cell(const ale_registration_t *r, int32_t *column, int32_t *row)
{
    int64_t most = 0;
    for (int32_t y = 1; y < ALE_REGISTRATION_CELLS - 1; y++) {
        int32_t sum_mm[SUMS];
        if (!row_sums(r, y, (int32_t)most, sum_mm)) {
            continue;
        }
        for (int32_t x = 1; x < ALE_REGISTRATION_CELLS - 1; x++) {
            const int64_t sum = sum_mm[x - 1] > most ? discounted(sum_mm[x - 1], x, y) : 0;
            if (sum > most) {
                most = sum;
                *column = x;
                *row = y;
            }
        }
    }
    return most;
}

bool ale_register(ale_registration_t *memory, ale_views_t before, ale_views_t now, int32_t reach_um,
                  int32_t reach_urad, ale_pose_t *guess)
{
    const ale_pose_t first = *guess;
    const int64_t most_nrad = (int64_t)reach_urad * 1000;
    int64_t most = LEAST_VOTES_MM;
    bool found = false;
    memory->before_count = longest(before, memory->before);
    memory->now_count = longest(now, memory->now);
    memory->cell_um = reach_um / MIDDLE + 1;
    note_surfaces(memory, before);
    list_pairs(memory, before, now, first.theta_bam, ale_nrad_to_bam(most_nrad));
    for (int32_t h = -ALE_REGISTRATION_HEADINGS / 2; h <= ALE_REGISTRATION_HEADINGS / 2; h++) {
        const uint32_t turn_bam = (uint32_t)ale_nrad_to_bam(most_nrad * h / (ALE_REGISTRATION_HEADINGS / 2));
        const ale_pose_t pose = {first.x_um, first.y_um, first.theta_bam + turn_bam};
        int32_t column = MIDDLE;
        int32_t row = MIDDLE;
        vote(memory, now, pose, turn_bam);
        const int64_t votes = best_cell(memory, &column, &row);
        if (votes > most) {
            most = votes;
            found = true;
            *guess = pose;
            guess->x_um += (column - MIDDLE) * memory->cell_um;
            guess->y_um += (row - MIDDLE) * memory->cell_um;
        }
    }
    return found;
}
