#include "relocate/relocation.h"

#include <stddef.h>

#include "base/fixed.h"
#include "base/trig.h"

enum {
    BLAME_MEMORY = 8,   /* fits that the mean remembers where a place explains less than before, */
    PRAISE_MEMORY = 40, /* and where it explains more: a wrong place must not recover in the next cell */
    THROUGH_MOST_UM = 1000000,      /* of a wall that is seen through */
    PROBATION = 4,                  /* fits before a place may be dropped */
    HELD_LEAST_Q8 = 140,            /* places that explain less are dropped */
    ANSWER_SCANS = 8,               /* fits of the answer */
    ANSWER_Q8 = 205,                /* it explains 80 % */
    MARGIN_Q8 = 36,                 /* and 14 % more than any other place, */
    TOLD_Q8 = 2 * MARGIN_Q8,        /* when rounds would have found those even if one in two missed them */
    TOLD_WAY_UM = 5000000,          /* and for so far: wheels stray, and a place may be lost on the way; */
    TOLD_MOST_Q8 = TOLD_Q8 * 6 / 5, /* at most a metre of that ahead, until the next round has told */
    TRAIL_LOOKS = 4096,             /* at walls, for all that is proposed in a scan */
    TRAIL_SCANS = 4,                /* fits that what was seen before counts for */
    SAME_UM = 250000,               /* places nearer than this are one */
    SAME_BAM = 150 * ALE_BAM_PER_MRAD,
    FIT_OFFSET_UM = 400000, /* how far a place may be off when it is fitted */
    FIT_ANGLE_URAD = 200000,
    FIT_SIGMAS = 4,
    FIT_WORK = 104,    /* of the fits of a scan, in views: one of the richest, up to four of a plain one; */
    FIT_BESIDE = 12,   /* a fit asks for as much beside its observations */
    SIGHT_WALLS = 384, /* of the map that are asked in one fit, in turn */
    FIT_SIGMA_UM = 100000,
    FIT_SIGMA_URAD = 50000,
    HOLD_OFFSET_UM = 60000, /* a line lies on a wall when it is no farther from it */
    HOLD_ANGLE_URAD = 90000,
    SLIDE_UM = 500000,     /* along the longest wall in view, where the answer must explain less */
    PINNED_Q8 = 20,        /* by 8 %: in a corridor of long walls only all places along it are alike, */
    TELLING_Q8 = PINNED_Q8 /* and a pair that is a smaller part of the scan does not tell them apart */
};

static const ale_gate_t observability = {HOLD_OFFSET_UM, HOLD_ANGLE_URAD, FIT_SIGMAS, 0};

