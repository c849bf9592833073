#include "relocate/relocation.h"

#include <stddef.h>

#include "base/fixed.h"
#include "base/trig.h"
#include "map/visibility.h"

enum {
    SCORE_FALL_SCANS = 8,        /* fits over which a score is averaged where it falls, */
    SCORE_RISE_SCANS = 40,       /* and where it rises: a wrong place must not recover within one more room */
    VIOLATION_MOST_UM = 1000000, /* that one wall counts for */
    PROBATION = 4,               /* fits before a place may be dropped */
    SCORE_LEAST_Q8 = 140,        /* below it a place is dropped */
    ANSWER_SCANS = 8,            /* fits of the answer */
    ANSWER_Q8 = 205,             /* its score: 80 % */
    MARGIN_Q8 = 36,              /* by which it exceeds every other place: 14 % */
    COVERAGE_Q8 =
        2 * MARGIN_Q8, /* of the search: a place within the margin is found even if one in two is missed */
    COVERAGE_PATH_UM =
        5000000, /* path after which that coverage has expired: odometry drifts, places are lost */
    COVERAGE_MOST_Q8 = COVERAGE_Q8 * 6 / 5, /* at most one metre of path more than the answer needs */
    TRAIL_WORK = 4096,                      /* for all proposals of a scan */
    TRAIL_FITS = 4,                         /* fits that the scan history counts for */
    SAME_UM = 250000,                       /* places nearer than this are one */
    SAME_BAM = 150 * ALE_BAM_PER_MRAD,
    FIT_OFFSET_UM = 400000, /* gate of a fit */
    FIT_ANGLE_URAD = 200000,
    FIT_SIGMAS = 4,
    FIT_SIGMA_UM = 100000, /* prior of a fit */
    FIT_SIGMA_URAD = 50000,
    FIT_WORK = 104,    /* of the fits of one scan, in observations: one of the richest, four of a poor one */
    FIT_OVERHEAD = 12, /* of one fit, in observations */
    VISIBILITY_WALLS = 384,  /* asked in one fit, in turn */
    SCORE_OFFSET_UM = 60000, /* gate of a line that lies on a wall */
    SCORE_ANGLE_URAD = 90000,
    SHIFT_UM = 500000,            /* along the longest wall in view, where the answer must score less */
    OBSERVABLE_Q8 = 20,           /* by 8 %: between long walls all places along them are alike, */
    PAIR_LEAST_Q8 = OBSERVABLE_Q8 /* and a pair that is a smaller part of the scan does not tell them apart */
};

static const ale_gate_t score_gate = {SCORE_OFFSET_UM, SCORE_ANGLE_URAD, FIT_SIGMAS, 0};

void ale_relocation_clear(ale_relocation_t *relocation)
{
    relocation->search = (ale_search_t){0, 0, 0};
    ale_trail_clear(&relocation->trail);
    relocation->searching = false;
    relocation->crowded = false;
    relocation->pair_q8 = 0;
    relocation->path_um = 0;
    relocation->count = 0;
    relocation->next = 0;
    relocation->next_wall = 0;
    relocation->recognised = false;
}

void ale_relocation_recognise(ale_relocation_t *relocation, ale_pose_t at)
{
    relocation->recognised = true;
    relocation->at = at;
}

bool ale_relocation_recognised(ale_relocation_t *relocation, ale_pose_t *at)
{
    const bool recognised = relocation->recognised;
    relocation->recognised = false;
    *at = relocation->at;
    return recognised;
}

static bool is_same(ale_pose_t a, ale_pose_t b)
{
    return ale_abs64((int64_t)a.x_um - b.x_um) < SAME_UM && ale_abs64((int64_t)a.y_um - b.y_um) < SAME_UM &&
           ale_abs64(ale_bam_diff(a.theta_bam, b.theta_bam)) < SAME_BAM;
}

static void drop(ale_relocation_t *r, uint32_t index)
{
    r->count--;
    r->place[index] = r->place[r->count];
}

static int32_t best_score_q8(const ale_relocation_t *r)
{
    int32_t most_q8 = 0;
    for (uint32_t i = 0; i < r->count; i++) {
        most_q8 = r->place[i].score_q8 > most_q8 ? r->place[i].score_q8 : most_q8;
    }
    return most_q8;
}

/* A new place replaces the one with the lowest score if its own is higher. Where the one left out could be
 * within the margin of the best, this round does not count as coverage. */
