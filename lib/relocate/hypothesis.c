#include "relocate/hypothesis.h"

#include <stddef.h>

#include "base/fixed.h"
#include "base/trig.h"
#include "match/association.h"

enum {
    PAIR_ANGLE_BAM = 4 * ALE_BAM_PER_DEGREE, /* by which the enclosed angles may differ */
    LEAST_ENCLOSED_BAM = 30 * ALE_BAM_PER_DEGREE,
    SCORE_OFFSET_UM = 120000,
    SCORE_ANGLE_URAD = 120000,
    SCORE_SIGMAS = 1000,
    SHARED_PERCENT = 70, /* of either observation of the pair must lie on its wall */
    SECOND_PART = 2      /* the second pair must be at least half as long as the best */
};

static int32_t enclosed(uint32_t a_bam, uint32_t b_bam)
{
    return ale_bam_diff(b_bam, a_bam);
}

static bool is_open(int32_t angle_bam)
{
    const int64_t size = ale_abs64(angle_bam);
    return size > LEAST_ENCLOSED_BAM && size < (int64_t)ALE_BAM_HALF_TURN - LEAST_ENCLOSED_BAM;
}

typedef struct {
    uint32_t first;
    uint32_t second;
    int64_t shorter_um; /* 0: no pair */
} pair_t;

/* Length of an observation that may belong to a pair; of those that may not: 0. */
static int64_t usable_um(const ale_observation_t observation[], uint32_t i, const pair_t *other)
{
    const bool taken = other && (i == other->first || i == other->second);
    return observation[i].kind == ALE_OBSERVATION_LINE && !taken ? ale_observation_length_um(&observation[i])
                                                                 : 0;
}

/* The two observations that fix a pose best, without those of another pair: long, and far from parallel. */
static pair_t choose_pair(const ale_observation_t observation[], uint32_t count, const pair_t *other)
{
    pair_t best = {0, 0, 0};
    for (uint32_t i = 0; i < count; i++) {
        const int64_t length_um = usable_um(observation, i, other);
        for (uint32_t k = i + 1; length_um > best.shorter_um && k < count; k++) {
            const int64_t shorter_um = ale_min64(length_um, ale_observation_length_um(&observation[k]));
            if (shorter_um > best.shorter_um && usable_um(observation, k, other) > 0 &&
                is_open(enclosed(observation[i].normal_bam, observation[k].normal_bam))) {
                best = (pair_t){i, k, shorter_um};
            }
        }
    }
    return best;
}

/* The best pair, and in every other round the best one beside it where that is worth it. */
static pair_t pair_of_round(const ale_search_t *search, const ale_observation_t observation[], uint32_t count)
{
    const pair_t best = choose_pair(observation, count, NULL);
    if (search->rounds % 2 == 0 || best.shorter_um == 0) {
        return best;
    }
    const pair_t second = choose_pair(observation, count, &best);
    return second.shorter_um * SECOND_PART >= best.shorter_um ? second : best;
}

int32_t ale_search_pair_q8(const ale_search_t *search, const ale_observation_t observation[], uint32_t count)
{
    const pair_t pair = pair_of_round(search, observation, count);
    int64_t shown_um = 0;
    for (uint32_t i = 0; i < count; i++) {
        shown_um +=
            observation[i].kind == ALE_OBSERVATION_LINE ? ale_observation_length_um(&observation[i]) : 0;
    }
    return shown_um > 0 ? (int32_t)(pair.shorter_um * 256 / shown_um) : 0;
}

bool ale_pose_of_pair(const ale_observation_t *a, const ale_observation_t *b, const ale_wall_t *wall_a,
                      const ale_wall_t *wall_b, ale_pose_t *out)
{
    const uint32_t turn_a = wall_a->normal_bam - a->normal_bam;
    const int32_t apart_bam = ale_bam_diff(wall_b->normal_bam - b->normal_bam, turn_a);
    const uint32_t theta = turn_a + (uint32_t)(apart_bam / 2);
    const ale_point_t pa = ale_minus(wall_a->anchor, ale_rotate(a->centre, theta));
    const ale_point_t pb = ale_minus(wall_b->anchor, ale_rotate(b->centre, theta));
    const int64_t ra = ale_round_shift(
        (int64_t)pa.x_um * wall_a->normal_x_q30 + (int64_t)pa.y_um * wall_a->normal_y_q30, 30);
    const int64_t rb = ale_round_shift(
        (int64_t)pb.x_um * wall_b->normal_x_q30 + (int64_t)pb.y_um * wall_b->normal_y_q30, 30);
    const int64_t det_q30 = ale_sin_q30(wall_b->normal_bam - wall_a->normal_bam);
    if (ale_abs64(det_q30) < 1 << 28) {
        return false;
    }
    const int64_t x = ale_round_div(
        (ra * wall_b->normal_y_q30 - rb * wall_a->normal_y_q30) * (det_q30 < 0 ? -1 : 1), ale_abs64(det_q30));
    const int64_t y = ale_round_div(
        (rb * wall_a->normal_x_q30 - ra * wall_b->normal_x_q30) * (det_q30 < 0 ? -1 : 1), ale_abs64(det_q30));
    *out = (ale_pose_t){(int32_t)x, (int32_t)y, theta};
    return ale_abs64(x) < INT32_MAX && ale_abs64(y) < INT32_MAX;
}

