#include "track/hypothesis.h"

#include <stddef.h>

#include "base/fixed.h"
#include "base/trig.h"
#include "track/match.h"

enum {
    PAIR_ANGLE_BAM = 4 * ALE_BAM_PER_DEGREE, /* how well the enclosed angles must agree */
    LEAST_ENCLOSED_BAM = 30 * ALE_BAM_PER_DEGREE,
    SCORE_OFFSET_UM = 120000,
    SCORE_ANGLE_URAD = 120000,
    SCORE_SIGMAS = 1000,
    SHARED_PERCENT = 70, /* of either view of the pair must lie on its wall */
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

static int64_t length_of(const ale_view_t *v)
{
    return (int64_t)v->end_um - v->start_um;
}

/* The two views that fix a pose best: long, and far from parallel. */
static bool choose_pair(const ale_view_t view[], uint32_t count, uint32_t pair[2])
{
    int64_t best = 0;
    for (uint32_t i = 0; i < count; i++) {
        for (uint32_t k = i + 1; k < count; k++) {
            const bool walls = view[i].kind == ALE_VIEW_WALL && view[k].kind == ALE_VIEW_WALL;
            const int64_t shorter_um = ale_min64(length_of(&view[i]), length_of(&view[k]));
            if (walls && shorter_um > best && is_open(enclosed(view[i].normal_bam, view[k].normal_bam))) {
                best = shorter_um;
                pair[0] = i;
                pair[1] = k;
            }
        }
    }
    return best > 0;
}

bool ale_pose_of_pair(const ale_view_t *a, const ale_view_t *b, const ale_wall_t *wall_a,
                      const ale_wall_t *wall_b, ale_pose_t *out)
{
    const uint32_t turn_a = wall_a->normal_bam - a->normal_bam;
    const int32_t rest = ale_bam_diff(wall_b->normal_bam - b->normal_bam, turn_a);
    const uint32_t theta = turn_a + (uint32_t)(rest / 2);
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

ale_hypothesis_t ale_hypothesis_at(const ale_local_map_t *map, const ale_view_t view[], uint32_t count,
                                   ale_pose_t pose, const ale_gate_t *gate, int32_t *looks)
{
    const ale_stand_t stand = ale_stand(pose);
    ale_hypothesis_t h = {.pose = pose};
    for (uint32_t i = 0; *looks > 0 && i < count; i++) {
        if (view[i].kind != ALE_VIEW_WALL) {
            continue;
        }
        *looks -= ALE_LOOKS_OF_A_MOVE;
        const ale_match_t match = ale_match_view(map, &view[i], &stand, NULL, gate, looks);
        h.shown_um += length_of(&view[i]);
        if (match.wall != ALE_NO_WALL) {
            h.score_um += ale_min64(match.error.overlap_um, length_of(&view[i]));
            h.views++;
        }
    }
    return h;
}

/* Whether the view, seen from the pose, covers a part of the wall that is worth the name. */
static bool lies_on(const ale_wall_t *wall, const ale_view_t *view, ale_pose_t pose)
{
    const ale_stand_t stand = ale_stand(pose);
    const ale_view_t placed = ale_view_from(view, &stand);
    return ale_wall_error(wall, &placed).overlap_um * 100 >= length_of(view) * SHARED_PERCENT;
}

/* No pose can lay as much of the view on the wall as lies_on asks for. */
static bool is_too_short(const ale_wall_t *wall, const ale_view_t *view)
{
    return ((int64_t)wall->end_um - wall->start_um) * 100 < length_of(view) * SHARED_PERCENT;
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

uint32_t ale_search(ale_search_t *search, ale_local_map_t *map, const ale_view_t view[], uint32_t count,
                    ale_hypothesis_t out[ALE_MAX_HYPOTHESES])
{
    const ale_gate_t gate = {SCORE_OFFSET_UM, SCORE_ANGLE_URAD, SCORE_SIGMAS, 0};
    uint32_t pair[2] = {0, 0};
    if (map->count < 2 || !choose_pair(view, count, pair)) {
        return 0;
    }
    const ale_view_t *a = &view[pair[0]];
    const ale_view_t *b = &view[pair[1]];
    const int32_t angle_bam = enclosed(a->normal_bam, b->normal_bam);
    search->first = search->first < map->count ? search->first : 0;
    search->second = search->second < map->count ? search->second : 0;
    ale_local_map_focus(map, (ale_point_t){0, 0}, INT32_MAX);
    int32_t looks = ALE_SEARCH_LOOKS;
    uint32_t scored = 0;
    uint32_t placed = 0;
    for (uint32_t n = 0; n < ALE_HYPOTHESIS_PAIRS && placed < ALE_HYPOTHESIS_POSES &&
                         scored < ALE_MAX_HYPOTHESES && looks > 0;
         n++) {
        const ale_wall_t *wall_a = &map->wall[search->first];
        const ale_wall_t *wall_b = &map->wall[search->second];
        if (is_too_short(wall_a, a)) {
            next_first(search, map->count);
            continue;
        }
        const int32_t in_map_bam = enclosed(wall_a->normal_bam, wall_b->normal_bam);
        ale_pose_t pose;
        next_pair(search, map->count);
        if (ale_abs64(ale_bam_diff((uint32_t)in_map_bam, (uint32_t)angle_bam)) >= PAIR_ANGLE_BAM ||
            is_too_short(wall_b, b)) {
            continue;
        }
        placed++;
        if (ale_pose_of_pair(a, b, wall_a, wall_b, &pose) && lies_on(wall_a, a, pose) &&
            lies_on(wall_b, b, pose)) {
            out[scored++] = ale_hypothesis_at(map, view, count, pose, &gate, &looks);
        }
    }
    return scored;
}
