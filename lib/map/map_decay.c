#include "map/map_decay.h"

#include "base/fixed.h"
#include "map/visibility.h"

enum {
    VIOLATIONS_LEAST = 4,    /* of free space that remove a wall that was seen once */
    SCANS_PER_VIOLATION = 4, /* of support, that ask for one violation more */
    VIOLATIONS_MOST = 60,
    TRIM_UM = 10000,
    TRIM_INSIDE_UM = 30000,
    TRIM_LENGTH_UM = 300000 /* shorter walls are not trimmed */
};

static bool is_gone(const ale_wall_t *wall)
{
    return wall->missed > ale_min64(VIOLATIONS_LEAST + wall->seen / SCANS_PER_VIOLATION, VIOLATIONS_MOST);
}

/* Noise and objects beside a wall lengthen it; an end that is seen through is cut back. */
static void trim(ale_wall_t *wall, const ale_posed_scan_t *from)
{
    if (wall->end_um - wall->start_um < TRIM_LENGTH_UM) {
        return;
    }
    const int64_t start_um = wall->start_um + TRIM_INSIDE_UM;
    const int64_t end_um = wall->end_um - TRIM_INSIDE_UM;
    if (ale_wall_point_visibility(wall, start_um, from) == ALE_VISIBILITY_VIOLATED) {
        wall->start_um += TRIM_UM;
    }
    if (ale_wall_point_visibility(wall, end_um, from) == ALE_VISIBILITY_VIOLATED) {
        wall->end_um -= TRIM_UM;
    }
}

ale_visibility_counts_t ale_map_decay(ale_map_decay_t *decay, ale_local_map_t *map,
                                      const ale_posed_scan_t *from, uint32_t scan, bool forget)
{
    ale_visibility_counts_t counts = {0, 0};
    const uint32_t count = map->near_first[ALE_MAP_DIRECTIONS];
    uint16_t gone = ALE_NO_WALL;
    for (uint32_t n = 0; n < ALE_DECAY_WALLS && n < count; n++) {
        decay->next = decay->next + 1 < count ? decay->next + 1 : 0;
        const uint16_t index = map->near[decay->next];
        ale_wall_t *wall = &map->wall[index];
        if (forget) {
            trim(wall, from);
        }
        if (wall->last_scan == scan) {
            continue;
        }
        const ale_visibility_t visibility = ale_wall_visibility(wall, from);
        counts.supported = (uint16_t)(counts.supported + (visibility == ALE_VISIBILITY_SUPPORTED));
        counts.violated = (uint16_t)(counts.violated + (visibility == ALE_VISIBILITY_VIOLATED));
        if (forget && visibility != ALE_VISIBILITY_NONE) {
            wall->missed = visibility == ALE_VISIBILITY_SUPPORTED ? 0 : (uint16_t)(wall->missed + 1);
            gone = is_gone(wall) ? index : gone;
        }
    }
    if (gone != ALE_NO_WALL) {
        ale_local_map_remove(map, gone);
    }
    return counts;
}
