#include "track/registration.h"

#include <string.h>

#include "base/fixed.h"
#include "base/trig.h"

enum {
    MIDDLE = ALE_REGISTRATION_CELLS / 2,
    FACING_BAM = 12 * ALE_BAM_PER_DEGREE,       /* two lines that may be one wall */
    PIECE_FACING_BAM = 40 * ALE_BAM_PER_DEGREE, /* with a piece among them */
    LEAST_VOTES_MM = 800,
    FACING_WORK = 3,                      /* of a pair that faces the same way, */
    PAIR_WORK = 2,                        /* and of one that votes, in votes */
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

/* One surface of the last scan as the new one may be laid on it. */
typedef struct {
    ale_point_t normal_q14; /* unit vector */
    ale_point_t offset;     /* from the new view's centre to this one's: what a displacement makes good */
    int32_t along_um;       /* how far the centres may lie apart along the wall */
    int32_t weight_mm;
} pair_t;

static void vote_cell(ale_registration_t *r, int64_t column, int64_t row, uint16_t voter, int32_t weight_mm)
{
    if (column < 0 || column >= ALE_REGISTRATION_CELLS || row < 0 || row >= ALE_REGISTRATION_CELLS ||
        r->voter[row][column] == voter) {
        return;
    }
    r->voter[row][column] = voter;
    r->votes_mm[row][column] += weight_mm;
}

/* All displacements that lay the pair on each other: the points offset + t * tangent. As far as the work that
 * is left reaches. */
static void vote_line(ale_registration_t *r, const pair_t *pair, uint16_t voter, int32_t cell_um)
{
    const int64_t nx = pair->normal_q14.x_um;
    const int64_t ny = pair->normal_q14.y_um;
    const int64_t distance_um = ale_round_shift(pair->offset.x_um * nx + pair->offset.y_um * ny, 14);
    const int64_t along_um = ale_round_shift(pair->offset.x_um * ny - pair->offset.y_um * nx, 14);
    const int64_t half_um = (int64_t)cell_um * ALE_REGISTRATION_CELLS * 3 / 4; /* of the grid's diagonal */
    if (ale_abs64(distance_um) > half_um) {
        return;
    }
    r->work -= PAIR_WORK;
    const int64_t from = ale_round_div(ale_max64(along_um - pair->along_um, -half_um), cell_um);
    const int64_t to =
        ale_min64(ale_round_div(ale_min64(along_um + pair->along_um, half_um), cell_um), from + r->work - 1);
    r->work -= (int32_t)ale_max64(to + 1 - from, 0);
    /* in cells, Q14, from the grid's corner */
    const int64_t distance_q14 = ale_round_div(distance_um * (1 << 14), cell_um);
    int64_t x_q14 = (int64_t)MIDDLE * (1 << 14) + ale_round_shift(distance_q14 * nx, 14) + from * ny;
    int64_t y_q14 = (int64_t)MIDDLE * (1 << 14) + ale_round_shift(distance_q14 * ny, 14) - from * nx;
    for (int64_t t = from; t <= to; t++) {
        vote_cell(r, ale_round_shift(x_q14, 14), ale_round_shift(y_q14, 14), voter, pair->weight_mm);
        x_q14 += ny;
        y_q14 -= nx;
    }
}

static void note_normals(ale_registration_t *r, ale_views_t before, uint32_t count)
{
    for (uint32_t k = 0; k < count; k++) {
        const ale_direction_t d = ale_direction(before.view[r->before[k]].normal_bam);
        r->normal_q14[k] =
            (ale_point_t){(int32_t)ale_round_shift(d.cos_q30, 16), (int32_t)ale_round_shift(d.sin_q30, 16)};
    }
}

static bool may_be_one(const ale_view_t *a, const ale_view_t *b)
{
    const bool lines = a->kind == ALE_VIEW_WALL && b->kind == ALE_VIEW_WALL;
    const int64_t limit = lines ? FACING_BAM : PIECE_FACING_BAM;
    return (a->kind == ALE_VIEW_SPOT) == (b->kind == ALE_VIEW_SPOT) &&
           ale_abs64(ale_bam_diff(a->normal_bam, b->normal_bam)) < limit;
}

static void vote_view(ale_registration_t *r, ale_views_t before, uint32_t count, const ale_view_t *moved,
                      uint16_t voter, int32_t cell_um)
{
    for (uint32_t k = 0; k < count && r->work > FACING_WORK + PAIR_WORK; k++) {
        const ale_view_t *other = &before.view[r->before[k]];
        if (!may_be_one(moved, other)) {
            continue;
        }
        r->work -= FACING_WORK;
        const int64_t apart_um = ((int64_t)length_mm(moved) + length_mm(other)) * 500;
        const pair_t pair = {r->normal_q14[k], ale_minus(other->centre, moved->centre),
                             (int32_t)ale_max64(apart_um / 2, cell_um / 2),
                             (int32_t)ale_min64(length_mm(moved), length_mm(other))};
        vote_line(r, &pair, voter, cell_um);
    }
}

/* Of displacements that explain the same, as along a corridor, the one nearest to the guess. */
static int64_t discounted(int64_t votes, int64_t x, int64_t y)
{
    const int64_t far2 = (x - MIDDLE) * (x - MIDDLE) + (y - MIDDLE) * (y - MIDDLE);
    return votes - votes * far2 / DISCOUNT_CELLS2;
}

/* The cell whose neighbourhood has most votes, with them. */
static int64_t best_cell(const ale_registration_t *r, int32_t *column, int32_t *row)
{
    int64_t most = 0;
    for (int32_t y = 1; y < ALE_REGISTRATION_CELLS - 1; y++) {
        int32_t column_mm[ALE_REGISTRATION_CELLS]; /* of three rows */
        for (int32_t x = 0; x < ALE_REGISTRATION_CELLS; x++) {
            column_mm[x] = r->votes_mm[y - 1][x] + r->votes_mm[y][x] + r->votes_mm[y + 1][x];
        }
        for (int32_t x = 1; x < ALE_REGISTRATION_CELLS - 1; x++) {
            int64_t sum = r->votes_mm[y][x] + column_mm[x - 1] + column_mm[x] + column_mm[x + 1];
            if (sum <= most) {
                continue;
            }
            sum = discounted(sum, x, y);
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
    const uint32_t before_count = longest(before, memory->before);
    const uint32_t now_count = longest(now, memory->now);
    const int32_t cell_um = reach_um / MIDDLE + 1;
    const ale_pose_t first = *guess;
    int64_t most = LEAST_VOTES_MM;
    bool found = false;
    note_normals(memory, before, before_count);
    for (int32_t h = -ALE_REGISTRATION_HEADINGS / 2; h <= ALE_REGISTRATION_HEADINGS / 2; h++) {
        const int64_t turn_nrad = (int64_t)reach_urad * 1000 * h / (ALE_REGISTRATION_HEADINGS / 2);
        ale_pose_t pose = first;
        pose.theta_bam += (uint32_t)ale_nrad_to_bam(turn_nrad);
        const ale_stand_t stand = ale_stand(pose);
        memset(memory->votes_mm, 0, sizeof memory->votes_mm);
        memset(memory->voter, 0xff, sizeof memory->voter);
        memory->work = ALE_REGISTRATION_WORK;
        for (uint32_t i = 0; i < now_count; i++) {
            const ale_view_t moved = ale_view_from(&now.view[memory->now[i]], &stand);
            vote_view(memory, before, before_count, &moved, (uint16_t)i, cell_um);
        }
        int32_t column = MIDDLE;
        int32_t row = MIDDLE;
        const int64_t votes = best_cell(memory, &column, &row);
        if (votes > most) {
            most = votes;
            found = true;
            *guess = pose;
            guess->x_um += (column - MIDDLE) * cell_um;
            guess->y_um += (row - MIDDLE) * cell_um;
        }
    }
    return found;
}
