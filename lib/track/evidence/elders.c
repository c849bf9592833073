#include "track/evidence/elders.h"

#include "base/fixed.h"
#include "base/trig.h"
#include "map/visibility.h"
#include "map/wall.h"
#include "track/evidence/zero_motion.h"

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

bool ale_elders_keep(ale_elders_t *elders, const ale_seen_t *seen)
{
    if (elders->kept > 0 && ale_abs64(seen->posed.scan->stamp_us - elders->kept_us) < EVERY_US) {
        return false;
    }
    ale_elder_t *elder = &elders->elder[place_of(elders->kept++)];
    elders->kept_us = seen->posed.scan->stamp_us;
    elder->taken = true;
    ale_seen_copy(&elder->seen, seen);
    return true;
}

/* A robot that rests hardly errs in where its elders were: whatever of a line was not there speaks against
 * it. */
static bool looked_through(const ale_elder_t *elder, const ale_wall_t *surface, ale_pose_t robot, bool rests)
{
    const ale_seen_copy_t *then = &elder->seen;
    if (!elder->taken || !ale_are_near(then->robot, robot, NEAR_UM, NEAR_BAM)) {
        return false;
    }
    const ale_slack_t slack = {
        0, 0, rests && ale_are_near(then->robot, robot, ALE_ZERO_MOTION_UM, ALE_ZERO_MOTION_BAM)};
    const ale_posed_scan_t from = ale_seen_copy_posed(then);
    const ale_points_visibility_t visibility = ale_wall_points_visibility(surface, &from, slack);
    return slack.same_place ? visibility.violated > visibility.supported
                            : visibility.violated >= DENIED_LEAST;
}

static bool has_come(const ale_elders_t *elders, const ale_seen_t *seen, const ale_observation_t *observation,
                     bool rests)
{
    const ale_viewpoint_t viewpoint = ale_viewpoint(seen->robot);
    const ale_observation_t placed = ale_observation_from(observation, &viewpoint);
    ale_wall_t surface;
    ale_wall_from_observation(&surface, &placed);
    for (int i = 0; i < ALE_ELDERS; i++) {
        if (looked_through(&elders->elder[i], &surface, seen->robot, rests)) {
            return true;
        }
    }
    return false;
}

/* A line that the map does not hold; or, at rest, not for long or not as far as it goes. */
static bool is_new(const ale_local_map_t *map, const ale_observation_t *observation,
                   const ale_association_t *association, bool rests)
{
    if (observation->kind != ALE_OBSERVATION_LINE || association->wall == ALE_NO_WALL) {
        return observation->kind == ALE_OBSERVATION_LINE;
    }
    if (!rests) {
        return false;
    }
    const ale_wall_t *wall = &map->wall[association->wall];
    return wall->seen < YOUNG_LOOKS ||
           association->error.t_um + observation->start_um < (int64_t)wall->start_um - LENGTHENS_UM ||
           association->error.t_um + observation->end_um > (int64_t)wall->end_um + LENGTHENS_UM;
}

uint32_t ale_elders_drop_newcomers(const ale_elders_t *elders, const ale_local_map_t *map,
                                   const ale_seen_t *seen, bool rests, ale_observation_t observation[],
                                   ale_association_t association[])
{
    uint32_t left = 0;
    int asked = 0;
    for (uint32_t i = 0; i < seen->observation_count; i++) {
        if (is_new(map, &observation[i], &association[i], rests) && asked++ < ASKED_MOST &&
            has_come(elders, seen, &observation[i], rests)) {
            continue;
        }
        observation[left] = observation[i];
        association[left++] = association[i];
    }
    return left;
}