void ale_relocation_clear(ale_relocation_t *relocation)
{
    relocation->search = (ale_search_t){0, 0, 0};
    ale_trail_clear(&relocation->trail);
    relocation->searching = false;
    relocation->crowded = false;
    relocation->pair_q8 = 0;
    relocation->way_um = 0;
    relocation->count = 0;
    relocation->next = 0;
    relocation->next_wall = 0;
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

static int32_t most_held_q8(const ale_relocation_t *r)
{
    int32_t most_q8 = 0;
    for (uint32_t i = 0; i < r->count; i++) {
        most_q8 = r->place[i].score_q8 > most_q8 ? r->place[i].score_q8 : most_q8;
    }
    return most_q8;
}

/* A new place takes the room of the one that explains least, if it explains more. Where the one without room
 * could be a rival, the round tells nothing. */
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
    r->crowded = r->crowded || out_q8 > most_held_q8(r) - MARGIN_Q8;
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

/* What is looked for is seen from where the robot was then. */
static void take_proposal(ale_relocation_t *r, const ale_scene_t *scene, const ale_hypothesis_t *h,
                          int32_t *work)
{
    const ale_pose_t to_now = ale_pose_between(ale_trail_newest(&r->trail)->from, (ale_pose_t){0, 0, 0});
    ale_place_t place = {.pose = ale_pose_compose(h->pose, to_now),
                         .score_q8 = (int32_t)(h->score_um * 256 / h->shown_um)};
    if (place.score_q8 < HELD_LEAST_Q8 || is_known(r, place.pose)) {
        return;
    }
    if (r->trail.count > 1) {
        const int32_t before_q8 = ale_trail_explained_q8(&r->trail, scene->map, place.pose, work);
        place.score_q8 = before_q8 < place.score_q8 ? before_q8 : place.score_q8;
        place.scans = TRAIL_SCANS;
    }
    if (place.score_q8 >= HELD_LEAST_Q8) {
        enter(r, &place);
    }
}

static void begin_round(ale_relocation_t *r, int32_t pair_q8)
{
    r->search.first = 0;
    r->search.second = 0;
    r->pair_q8 = pair_q8;
    r->crowded = false;
    r->searching = pair_q8 > 0;
}

/* A round is begun with this scan when none is under way, or only one that will tell nothing. Where nobody
 * knows how the robot went, the round goes on with this scan. */
static void choose_query(ale_relocation_t *r, const ale_scene_t *scene)
{
    const int32_t pair_q8 = ale_search_pair_q8(&r->search, scene->observation, scene->observation_count);
    const bool lame = r->pair_q8 < TELLING_Q8 && pair_q8 >= TELLING_Q8;
    const bool astray = r->trail.count == 0;
    if (!r->searching || (lame && !astray)) {
        begin_round(r, pair_q8);
    } else if (astray) {
        r->pair_q8 = pair_q8 < r->pair_q8 ? pair_q8 : r->pair_q8;
    } else {
        return;
    }
    ale_trail_keep(&r->trail, scene->observation, scene->observation_count);
}

static void end_round(ale_relocation_t *r)
{
    for (uint32_t i = 0; r->pair_q8 >= TELLING_Q8 && !r->crowded && i < r->count; i++) {
        r->place[i].coverage_q8 = (int32_t)ale_min64(r->place[i].coverage_q8 + r->pair_q8, TOLD_MOST_Q8);
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
    int32_t work = TRAIL_LOOKS;
    for (uint32_t i = 0; i < count; i++) {
        take_proposal(r, scene, &found[i], &work);
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

/* Length of the walls that should be seen from the place and are seen through. On a map of more than
 * SIGHT_WALLS a part of them is asked, another one each time, and counts for all. */
static int64_t seen_through(const ale_local_map_t *map, const ale_mounted_scan_t *mounted, ale_pose_t place,
                            uint16_t *next)
{
    const ale_pose_t sensor = ale_pose_compose(place, mounted->sensor);
    const uint16_t asked = (uint16_t)ale_min64(map->count, SIGHT_WALLS);
    int64_t through_um = 0;
    for (uint32_t i = 0; i < asked; i++) {
        *next = (uint16_t)(*next + 1 < map->count ? *next + 1 : 0);
        const ale_wall_t *wall = &map->wall[*next];
        if (is_far(wall, sensor, mounted->scan->range_max_um)) {
            continue;
        }
        if (ale_wall_visibility(wall, mounted->scan, mounted->bearing_bam, sensor) ==
            ALE_VISIBILITY_VIOLATED) {
            through_um += ale_min64((int64_t)wall->end_um - wall->start_um, THROUGH_MOST_UM);
        }
    }
    return asked > 0 ? through_um * map->count / asked : 0;
}

static void learn(ale_place_t *place, int32_t score_q8)
{
    const int32_t memory = score_q8 < place->score_q8 ? BLAME_MEMORY : PRAISE_MEMORY;
    const int32_t n = (int32_t)ale_min64(place->scans + 1, memory);
    place->score_q8 += (int32_t)ale_round_div(score_q8 - place->score_q8, n);
    place->scans = (uint16_t)ale_min64(place->scans + 1, UINT16_MAX);
}

/* Fits the place to the scan and notes how much of the scan, and of the walls in view, it explains. */
static void fit_place(ale_place_t *place, const ale_scene_t *scene, const ale_mounted_scan_t *mounted,
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
                                                 place->pose, &observability, &work);
    if (h.shown_um > 0) {
        const int64_t all_um = h.shown_um + seen_through(scene->map, mounted, place->pose, next_wall);
        learn(place, (int32_t)(h.score_um * 256 / all_um));
    }
}

static bool is_double(const ale_relocation_t *r, uint32_t index)
{
    for (uint32_t i = 0; i < r->count; i++) {
        if (i != index && r->place[i].scans >= r->place[index].scans &&
            is_same(r->place[i].pose, r->place[index].pose)) {
            return true;
        }
    }
    return false;
}

static void fit_some(ale_relocation_t *r, const ale_scene_t *scene, const ale_mounted_scan_t *mounted,
                     const ale_motion_t *predicted, ale_fit_t *fit)
{
    const int64_t fits =
        ale_clamp64(FIT_WORK / (scene->observation_count + FIT_BESIDE), 1, ALE_PLACES_FITTED);
    for (uint32_t n = 0; n < fits && n < r->count; n++) {
        r->next = r->next < r->count ? r->next : 0;
        ale_place_t *place = &r->place[r->next];
        fit_place(place, scene, mounted, predicted, &r->next_wall, fit);
        const bool worthless = place->scans >= PROBATION && place->score_q8 < HELD_LEAST_Q8;
        if (worthless || is_double(r, r->next)) {
            drop(r, r->next);
        } else {
            r->next++;
        }
    }
}

/* The place that alone explains what was seen, or NULL. */
static ale_place_t *answer(ale_relocation_t *r)
{
    ale_place_t *best = NULL;
    for (uint32_t i = 0; i < r->count; i++) {
        if (r->place[i].scans >= ANSWER_SCANS && (!best || r->place[i].score_q8 > best->score_q8)) {
            best = &r->place[i];
        }
    }
    if (!best || best->score_q8 < ANSWER_Q8 || best->coverage_q8 < TOLD_Q8) {
        return NULL;
    }
    for (uint32_t i = 0; i < r->count; i++) {
        if (&r->place[i] != best && r->place[i].score_q8 > best->score_q8 - MARGIN_Q8) {
            return NULL;
        }
    }
    return best;
}

static const ale_observation_t *longest_view(const ale_scene_t *scene)
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

/* Whether the walls that the place explains hold it along the longest of them too: places half a metre before
 * and behind it, which nobody may have proposed, explain less. */
static bool is_pinned(const ale_scene_t *scene, ale_pose_t place)
{
    int32_t work = ALE_ASSOCIATION_WORK;
    const uint32_t along_bam = longest_view(scene)->normal_bam + ALE_BAM_QUARTER_TURN;
    const ale_hypothesis_t here = ale_hypothesis_at(scene->map, scene->observation, scene->observation_count,
                                                    place, &observability, &work);
    for (int32_t side = -1; side <= 1; side += 2) {
        const ale_point_t slid = ale_rotate((ale_point_t){side * SLIDE_UM, 0}, along_bam);
        const ale_pose_t beside = ale_pose_compose(place, (ale_pose_t){slid.x_um, slid.y_um, 0});
        const ale_hypothesis_t there = ale_hypothesis_at(
            scene->map, scene->observation, scene->observation_count, beside, &observability, &work);
        if (work <= 0 || (here.score_um - there.score_um) * 256 <= here.shown_um * PINNED_Q8) {
            return false;
        }
    }
    return true;
}

/* What rounds have told is forgotten on the way. */
static void forget(ale_relocation_t *r, ale_pose_t way)
{
    r->way_um += ale_isqrt((uint64_t)((int64_t)way.x_um * way.x_um + (int64_t)way.y_um * way.y_um));
    const int64_t forgotten_q8 = r->way_um * TOLD_Q8 / TOLD_WAY_UM;
    r->way_um -= forgotten_q8 * TOLD_WAY_UM / TOLD_Q8;
    for (uint32_t i = 0; i < r->count; i++) {
        r->place[i].coverage_q8 = (int32_t)ale_max64(r->place[i].coverage_q8 - forgotten_q8, 0);
    }
}

void ale_relocation_follow(ale_relocation_t *relocation, ale_pose_t way, bool counted)
{
    if (counted) {
        ale_trail_follow(&relocation->trail, way);
    } else {
        ale_trail_clear(&relocation->trail);
    }
    forget(relocation, way);
    for (uint32_t i = 0; i < relocation->count; i++) {
        relocation->place[i].pose = ale_pose_compose(relocation->place[i].pose, way);
    }
}

bool ale_relocate(ale_relocation_t *relocation, const ale_scene_t *scene, const ale_mounted_scan_t *mounted,
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
    if (!is_pinned(scene, place->pose)) {
        place->scans = 0;
        return false;
    }
    ale_register_associate(scene, fit);
    ale_register_weigh(scene, fit);
    return true;
}