static void enter(ale_relocation_t *r, const ale_place_t *place)
{
    uint32_t worst = 0;
    for (uint32_t i = 0; i < r->count; i++) {
        worst = r->place[i].score_q8 < r->place[worst].score_q8 ? i : worst;
    }
    if (r->count < ALE_PLACES) {
        r->place[r->count++] = *place;
        return;
    }
    const int32_t out_q8 = (int32_t)ale_min64(place->score_q8, r->place[worst].score_q8);
    r->crowded = r->crowded || out_q8 > best_score_q8(r) - MARGIN_Q8;
    if (r->place[worst].score_q8 < place->score_q8) {
        r->place[worst] = *place;
    }
}

static bool is_known(const ale_relocation_t *r, ale_pose_t pose)
{
    for (uint32_t i = 0; i < r->count; i++) {
        if (is_same(r->place[i].pose, pose)) {
            return true;
        }
    }
    return false;
}

/* The query scan was taken at an earlier pose: the proposal is moved to the present one. */
static void add_proposal(ale_relocation_t *r, const ale_scene_t *scene, const ale_hypothesis_t *h,
                         int32_t *work)
{
    const ale_pose_t to_now = ale_pose_between(ale_trail_newest(&r->trail)->from, (ale_pose_t){0, 0, 0});
    ale_place_t place = {.pose = ale_pose_compose(h->pose, to_now),
                         .score_q8 = (int32_t)(h->score_um * 256 / h->shown_um)};
    if (place.score_q8 < SCORE_LEAST_Q8 || is_known(r, place.pose)) {
        return;
    }
    if (r->trail.count > 1) {
        const int32_t before_q8 = ale_trail_explained_q8(&r->trail, scene->map, place.pose, work);
        place.score_q8 = before_q8 < place.score_q8 ? before_q8 : place.score_q8;
        place.scans = TRAIL_FITS;
    }
    if (place.score_q8 >= SCORE_LEAST_Q8) {
        enter(r, &place);
    }
}

static void start_round(ale_relocation_t *r, int32_t pair_q8)
{
    r->search.first = 0;
    r->search.second = 0;
    r->pair_q8 = pair_q8;
    r->crowded = false;
    r->searching = pair_q8 > 0;
}

/* This scan becomes the query when no round is under way, or only one whose pair is too short to count.
 * Without odometry the scan history is empty, and the round goes on with the present scan as its query. */
static void choose_query(ale_relocation_t *r, const ale_scene_t *scene)
{
    const int32_t pair_q8 = ale_search_pair_q8(&r->search, scene->observation, scene->observation_count);
    const bool is_better = r->pair_q8 < PAIR_LEAST_Q8 && pair_q8 >= PAIR_LEAST_Q8;
    const bool no_history = r->trail.count == 0;
    if (!r->searching || (is_better && !no_history)) {
        start_round(r, pair_q8);
    } else if (no_history) {
        r->pair_q8 = pair_q8 < r->pair_q8 ? pair_q8 : r->pair_q8;
    } else {
        return;
    }
    ale_trail_keep(&r->trail, scene->observation, scene->observation_count);
}

static void end_round(ale_relocation_t *r)
{
    for (uint32_t i = 0; r->pair_q8 >= PAIR_LEAST_Q8 && !r->crowded && i < r->count; i++) {
        r->place[i].coverage_q8 = (int32_t)ale_min64(r->place[i].coverage_q8 + r->pair_q8, COVERAGE_MOST_Q8);
    }
    r->searching = false;
}

static void propose(ale_relocation_t *r, const ale_scene_t *scene)
{
    ale_hypothesis_t found[ALE_MAX_HYPOTHESES];
    choose_query(r, scene);
    const ale_trail_scan_t *query = ale_trail_newest(&r->trail);
    const uint32_t rounds = r->search.rounds;
    const uint32_t count = ale_search(&r->search, scene->map, query->observation, query->count, found);
    int32_t work = TRAIL_WORK;
    for (uint32_t i = 0; i < count; i++) {
        add_proposal(r, scene, &found[i], &work);
    }
    if (r->search.rounds != rounds) {
        end_round(r);
    }
}

