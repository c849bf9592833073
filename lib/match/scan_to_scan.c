#include "match/scan_to_scan.h"

#include <string.h>

#include "base/fixed.h"
#include "base/trig.h"

enum {
    MIDDLE = ALE_SCAN_MATCH_CELLS / 2,
    MIDDLE_HEADING = ALE_SCAN_MATCH_HEADINGS / 2,
    FACING_BAM = 12 * ALE_BAM_PER_DEGREE,         /* two lines that may be one wall */
    SEGMENT_FACING_BAM = 40 * ALE_BAM_PER_DEGREE, /* with a short segment among them */
    LEAST_VOTES_MM = 800,
    FACING_WORK = 3, /* of a pair that faces the same way, */
    PAIR_WORK = 2,   /* and of one that votes, in votes */
    CELL_BITS = 14,
    MIDDLE_Q14 = (MIDDLE << CELL_BITS) + (1 << (CELL_BITS - 1)),
    SUMS = 16, /* of a row: one for every cell but the first and the last, and one of none */
    DISCOUNT_CELLS2 = 6 * MIDDLE * MIDDLE /* a sixth of the votes at the edge of the grid */
};

static int32_t length_mm(const ale_observation_t *v)
{
    return (int32_t)(ale_observation_length_um(v) / 1000);
}

/* Indices of the longest observations, in order of length: insertion into a bounded list. */
static uint32_t longest(ale_observations_t observations, uint16_t out[ALE_SCAN_MATCH_OBSERVATIONS])
{
    int32_t length[ALE_SCAN_MATCH_OBSERVATIONS];
    uint32_t count = 0;
    for (uint32_t i = 0; i < observations.count; i++) {
        const int32_t own = length_mm(&observations.observation[i]);
        if (count == ALE_SCAN_MATCH_OBSERVATIONS && length[count - 1] >= own) {
            continue;
        }
        count += count < ALE_SCAN_MATCH_OBSERVATIONS;
        uint32_t at = count - 1;
        for (; at > 0 && length[at - 1] < own; at--) {
            length[at] = length[at - 1];
            out[at] = out[at - 1];
        }
        length[at] = own;
        out[at] = (uint16_t)i;
    }
    return count;
}

static void note_surfaces(ale_scan_match_t *r, ale_observations_t before)
{
    for (uint32_t k = 0; k < r->before_count; k++) {
        const ale_observation_t *observation = &before.observation[r->before[k]];
        const ale_direction_t d = ale_direction(observation->normal_bam);
        const int32_t nx = (int32_t)ale_round_shift(d.cos_q30, 16);
        const int32_t ny = (int32_t)ale_round_shift(d.sin_q30, 16);
        r->surface[k] = (ale_scan_match_surface_t){
            .normal_x_q14 = nx,
            .normal_y_q14 = ny,
            .offset_q14 = (int64_t)observation->centre.x_um * nx + (int64_t)observation->centre.y_um * ny,
            .along_q14 = (int64_t)observation->centre.x_um * ny - (int64_t)observation->centre.y_um * nx,
            .normal_bam = observation->normal_bam,
            .length_mm = length_mm(observation),
            .kind = observation->kind,
        };
    }
}

/* The pairs of a new observation that face the same way at any heading within most_bam of the guess, from
 * pair number `count` on; returns the number after them. Point features have no side, and pair with point
 * features alone. */
static uint16_t list_pairs_of(ale_scan_match_t *r, const ale_observation_t *now, uint32_t guess_bam,
                              int64_t most_bam, uint16_t count)
{
    const int32_t now_mm = length_mm(now);
    for (uint32_t k = 0; k < r->before_count; k++) {
        const ale_scan_match_surface_t *before = &r->surface[k];
        const bool lines = before->kind == ALE_OBSERVATION_LINE && now->kind == ALE_OBSERVATION_LINE;
        const uint32_t turned_bam = now->normal_bam + guess_bam - before->normal_bam;
        const int32_t limit_bam = lines ? FACING_BAM : SEGMENT_FACING_BAM;
        if ((before->kind == ALE_OBSERVATION_POINT) != (now->kind == ALE_OBSERVATION_POINT) ||
            ale_abs64((int32_t)turned_bam) >= limit_bam + most_bam) {
            continue;
        }
        const int64_t apart_um = ((int64_t)now_mm + before->length_mm) * 500;
        r->pair[count++] = (ale_scan_match_pair_t){
            .turned_bam = turned_bam + (uint32_t)limit_bam - 1,
            .width_bam = 2 * (uint32_t)limit_bam - 1,
            .along_um = (int32_t)ale_max64(apart_um / 2, r->cell_um / 2),
            .weight_mm = now_mm < before->length_mm ? now_mm : before->length_mm,
            .before = (uint16_t)k,
        };
    }
    return count;
}

