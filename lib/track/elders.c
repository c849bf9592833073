#include "track/elders.h"

#include "base/fixed.h"
#include "base/trig.h"
#include "track/visibility.h"
#include "track/wall.h"

enum {
    EVERY_US = 5000000,
    NEAR_UM = 50000, /* from elsewhere a place may look otherwise */
    NEAR_BAM = 3 * ALE_BAM_PER_DEGREE,
    ASKED_MOST = 8,
    DENIED_LEAST = 2 /* points of a line that were looked through */
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

static bool has_come(const ale_elders_t *elders, const ale_seen_t *seen, const ale_view_t *view)
{
    const ale_stand_t stand = ale_stand(seen->robot);
    const ale_view_t placed = ale_view_from(view, &stand);
    ale_wall_t surface;
    ale_wall_from_view(&surface, &placed);
    for (int i = 0; i < ALE_ELDERS; i++) {
        const ale_elder_t *elder = &elders->elder[i];
        const ale_seen_copy_t *then = &elder->seen;
        if (elder->taken && ale_are_near(then->robot, seen->robot, NEAR_UM, NEAR_BAM) &&
            ale_wall_points_sight(&surface, &then->scan, ale_seen_bearings(then), then->sensor,
                                  (ale_slack_t){0, 0})
                    .through >= DENIED_LEAST) {
            return true;
        }
    }
    return false;
}

uint32_t ale_elders_drop_newcomers(const ale_elders_t *elders, const ale_seen_t *seen, ale_view_t view[],
                                   ale_match_t match[])
{
    uint32_t left = 0;
    int asked = 0;
    for (uint32_t i = 0; i < seen->view_count; i++) {
        const bool is_new = view[i].kind == ALE_VIEW_WALL && match[i].wall == ALE_NO_WALL;
        if (is_new && asked++ < ASKED_MOST && has_come(elders, seen, &view[i])) {
            continue;
        }
        view[left] = view[i];
        match[left++] = match[i];
    }
    return left;
}
