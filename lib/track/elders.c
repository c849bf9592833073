#include "track/elders.h"

#include "base/fixed.h"
#include "base/trig.h"
#include "map/visibility.h"
#include "map/wall.h"
#include "track/zero_motion.h"

enum {
    EVERY_US = 5000000,
    NEAR_UM = 50000, /* from elsewhere a place may look otherwise */
    NEAR_BAM = 3 * ALE_BAM_PER_DEGREE,
    ASKED_MOST = 8,
    DENIED_LEAST = 2, /* points of a line that were looked through */
    YOUNG_LOOKS = 16, /* what a wall was taken for is asked again until then */
    LENGTHENS_UM = 50000
};

void ale_elders_clear(ale_elders_t *elders)
{
    elders->kept = 0;
    for (int i = 0; i < ALE_ELDERS; i++) {
        elders->elder[i].taken = false;
    }
}

/* The n-th takes the place of one that is twice as old for every factor 2 in n: 0 1 0 2 0 1 0 3 .. */
static uint32_t place_of(uint32_t n)
{
    uint32_t place = 0;
    while (place + 1 < ALE_ELDERS && (n >> place & 1U) == 0) {
        place++;
    }
    return place;
}

void ale_elders_keep(ale_elders_t *elders, const ale_seen_t *seen)
{
    if (elders->kept > 0 && ale_abs64(seen->scan->stamp_us - elders->kept_us) < EVERY_US) {
        return;
    }
    ale_elder_t *elder = &elders->elder[place_of(elders->kept++)];
    elders->kept_us = seen->scan->stamp_us;
    elder->taken = true;
    ale_seen_copy(&elder->seen, seen);
}

/* A robot that rests hardly errs in where its elders were: whatever of a line was not there speaks against
 * it. */
static bool looked_through(const ale_elder_t *elder, const ale_wall_t *surface, ale_pose_t robot, bool rests)
{
    const ale_seen_copy_t *then = &elder->seen;
    if (!elder->taken || !ale_are_near(then->robot, robot, NEAR_UM, NEAR_BAM)) {
        return false;
    }
    const ale_slack_t slack = {0, 0, rests && ale_are_near(then->robot, robot, ALE_REST_UM, ALE_REST_BAM)};
    const ale_points_sight_t sight =
        ale_wall_points_sight(surface, &then->scan, ale_seen_bearings(then), then->sensor, slack);
    return slack.same_place ? sight.through > sight.supported : sight.through >= DENIED_LEAST;
}

static bool has_come(const ale_elders_t *elders, const ale_seen_t *seen, const ale_view_t *view, bool rests)
{
    const ale_stand_t stand = ale_stand(seen->robot);
    const ale_view_t placed = ale_view_from(view, &stand);
    ale_wall_t surface;
    ale_wall_from_view(&surface, &placed);
    for (int i = 0; i < ALE_ELDERS; i++) {
        if (looked_through(&elders->elder[i], &surface, seen->robot, rests)) {
            return true;
        }
    }
    return false;
}

/* A line that the map does not hold; or, at rest, not for long or not as far as it goes. */
static bool is_new(const ale_local_map_t *map, const ale_view_t *view, const ale_match_t *match, bool rests)
{
    if (view->kind != ALE_VIEW_WALL || match->wall == ALE_NO_WALL) {
        return view->kind == ALE_VIEW_WALL;
    }
    if (!rests) {
        return false;
    }
    const ale_wall_t *wall = &map->wall[match->wall];
    return wall->seen < YOUNG_LOOKS ||
           match->error.t_um + view->start_um < (int64_t)wall->start_um - LENGTHENS_UM ||
           match->error.t_um + view->end_um > (int64_t)wall->end_um + LENGTHENS_UM;
}

uint32_t ale_elders_drop_newcomers(const ale_elders_t *elders, const ale_local_map_t *map,
                                   const ale_seen_t *seen, bool rests, ale_view_t view[], ale_match_t match[])
{
    uint32_t left = 0;
    int asked = 0;
    for (uint32_t i = 0; i < seen->view_count; i++) {
        if (is_new(map, &view[i], &match[i], rests) && asked++ < ASKED_MOST &&
            has_come(elders, seen, &view[i], rests)) {
            continue;
        }
        view[left] = view[i];
        match[left++] = match[i];
    }
    return left;
}