ale_hypothesis_t ale_hypothesis_at(const ale_local_map_t *map, const ale_observation_t observation[],
                                   uint32_t count, ale_pose_t pose, const ale_gate_t *gate, int32_t *work)
{
    const ale_viewpoint_t viewpoint = ale_viewpoint(pose);
    ale_hypothesis_t h = {.pose = pose};
    for (uint32_t i = 0; *work > 0 && i < count; i++) {
        if (observation[i].kind != ALE_OBSERVATION_LINE) {
            continue;
        }
        *work -= ALE_PLACEMENT_WORK;
        const ale_association_t association =
            ale_associate(map, &observation[i], &viewpoint, NULL, gate, work);
        h.shown_um += ale_observation_length_um(&observation[i]);
        if (association.wall != ALE_NO_WALL) {
            h.score_um += ale_min64(association.error.overlap_um, ale_observation_length_um(&observation[i]));
            h.observations++;
        }
    }
    return h;
}

/* Whether the observation, seen from the pose, covers a part of the wall that is worth the name. */
static bool lies_on(const ale_wall_t *wall, const ale_observation_t *observation, ale_pose_t pose)
{
    const ale_viewpoint_t viewpoint = ale_viewpoint(pose);
    const ale_observation_t placed = ale_observation_from(observation, &viewpoint);
    return ale_wall_error(wall, &placed).overlap_um * 100 >=
           ale_observation_length_um(observation) * SHARED_PERCENT;
}

/* No pose can lay as much of the observation on the wall as lies_on asks for. */
static bool is_too_short(const ale_wall_t *wall, const ale_observation_t *observation)
{
    return ((int64_t)wall->end_um - wall->start_um) * 100 <
           ale_observation_length_um(observation) * SHARED_PERCENT;
}

static void next_first(ale_search_t *s, uint16_t count)
{
    s->second = 0;
    s->first = (uint16_t)(s->first + 1 < count ? s->first + 1 : 0);
    s->rounds += s->first == 0;
}

static void next_pair(ale_search_t *s, uint16_t count)
{
    s->second++;
    if (s->second >= count) {
        next_first(s, count);
    }
}

/* The two observations of a round, and the map on whose walls they are placed. */
typedef struct {
    const ale_local_map_t *map;
    const ale_observation_t *a;
    const ale_observation_t *b;
} query_t;

/* The next pair of walls that encloses the angle of the two observations and is long enough for them, in at
 * most *pairs steps; false: none up to the end of the round. */
static bool next_candidate(ale_search_t *s, const query_t *q, uint32_t round, int32_t *pairs,
                           uint16_t wall[2])
{
    const uint16_t count = q->map->count;
    const int32_t angle_bam = enclosed(q->a->normal_bam, q->b->normal_bam);
    for (; *pairs > 0 && s->rounds == round; --*pairs) {
        const ale_wall_t *wall_a = &q->map->wall[s->first];
        const ale_wall_t *wall_b = &q->map->wall[s->second];
        if (wall_a->map != q->map->selected || is_too_short(wall_a, q->a)) {
            next_first(s, count);
            continue;
        }
        wall[0] = s->first;
        wall[1] = s->second;
        next_pair(s, count);
        const int32_t in_map_bam = enclosed(wall_a->normal_bam, wall_b->normal_bam);
        if (ale_abs64(ale_bam_diff((uint32_t)in_map_bam, (uint32_t)angle_bam)) < PAIR_ANGLE_BAM &&
            wall_b->map == q->map->selected && !is_too_short(wall_b, q->b)) {
            return true;
        }
    }
    return false;
}

/* The pose that lays the two observations on two walls; false: there is none. */
static bool place(const query_t *q, const uint16_t wall[2], ale_pose_t *pose)
{
    const ale_wall_t *wall_a = &q->map->wall[wall[0]];
    const ale_wall_t *wall_b = &q->map->wall[wall[1]];
    return ale_pose_of_pair(q->a, q->b, wall_a, wall_b, pose) && lies_on(wall_a, q->a, *pose) &&
           lies_on(wall_b, q->b, *pose);
}

uint32_t ale_search(ale_search_t *search, ale_local_map_t *map, const ale_observation_t observation[],
                    uint32_t count, ale_hypothesis_t out[ALE_MAX_HYPOTHESES])
{
    const ale_gate_t gate = {SCORE_OFFSET_UM, SCORE_ANGLE_URAD, SCORE_SIGMAS, 0};
    const pair_t pair = pair_of_round(search, observation, count);
    if (map->count < 2 || pair.shorter_um == 0) {
        return 0;
    }
    const query_t query = {map, &observation[pair.first], &observation[pair.second]};
    search->first = search->first < map->count ? search->first : 0;
    search->second = search->second < map->count ? search->second : 0;
    ale_local_map_focus(map, (ale_point_t){0, 0}, INT32_MAX);
    int32_t work = ALE_SEARCH_WORK;
    int32_t pairs = ALE_HYPOTHESIS_PAIRS;
    const uint32_t round = search->rounds;
    uint32_t scored = 0;
    for (uint32_t placed = 0; placed < ALE_HYPOTHESIS_POSES && scored < ALE_MAX_HYPOTHESES; placed++) {
        const ale_search_t before = *search;
        uint16_t wall[2];
        ale_pose_t pose;
        if (!next_candidate(search, &query, round, &pairs, wall)) {
            break;
        }
        if (!place(&query, wall, &pose)) {
            continue;
        }
        out[scored] = ale_hypothesis_at(map, observation, count, pose, &gate, &work);
        if (work <= 0 && scored > 0) {
            *search = before; /* it was scored in part only: the next scan repeats it */
            break;
        }
        scored++;
    }
    return scored;
}