/* All of them, in the order in which they vote: the longest first. */
static void list_pairs(ale_scan_match_t *r, ale_observations_t now, uint32_t guess_bam, int64_t most_bam)
{
    uint16_t count = 0;
    for (uint32_t i = 0; i < r->now_count; i++) {
        r->pair_first[i] = count;
        count = list_pairs_of(r, &now.observation[r->now[i]], guess_bam, most_bam, count);
    }
    r->pair_first[r->now_count] = count;
}

/* Displacements along a line, in cells from the grid's corner, Q14, half a cell added. */
typedef struct {
    int64_t x_q14;
    int64_t y_q14;
    int64_t step_x_q14;
    int64_t step_y_q14;
    int32_t count;
} cells_t;

/* Whether a place is in a cell of the grid; halves were rounded away from zero. */
static inline bool is_inside(int64_t x_q14, int64_t y_q14)
{
    const uint64_t most_q14 = ((uint64_t)ALE_SCAN_MATCH_CELLS << CELL_BITS) - 1;
    return (uint64_t)(x_q14 - 1) < most_q14 && (uint64_t)(y_q14 - 1) < most_q14;
}

/* Cuts off what of the line is outside the grid, at its beginning and at its end. */
static inline void clip(cells_t *c)
{
    while (c->count > 0 && !is_inside(c->x_q14, c->y_q14)) {
        c->x_q14 += c->step_x_q14;
        c->y_q14 += c->step_y_q14;
        c->count--;
    }
    int64_t x_q14 = c->x_q14 + (c->count - 1) * c->step_x_q14;
    int64_t y_q14 = c->y_q14 + (c->count - 1) * c->step_y_q14;
    while (c->count > 0 && !is_inside(x_q14, y_q14)) {
        x_q14 -= c->step_x_q14;
        y_q14 -= c->step_y_q14;
        c->count--;
    }
}

/* An observation votes once for a cell. */
static inline void vote_cells(ale_scan_match_t *r, cells_t c, uint16_t voter, int32_t weight_mm)
{
    clip(&c);
    for (; c.count > 0; c.count--) {
        const uint64_t column = (uint64_t)c.x_q14 >> CELL_BITS;
        const uint64_t row = (uint64_t)c.y_q14 >> CELL_BITS;
        if (r->voter[row][column] != voter) {
            r->voter[row][column] = voter;
            r->votes_mm[row][column] += weight_mm;
            r->row_mm[row] += weight_mm;
        }
        c.x_q14 += c.step_x_q14;
        c.y_q14 += c.step_y_q14;
    }
}

/* All displacements that lay the pair on each other: the points offset + t * tangent, offset being the way
 * from the new observation's centre to the other's. As far as the work that is left reaches. */
static inline void vote_line(ale_scan_match_t *r, const ale_scan_match_pair_t *pair, ale_point_t centre,
                             uint16_t voter)
{
    const ale_scan_match_surface_t *before = &r->surface[pair->before];
    const int64_t nx = before->normal_x_q14;
    const int64_t ny = before->normal_y_q14;
    const int64_t half_um = r->half_um;
    const int64_t distance_um = ale_round_shift(before->offset_q14 - centre.x_um * nx - centre.y_um * ny, 14);
    if (ale_abs64(distance_um) > half_um) {
        return;
    }
    const int64_t along_um = ale_round_shift(before->along_q14 - centre.x_um * ny + centre.y_um * nx, 14);
    const int64_t from = ale_round_div(ale_max64(along_um - pair->along_um, -half_um), r->cell_um);
    const int64_t to = ale_round_div(ale_min64(along_um + pair->along_um, half_um), r->cell_um);
    r->work -= PAIR_WORK;
    if (to < from) {
        return;
    }
    const int32_t count = (int32_t)ale_min64(to + 1 - from, r->work);
    const int64_t distance_q14 = ale_round_div(distance_um * (1 << CELL_BITS), r->cell_um);
    r->work -= count;
    vote_cells(r,
               (cells_t){MIDDLE_Q14 + ale_round_shift(distance_q14 * nx, 14) + from * ny,
                         MIDDLE_Q14 + ale_round_shift(distance_q14 * ny, 14) - from * nx, ny, -nx, count},
               voter, pair->weight_mm);
}

