#include "match/pose_vote.h"

#include <stddef.h>
#include <string.h>

#include "base/fixed.h"
#include "base/trig.h"

enum {
    COARSE_UM = ALE_GRID_POOL * ALE_GRID_CELL_UM,
    COARSE_STEP_BAM = (int32_t)(UINT32_MAX / ALE_VOTE_HEADINGS),
    FINE_SIDE = 8,           /* cells a side around a coarse place: two of its own */
    FINE_HEADINGS = 4,       /* steps to a coarse one */
    SAME_UM = 2 * COARSE_UM, /* places nearer than this are one */
    SAME_BAM = 3 * COARSE_STEP_BAM
};

/* A resolution: a grid, and the displacements that are compared on it, in cells a side. */
typedef struct {
    const uint8_t *cells;
    int32_t side;
    int32_t cell_um;
    int32_t region;
} level_t;

static inline level_t coarse_level(const ale_pose_vote_t *vote)
{
    return (level_t){&vote->grid.coarse[0][0], ALE_GRID_COARSE, COARSE_UM, ALE_VOTE_SIDE};
}

static inline level_t fine_level(const ale_pose_vote_t *vote)
{
    return (level_t){&vote->grid.fine[0][0], ALE_GRID_CELLS, ALE_GRID_CELL_UM, FINE_SIDE};
}

/* Points along the surfaces, evenly: a metre of any of them counts alike. */
static void sample(ale_pose_vote_t *vote, const ale_observation_t observation[], uint32_t count)
{
    const int64_t spacing_um = ale_max64(
        ale_observations_length_um(observation, count) / (ALE_VOTE_POINTS / 2), 2 * ALE_GRID_CELL_UM / 3);
    vote->points = 0;
    for (uint32_t i = 0; i < count; i++) {
        const ale_observation_t *o = &observation[i];
        for (int64_t t_um = o->start_um + spacing_um / 2; vote->points < ALE_VOTE_POINTS;
             t_um += spacing_um) {
            if (t_um >= o->end_um && t_um != o->start_um + spacing_um / 2) {
                break;
            }
            vote->point[vote->points++] =
                ale_plus(o->centre, ale_polar(ale_min64(t_um, o->end_um), ale_tangent_bam(o->normal_bam)));
        }
    }
}

/* The cells in which the points lie at a heading, displaced to the region's first corner; without the points
 * that leave the grid anywhere in the region. */
static inline void turn(ale_pose_vote_t *vote, const level_t *level, ale_pose_t from)
{
    const ale_viewpoint_t viewpoint = ale_viewpoint(from);
    vote->turned = 0;
    for (uint32_t k = 0; k < vote->points; k++) {
        const ale_point_t p = ale_minus(ale_point_from(vote->point[k], &viewpoint), vote->grid.corner);
        const int32_t x = p.x_um / level->cell_um - level->region / 2;
        const int32_t y = p.y_um / level->cell_um - level->region / 2;
        if (x >= 0 && y >= 0 && x <= level->side - level->region && y <= level->side - level->region) {
            vote->cell[vote->turned++] = y * level->side + x;
        }
    }
}

_Static_assert(ALE_VOTE_POINTS *ALE_GRID_SURFACE <= UINT8_MAX && ALE_VOTE_SIDE % 8 == 0 && FINE_SIDE % 8 == 0,
               "eight sums to a word, none of which overflows into the next");

/* Adds, for every displacement of the region in cells, what the cells of the displaced points hold: eight
 * columns and four rows at a time. */
static inline void add_up(ale_pose_vote_t *vote, const level_t *level)
{
    const ptrdiff_t side = level->side;
    for (int32_t v = 0; v < level->region; v += 4) {
        for (int32_t u = 0; u < level->region; u += 8) {
            const uint8_t *first = &level->cells[v * side + u];
            uint64_t sum[4] = {0};
            for (uint32_t k = 0; k < vote->turned; k++) {
                const uint8_t *at = &first[vote->cell[k]];
                sum[0] += ale_grid_load(at);
                sum[1] += ale_grid_load(at + side);
                sum[2] += ale_grid_load(at + 2 * side);
                sum[3] += ale_grid_load(at + 3 * side);
            }
            for (int32_t n = 0; n < 4; n++) {
                memcpy(&vote->sum[(v + n) * level->region + u], &sum[n], sizeof sum[n]);
            }
        }
    }
}

static inline void compare_displacements(ale_pose_vote_t *vote, const level_t *level, ale_pose_t from)
{
    turn(vote, level, from);
    add_up(vote, level);
}

static bool is_same(ale_pose_t a, ale_pose_t b)
{
    return ale_abs64((int64_t)a.x_um - b.x_um) < SAME_UM && ale_abs64((int64_t)a.y_um - b.y_um) < SAME_UM &&
           ale_abs64(ale_bam_diff(a.theta_bam, b.theta_bam)) < SAME_BAM;
}