/* Out of the scanner's reach from there. */
static bool is_far(const ale_wall_t *wall, ale_pose_t sensor, int64_t reach_um)
{
    const int64_t far_um = reach_um + wall->end_um - wall->start_um;
    return ale_abs64((int64_t)wall->anchor.x_um - sensor.x_um) > far_um ||
           ale_abs64((int64_t)wall->anchor.y_um - sensor.y_um) > far_um;
}

/* Length of the walls in view of the place that the scan sees through. On a map of more than VISIBILITY_WALLS
 * walls each call asks the next ones, and their share is scaled to all. */
static int64_t violated_um(const ale_local_map_t *map, const ale_posed_scan_t *mounted, ale_pose_t place,
                           uint16_t *next)
{
    const ale_posed_scan_t from = {mounted->scan, mounted->bearing_bam,
                                   ale_pose_compose(place, mounted->sensor)};
    const uint16_t asked = (uint16_t)ale_min64(map->count, VISIBILITY_WALLS);
    int64_t length_um = 0;
    for (uint32_t i = 0; i < asked; i++) {
        *next = (uint16_t)(*next + 1 < map->count ? *next + 1 : 0);
        const ale_wall_t *wall = &map->wall[*next];
        if (wall->map != map->selected || is_far(wall, from.sensor, mounted->scan->range_max_um)) {
            continue;
        }
        if (ale_wall_visibility(wall, &from) == ALE_VISIBILITY_VIOLATED) {
            length_um += ale_min64((int64_t)wall->end_um - wall->start_um, VIOLATION_MOST_UM);
        }
    }
    return asked > 0 ? length_um * map->count / asked : 0;
}

/* Running mean with asymmetric smoothing: a score falls five times faster than it rises. */
static void update_score(ale_place_t *place, int32_t score_q8)
{
    const int32_t memory = score_q8 < place->score_q8 ? SCORE_FALL_SCANS : SCORE_RISE_SCANS;
    const int32_t n = (int32_t)ale_min64(place->scans + 1, memory);
    place->score_q8 += (int32_t)ale_round_div(score_q8 - place->score_q8, n);
    place->scans = (uint16_t)ale_min64(place->scans + 1, UINT16_MAX);
}

/* Fits the place to the scan and updates its score: the part explained of the scan and of the walls in view.
 */
static void fit_place(ale_place_t *place, const ale_scene_t *scene, const ale_posed_scan_t *mounted,
                      const ale_motion_t *predicted, uint16_t *next_wall, ale_fit_t *fit)
{
    int32_t work = ALE_ASSOCIATION_WORK;
    const ale_gate_t gate = {FIT_OFFSET_UM, FIT_ANGLE_URAD, FIT_SIGMAS, 0};
    ale_motion_t there = *predicted;
    there.pose = place->pose;
    ale_motion_widen(&there, FIT_SIGMA_UM, FIT_SIGMA_URAD);
    ale_register_pose(&there, scene, &gate, fit);
    place->pose = fit->motion.pose;
    const ale_hypothesis_t h = ale_hypothesis_at(scene->map, scene->observation, scene->observation_count,
                                                 place->pose, &score_gate, &work);
    if (h.shown_um > 0) {
        const int64_t all_um = h.shown_um + violated_um(scene->map, mounted, place->pose, next_wall);
        update_score(place, (int32_t)(h.score_um * 256 / all_um));
    }
}

static bool is_duplicate(const ale_relocation_t *r, uint32_t index)
{
    for (uint32_t i = 0; i < r->count; i++) {
        if (i != index && r->place[i].scans >= r->place[index].scans &&
            is_same(r->place[i].pose, r->place[index].pose)) {
            return true;
        }
    }
    return false;
}

static void fit_some(ale_relocation_t *r, const ale_scene_t *scene, const ale_posed_scan_t *mounted,
                     const ale_motion_t *predicted, ale_fit_t *fit)
{
    const int64_t fits =
        ale_clamp64(FIT_WORK / (scene->observation_count + FIT_OVERHEAD), 1, ALE_PLACES_FITTED);
    for (uint32_t n = 0; n < fits && n < r->count; n++) {
        r->next = r->next < r->count ? r->next : 0;
        ale_place_t *place = &r->place[r->next];
        fit_place(place, scene, mounted, predicted, &r->next_wall, fit);
        const bool is_rejected = place->scans >= PROBATION && place->score_q8 < SCORE_LEAST_Q8;
        if (is_rejected || is_duplicate(r, r->next)) {
            drop(r, r->next);
        } else {
            r->next++;
        }
    }
}

