#include "track/evidence/way_back.h"

#include <string.h>

#include "base/fixed.h"
#include "base/trig.h"
#include "map/visibility.h"

enum {
    APART_UM = 250000,
    DENIED_POINTS = 2,     /* of a wall, and none that is seen */
    WALL_MOST_UM = 2000000 /* that one wall counts for */
};

void ale_way_back_clear(ale_way_back_t *way_back)
{
    way_back->count = 0;
    way_back->apart_um = APART_UM;
    for (uint32_t i = 0; i < ALE_WAY_BACK; i++) {
        way_back->order[i] = (uint8_t)i;
    }
}

/* Gives up every other one of all that there is room for. */
static void thin(ale_way_back_t *way_back)
{
    uint8_t given_up[ALE_WAY_BACK / 2];
    way_back->count /= 2;
    way_back->apart_um *= 2;
    for (size_t i = 0; i < ALE_WAY_BACK / 2; i++) {
        given_up[i] = way_back->order[2 * i + 1];
        way_back->order[i] = way_back->order[2 * i];
    }
    memcpy(&way_back->order[ALE_WAY_BACK / 2], given_up, sizeof given_up);
}

static const ale_seen_copy_t *newest(const ale_way_back_t *way_back)
{
    return &way_back->seen[way_back->order[way_back->count - 1]];
}

void ale_way_back_keep(ale_way_back_t *way_back, const ale_seen_t *seen)
{
    const int32_t apart_bam = way_back->apart_um / 1000 * ALE_BAM_PER_MRAD;
    if (way_back->count > 0 &&
        ale_are_near(newest(way_back)->robot, seen->robot, way_back->apart_um, apart_bam)) {
        return;
    }
    if (way_back->count == ALE_WAY_BACK) {
        thin(way_back);
    }
    ale_seen_copy(&way_back->seen[way_back->order[way_back->count++]], seen);
}

/* Which walls of the selected map a scan sees, and sees through, taken from there; `next` is asked first. */
static void ask(ale_way_back_t *way_back, const ale_local_map_t *map, const ale_posed_scan_t *from,
                uint32_t next)
{
    uint32_t asked = 0;
    const int64_t farthest_um = ale_farthest_um(from->scan);
    for (uint32_t n = 0; n < map->count && asked < ALE_WAY_BACK_WALLS; n++) {
        const uint32_t i = next + n < map->count ? next + n : next + n - map->count;
        const ale_wall_t *wall = &map->wall[i];
        if (wall->map != map->selected || !ale_wall_may_be_in_view(wall, from->sensor, farthest_um)) {
            continue;
        }
        asked++;
        const ale_points_visibility_t seen =
            ale_wall_points_visibility(wall, from, (ale_slack_t){0, 0, false});
        const bool denied = seen.supported == 0 && seen.violated >= DENIED_POINTS;
        way_back->wall[i].supported = (uint8_t)(way_back->wall[i].supported + (seen.supported > 0));
        way_back->wall[i].violated = (uint8_t)(way_back->wall[i].violated + denied);
    }
}

int64_t ale_way_back_denied_um(ale_way_back_t *way_back, const ale_local_map_t *map, ale_pose_t robot,
                               ale_pose_t there)
{
    int64_t denied_um = 0;
    memset(way_back->wall, 0, sizeof way_back->wall);
    for (uint32_t k = 0; k < way_back->count; k++) {
        const ale_seen_copy_t *then = &way_back->seen[way_back->order[k]];
        ale_posed_scan_t from = ale_seen_copy_posed(then);
        from.sensor = ale_pose_compose(there, ale_pose_between(robot, then->sensor));
        ask(way_back, map, &from, k * map->count / ALE_WAY_BACK);
    }
    for (uint32_t i = 0; i < map->count; i++) {
        if (way_back->wall[i].violated > way_back->wall[i].supported) {
            denied_um += ale_min64((int64_t)map->wall[i].end_um - map->wall[i].start_um, WALL_MOST_UM);
        }
    }
    return denied_um;
}
