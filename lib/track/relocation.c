#include "track/relocation.h"

#include <stddef.h>

#include "base/fixed.h"
#include "base/trig.h"

enum {
    BLAME_MEMORY = 8,   /* fits that the mean remembers where a place explains less than before, */
    PRAISE_MEMORY = 40, /* and where it explains more: a wrong place must not recover in the next cell */
    THROUGH_MOST_UM = 1000000, /* of a wall that is seen through */
    PROBATION = 4,             /* fits before a place may be dropped */
    HELD_LEAST_Q8 = 140,       /* places that explain less are dropped */
    ANSWER_SCANS = 8,          /* fits of the answer */
    ANSWER_Q8 = 205,           /* it explains 80 % */
    MARGIN_Q8 = 36,            /* and 14 % more than any other place */
    PEER_PART = 2,     /* that has stood the test for half as long: who comes later was not found before */
    ANSWER_ROUNDS = 1, /* times all pairs of walls were tried */
    SAME_UM = 250000,  /* places nearer than this are one */
    SAME_BAM = 150 * ALE_BAM_PER_MRAD,
    FIT_OFFSET_UM = 400000, /* how far a place may be off when it is fitted */
    FIT_ANGLE_URAD = 200000,
    FIT_SIGMAS = 4,
    FIT_VIEWS = 96,    /* views that are fitted in a scan: one fit of a rich scan, several of a plain one */
    SIGHT_WALLS = 384, /* of the map that are asked in one fit, in turn */
    FIT_SIGMA_UM = 100000,
    FIT_SIGMA_URAD = 50000,
    HOLD_OFFSET_UM = 60000, /* a line lies on a wall when it is no farther from it */
    HOLD_ANGLE_URAD = 90000,
    SLIDE_UM = 500000, /* along the longest wall in view, where the answer must explain less */
    PINNED_Q8 = 20     /* by 8 %: in a corridor of long walls only all places along it are alike */
};

static const ale_gate_t hold = {HOLD_OFFSET_UM, HOLD_ANGLE_URAD, FIT_SIGMAS, 0};