/* One new observation, its centre placed at a heading that is turned from the guess by turn_bam. */
static void vote_observation(ale_scan_match_t *r, uint32_t i, ale_point_t centre, uint32_t turn_bam,
                             uint16_t voter)
{
    const ale_scan_match_pair_t *const end = &r->pair[r->pair_first[i + 1]];
    for (const ale_scan_match_pair_t *pair = &r->pair[r->pair_first[i]];
         pair < end && r->work > FACING_WORK + PAIR_WORK; pair++) {
        if (pair->turned_bam + turn_bam < pair->width_bam) {
            r->work -= FACING_WORK;
            vote_line(r, pair, centre, voter);
        }
    }
}

/* The votes for one heading; the first of its voters has the number given. */
static void vote(ale_scan_match_t *r, ale_observations_t now, ale_pose_t pose, uint32_t turn_bam,
                 uint32_t first_voter)
{
    const ale_viewpoint_t viewpoint = ale_viewpoint(pose);
    memset(r->votes_mm, 0, sizeof r->votes_mm);
    memset(r->row_mm, 0, sizeof r->row_mm);
    r->work = ALE_SCAN_MATCH_WORK;
    for (uint32_t i = 0; i < r->now_count; i++) {
        vote_observation(r, i, ale_point_from(now.observation[r->now[i]].centre, &viewpoint), turn_bam,
                         (uint16_t)(first_voter + i));
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
static bool row_sums(const ale_scan_match_t *r, int32_t y, int32_t most, int32_t sum_mm[SUMS])
{
    int32_t column_mm[ALE_SCAN_MATCH_COLUMNS]; /* of three rows */
    int32_t more = 0;
    for (int32_t x = 0; x < ALE_SCAN_MATCH_COLUMNS; x++) {
        column_mm[x] = r->votes_mm[y - 1][x] + r->votes_mm[y][x] + r->votes_mm[y + 1][x];
    }
    for (int32_t x = 0; x < SUMS; x++) {
        sum_mm[x] = r->votes_mm[y][x + 1] + column_mm[x] + column_mm[x + 1] + column_mm[x + 2];
        more |= sum_mm[x] > most;
    }
    return more != 0;
}

/* The cell whose neighbourhood has most votes, and more than `most`, with them; `most` if there is none. */
static int64_t best_cell(const ale_scan_match_t *r, int64_t most, int32_t *column, int32_t *row)
{
    for (int32_t y = 1; y < ALE_SCAN_MATCH_CELLS - 1; y++) {
        int32_t sum_mm[SUMS];
        const int64_t at_most_mm = (int64_t)r->row_mm[y - 1] + 2 * (int64_t)r->row_mm[y] + r->row_mm[y + 1];
        if (at_most_mm <= most || !row_sums(r, y, (int32_t)most, sum_mm)) {
            continue;
        }
        for (int32_t x = 1; x < ALE_SCAN_MATCH_CELLS - 1; x++) {
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

int32_t ale_scan_match_cell_um(int64_t reach_um)
{
    return (int32_t)(reach_um / MIDDLE + 1);
}

int32_t ale_scan_match_step_urad(int64_t reach_urad)
{
    return (int32_t)(reach_urad / MIDDLE_HEADING);
}

bool ale_match_scans(ale_scan_match_t *memory, ale_observations_t before, ale_observations_t now,
                     int32_t reach_um, int32_t reach_urad, ale_pose_t *guess)
{
    const ale_pose_t first = *guess;
    const int64_t most_nrad = (int64_t)reach_urad * 1000;
    int64_t most = LEAST_VOTES_MM;
    bool found = false;
    memory->before_count = longest(before, memory->before);
    memory->now_count = longest(now, memory->now);
    memory->cell_um = ale_scan_match_cell_um(reach_um);
    memory->half_um = (int32_t)((int64_t)memory->cell_um * ALE_SCAN_MATCH_CELLS * 3 / 4);
    memset(memory->voter, 0xff, sizeof memory->voter);
    note_surfaces(memory, before);
    list_pairs(memory, now, first.theta_bam, ale_nrad_to_bam(most_nrad));
    for (int32_t h = 0; h < ALE_SCAN_MATCH_HEADINGS; h++) {
        const uint32_t turn_bam =
            (uint32_t)ale_nrad_to_bam(most_nrad * (h - MIDDLE_HEADING) / MIDDLE_HEADING);
        const ale_pose_t pose = {first.x_um, first.y_um, first.theta_bam + turn_bam};
        int32_t column = MIDDLE;
        int32_t row = MIDDLE;
        vote(memory, now, pose, turn_bam, (uint32_t)h * ALE_SCAN_MATCH_OBSERVATIONS);
        const int64_t votes = best_cell(memory, most, &column, &row);
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