/* The place whose score alone is high enough, with the search covering all others; or NULL. */
static ale_place_t *answer(ale_relocation_t *r)
{
    ale_place_t *best = NULL;
    for (uint32_t i = 0; i < r->count; i++) {
        if (r->place[i].scans >= ANSWER_SCANS && (!best || r->place[i].score_q8 > best->score_q8)) {
            best = &r->place[i];
        }
    }
    if (!best || best->score_q8 < ANSWER_Q8 || best->coverage_q8 < COVERAGE_Q8) {
        return NULL;
    }
    for (uint32_t i = 0; i < r->count; i++) {
        if (&r->place[i] != best && r->place[i].score_q8 > best->score_q8 - MARGIN_Q8) {
            return NULL;
        }
    }
    return best;
}

static const ale_observation_t *longest_line(const ale_scene_t *scene)
{
    const ale_observation_t *longest = &scene->observation[0];
    for (uint32_t i = 1; i < scene->observation_count; i++) {
        const ale_observation_t *observation = &scene->observation[i];
        if (observation->kind == ALE_OBSERVATION_LINE &&
            ale_observation_length_um(observation) > ale_observation_length_um(longest)) {
            longest = observation;
        }
    }
    return longest;
}

/* Whether the scan determines the place along its longest wall too: half a metre to either side, where no
 * place may have been proposed, the score is lower. */
static bool is_observable(const ale_scene_t *scene, ale_pose_t place)
{
    int32_t work = ALE_ASSOCIATION_WORK;
    const uint32_t along_bam = longest_line(scene)->normal_bam + ALE_BAM_QUARTER_TURN;
    const ale_hypothesis_t here = ale_hypothesis_at(scene->map, scene->observation, scene->observation_count,
                                                    place, &score_gate, &work);
    for (int32_t side = -1; side <= 1; side += 2) {
        const ale_point_t shift = ale_rotate((ale_point_t){side * SHIFT_UM, 0}, along_bam);
        const ale_pose_t shifted = ale_pose_compose(place, (ale_pose_t){shift.x_um, shift.y_um, 0});
        const ale_hypothesis_t there = ale_hypothesis_at(
            scene->map, scene->observation, scene->observation_count, shifted, &score_gate, &work);
        if (work <= 0 || (here.score_um - there.score_um) * 256 <= here.shown_um * OBSERVABLE_Q8) {
            return false;
        }
    }
    return true;
}

/* Coverage expires with the path. */
static void expire_coverage(ale_relocation_t *r, ale_pose_t displacement)
{
    r->path_um += ale_isqrt((uint64_t)((int64_t)displacement.x_um * displacement.x_um +
                                       (int64_t)displacement.y_um * displacement.y_um));
    const int64_t expired_q8 = r->path_um * COVERAGE_Q8 / COVERAGE_PATH_UM;
    r->path_um -= expired_q8 * COVERAGE_PATH_UM / COVERAGE_Q8;
    for (uint32_t i = 0; i < r->count; i++) {
        r->place[i].coverage_q8 = (int32_t)ale_max64(r->place[i].coverage_q8 - expired_q8, 0);
    }
}

void ale_relocation_follow(ale_relocation_t *relocation, ale_pose_t displacement, bool counted)
{
    if (counted) {
        ale_trail_follow(&relocation->trail, displacement);
    } else {
        ale_trail_clear(&relocation->trail);
    }
    expire_coverage(relocation, displacement);
    relocation->at = ale_pose_compose(relocation->at, displacement);
    for (uint32_t i = 0; i < relocation->count; i++) {
        relocation->place[i].pose = ale_pose_compose(relocation->place[i].pose, displacement);
    }
}

bool ale_relocate(ale_relocation_t *relocation, const ale_scene_t *scene, const ale_posed_scan_t *mounted,
                  const ale_motion_t *predicted, ale_fit_t *fit)
{
    ale_place_t *place = answer(relocation);
    if (!place) {
        propose(relocation, scene);
        fit_some(relocation, scene, mounted, predicted, fit);
        return false;
    }
    fit_place(place, scene, mounted, predicted, &relocation->next_wall, fit);
    if (place->score_q8 < ANSWER_Q8) {
        return false;
    }
    if (!is_observable(scene, place->pose)) {
        place->scans = 0;
        return false;
    }
    ale_register_associate(scene, fit);
    ale_register_weigh(scene, fit);
    return true;
}