void ale_relocation_clear(ale_relocation_t *relocation)
{
    *relocation = (ale_relocation_t){.count = 0};
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

/* A new place takes the room of the one that explains least, if it explains more. */
static void enter(ale_relocation_t *r, const ale_hypothesis_t *h)
{
    uint32_t worst = 0;
    for (uint32_t i = 0; i < r->count; i++) {
        if (is_same(r->place[i].pose, h->pose)) {
            return;
        }
        worst = r->place[i].held_q8 < r->place[worst].held_q8 ? i : worst;
    }
    const int32_t held_q8 = (int32_t)(h->score_um * 256 / h->shown_um);
    if (r->count < ALE_PLACES) {
        worst = r->count++;
    } else if (r->place[worst].held_q8 >= held_q8) {
        return;
    }
    r->place[worst] = (ale_place_t){.pose = h->pose, .held_q8 = held_q8};
}

static void propose(ale_relocation_t *r, const ale_scene_t *scene)
{
    ale_hypothesis_t found[ALE_MAX_HYPOTHESES];
    const uint32_t count = ale_search(&r->search, scene->map, scene->view, scene->view_count, found);
    for (uint32_t i = 0; i < count; i++) {
        if (found[i].score_um * 256 >= found[i].shown_um * HELD_LEAST_Q8) {
            enter(r, &found[i]);
        }
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
static int64_t seen_through(const ale_local_map_t *map, const ale_eye_t *eye, ale_pose_t place,
                            uint16_t *next)
{
    const ale_pose_t sensor = ale_pose_compose(place, eye->sensor);
    const uint16_t asked = (uint16_t)ale_min64(map->count, SIGHT_WALLS);
    int64_t through_um = 0;
    for (uint32_t i = 0; i < asked; i++) {
        *next = (uint16_t)(*next + 1 < map->count ? *next + 1 : 0);
        const ale_wall_t *wall = &map->wall[*next];
        if (is_far(wall, sensor, eye->scan->range_max_um)) {
            continue;
        }
        if (ale_wall_sight(wall, eye->scan, eye->bearing_bam, sensor) == ALE_SIGHT_THROUGH) {
            through_um += ale_min64((int64_t)wall->end_um - wall->start_um, THROUGH_MOST_UM);
        }
    }
    return asked > 0 ? through_um * map->count / asked : 0;
}

static void learn(ale_place_t *place, int32_t held_q8)
{
    const int32_t memory = held_q8 < place->held_q8 ? BLAME_MEMORY : PRAISE_MEMORY;
    const int32_t n = (int32_t)ale_min64(place->scans + 1, memory);
    place->held_q8 += (int32_t)ale_round_div(held_q8 - place->held_q8, n);
    place->scans = (uint16_t)ale_min64(place->scans + 1, UINT16_MAX);
}

/* Fits the place to the scan and notes how much of the scan, and of the walls in view, it explains. */
static void fit_place(ale_place_t *place, const ale_scene_t *scene, const ale_eye_t *eye,
                      const ale_motion_t *predicted, uint16_t *next_wall, ale_fit_t *fit)
{
    int32_t looks = ALE_LOOKS;
    const ale_gate_t gate = {FIT_OFFSET_UM, FIT_ANGLE_URAD, FIT_SIGMAS, 0};
    ale_motion_t there = *predicted;
    there.pose = place->pose;
    ale_motion_widen(&there, FIT_SIGMA_UM, FIT_SIGMA_URAD);
    ale_refine(&there, scene, &gate, fit);
    place->pose = fit->motion.pose;
    const ale_hypothesis_t h =
        ale_hypothesis_at(scene->map, scene->view, scene->view_count, place->pose, &hold, &looks);
    if (h.shown_um > 0) {
        const int64_t all_um = h.shown_um + seen_through(scene->map, eye, place->pose, next_wall);
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

static void fit_some(ale_relocation_t *r, const ale_scene_t *scene, const ale_eye_t *eye,
                     const ale_motion_t *predicted, ale_fit_t *fit)
{
    const int64_t fits = ale_clamp64(FIT_VIEWS / (scene->view_count + 1), 1, ALE_PLACES_FITTED);
    for (uint32_t n = 0; n < fits && n < r->count; n++) {
        r->next = r->next < r->count ? r->next : 0;
        ale_place_t *place = &r->place[r->next];
        fit_place(place, scene, eye, predicted, &r->next_wall, fit);
        const bool worthless = place->scans >= PROBATION && place->held_q8 < HELD_LEAST_Q8;
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
        if (r->place[i].scans >= ANSWER_SCANS && (!best || r->place[i].held_q8 > best->held_q8)) {
            best = &r->place[i];
        }
    }
    if (!best || best->held_q8 < ANSWER_Q8 || r->search.rounds < ANSWER_ROUNDS) {
        return NULL;
    }
    for (uint32_t i = 0; i < r->count; i++) {
        const ale_place_t *other = &r->place[i];
        const bool peer = other->scans * PEER_PART >= best->scans || other->held_q8 >= best->held_q8;
        if (other != best && peer && other->held_q8 > best->held_q8 - MARGIN_Q8) {
            return NULL;
        }
    }
    return best;
}

static const ale_view_t *longest_view(const ale_scene_t *scene)
{
    const ale_view_t *longest = &scene->view[0];
    for (uint32_t i = 1; i < scene->view_count; i++) {
        const ale_view_t *view = &scene->view[i];
        if (view->kind == ALE_VIEW_WALL &&
            view->end_um - view->start_um > longest->end_um - longest->start_um) {
            longest = view;
        }
    }
    return longest;
}

/* Whether the walls that the place explains hold it along the longest of them too: places half a metre before
 * and behind it, which nobody may have proposed, explain less. */
static bool is_pinned(const ale_scene_t *scene, ale_pose_t place)
{
    int32_t looks = ALE_LOOKS;
    const uint32_t along_bam = longest_view(scene)->normal_bam + ALE_BAM_QUARTER_TURN;
    const ale_hypothesis_t here =
        ale_hypothesis_at(scene->map, scene->view, scene->view_count, place, &hold, &looks);
    for (int32_t side = -1; side <= 1; side += 2) {
        const ale_point_t slid = ale_rotate((ale_point_t){side * SLIDE_UM, 0}, along_bam);
        const ale_pose_t beside = ale_pose_compose(place, (ale_pose_t){slid.x_um, slid.y_um, 0});
        const ale_hypothesis_t there =
            ale_hypothesis_at(scene->map, scene->view, scene->view_count, beside, &hold, &looks);
        if (looks <= 0 || (here.score_um - there.score_um) * 256 <= here.shown_um * PINNED_Q8) {
            return false;
        }
    }
    return true;
}

void ale_relocation_follow(ale_relocation_t *relocation, ale_pose_t way)
{
    for (uint32_t i = 0; i < relocation->count; i++) {
        relocation->place[i].pose = ale_pose_compose(relocation->place[i].pose, way);
    }
}

bool ale_relocate(ale_relocation_t *relocation, const ale_scene_t *scene, const ale_eye_t *eye,
                  const ale_motion_t *predicted, ale_fit_t *fit)
{
    ale_place_t *place = answer(relocation);
    if (!place) {
        propose(relocation, scene);
        fit_some(relocation, scene, eye, predicted, fit);
        return false;
    }
    fit_place(place, scene, eye, predicted, &relocation->next_wall, fit);
    if (place->held_q8 < ANSWER_Q8) {
        return false;
    }
    if (!is_pinned(scene, place->pose)) {
        place->scans = 0;
        return false;
    }
    return true;
}