/* Enters a place in the list, best first, where it is better than one that is the same or than the last. */
static void enter(ale_pose_vote_t *vote, const ale_voted_pose_t *place)
{
    uint32_t at = 0;
    while (at < vote->places && !is_same(vote->place[at].pose, place->pose)) {
        at++;
    }
    if (at == ALE_VOTE_PLACES) {
        at--;
    }
    if (at < vote->places && vote->place[at].score_q8 >= place->score_q8) {
        return;
    }
    vote->places += at == vote->places;
    for (; at > 0 && vote->place[at - 1].score_q8 < place->score_q8; at--) {
        vote->place[at] = vote->place[at - 1];
    }
    vote->place[at] = *place;
}

/* What a sum is the most of. */
static int32_t whole(const ale_pose_vote_t *vote)
{
    return ALE_GRID_SURFACE * (int32_t)vote->points;
}

/* The place that a sum is of. */
static inline ale_voted_pose_t place_at(const ale_pose_vote_t *vote, const level_t *level, ale_pose_t from,
                                        int32_t cell)
{
    const int32_t u = cell % level->region - level->region / 2;
    const int32_t v = cell / level->region - level->region / 2;
    return (ale_voted_pose_t){
        {from.x_um + u * level->cell_um, from.y_um + v * level->cell_um, from.theta_bam},
        vote->sum[cell] * 256 / whole(vote)};
}

static bool is_in_reach(ale_pose_t from, ale_pose_t pose, int32_t reach_um)
{
    return ale_abs64((int64_t)pose.x_um - from.x_um) <= reach_um + COARSE_UM / 2 &&
           ale_abs64((int64_t)pose.y_um - from.y_um) <= reach_um + COARSE_UM / 2;
}

/* Cells of a heading that are worth entering. */
static void enter_best(ale_pose_vote_t *vote, ale_pose_t from, int32_t reach_um)
{
    const level_t level = coarse_level(vote);
    const bool full = vote->places == ALE_VOTE_PLACES;
    const int32_t least_q8 = full ? vote->place[ALE_VOTE_PLACES - 1].score_q8 : 0;
    const int32_t least_sum = (least_q8 + 1) * whole(vote) / 256; /* less cannot exceed it */
    for (int32_t cell = 0; cell < ALE_VOTE_CELLS; cell++) {
        if (vote->sum[cell] >= least_sum) {
            const ale_voted_pose_t place = place_at(vote, &level, from, cell);
            if (place.score_q8 > least_q8 && is_in_reach(from, place.pose, reach_um)) {
                enter(vote, &place);
            }
        }
    }
}

static void search_coarsely(ale_pose_vote_t *vote, const ale_vote_region_t *region)
{
    const level_t level = coarse_level(vote);
    const int32_t most = (int32_t)ale_min64(
        ale_nrad_to_bam((int64_t)region->reach_urad * 1000) / COARSE_STEP_BAM + 1, ALE_VOTE_HEADINGS / 2);
    for (int32_t h = -most; h < most + (most < ALE_VOTE_HEADINGS / 2); h++) {
        const ale_pose_t from = {region->centre.x_um, region->centre.y_um,
                                 region->centre.theta_bam + (uint32_t)(h * COARSE_STEP_BAM)};
        compare_displacements(vote, &level, from);
        enter_best(vote, from, region->reach_um);
    }
}

/* The best of the fine cells and headings around a coarse place. */
static ale_voted_pose_t finely(ale_pose_vote_t *vote, ale_pose_t coarse)
{
    const level_t level = fine_level(vote);
    ale_voted_pose_t best = {coarse, 0};
    for (int32_t h = -FINE_HEADINGS; h <= FINE_HEADINGS; h++) {
        const ale_pose_t from = {coarse.x_um, coarse.y_um,
                                 coarse.theta_bam + (uint32_t)(h * (COARSE_STEP_BAM / FINE_HEADINGS))};
        compare_displacements(vote, &level, from);
        int32_t most = 0;
        for (int32_t cell = 1; cell < FINE_SIDE * FINE_SIDE; cell++) {
            most = vote->sum[cell] > vote->sum[most] ? cell : most;
        }
        const ale_voted_pose_t place = place_at(vote, &level, from, most);
        best = place.score_q8 > best.score_q8 ? place : best;
    }
    return best;
}

static void search_finely(ale_pose_vote_t *vote)
{
    ale_voted_pose_t coarse[ALE_VOTE_PLACES];
    const uint32_t count = vote->places;
    memcpy(coarse, vote->place, count * sizeof coarse[0]);
    vote->places = 0;
    for (uint32_t k = 0; k < count; k++) {
        const ale_voted_pose_t fine = finely(vote, coarse[k].pose);
        enter(vote, &fine);
    }
}

void ale_pose_vote(ale_pose_vote_t *vote, const ale_local_map_t *map, const ale_observation_t observation[],
                   uint32_t count, const ale_vote_region_t *region)
{
    vote->places = 0;
    sample(vote, observation, count);
    if (vote->points == 0) {
        return;
    }
    ale_likelihood_grid_draw(&vote->grid, map, (ale_point_t){region->centre.x_um, region->centre.y_um});
    search_coarsely(vote, region);
    search_finely(vote);
}
