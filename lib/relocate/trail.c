#include "relocate/trail.h"

#include <string.h>

#include "base/fixed.h"
#include "base/trig.h"
#include "observe/seen.h"
#include "relocate/hypothesis.h"

enum {
    APART_UM = 500000, /* distance of the scans that are kept */
    APART_BAM = 500 * ALE_BAM_PER_MRAD,
    OFFSET_UM = 250000, /* gate of a line that lies on a wall: odometry drifts */
    ANGLE_URAD = 200000,
    SIGMAS = 1000
};

static const ale_pose_t here = {0, 0, 0};

void ale_trail_clear(ale_trail_t *trail)
{
    trail->count = 0;
    trail->newest = 0;
}

void ale_trail_follow(ale_trail_t *trail, ale_pose_t displacement)
{
    for (uint32_t i = 0; i < trail->count; i++) {
        trail->scan[i].from = ale_pose_between(displacement, trail->scan[i].from);
    }
}

static bool is_newest_near(const ale_trail_t *trail)
{
    const uint32_t before = (trail->newest + ALE_TRAIL_SCANS - 1) % ALE_TRAIL_SCANS;
    return trail->count > 1 && ale_are_near(trail->scan[before].from, here, APART_UM, APART_BAM);
}

void ale_trail_keep(ale_trail_t *trail, const ale_observation_t observation[], uint32_t count)
{
    if (!is_newest_near(trail)) {
        trail->newest = trail->count > 0 ? (trail->newest + 1) % ALE_TRAIL_SCANS : 0;
        trail->count = (uint32_t)ale_min64(trail->count + 1, ALE_TRAIL_SCANS);
    }
    ale_trail_scan_t *scan = &trail->scan[trail->newest];
    memcpy(scan->observation, observation, count * sizeof observation[0]);
    scan->count = count;
    scan->from = here;
}

const ale_trail_scan_t *ale_trail_newest(const ale_trail_t *trail)
{
    return &trail->scan[trail->newest];
}

int32_t ale_trail_explained_q8(const ale_trail_t *trail, const ale_local_map_t *map, ale_pose_t pose,
                               int32_t *work)
{
    const ale_gate_t gate = {OFFSET_UM, ANGLE_URAD, SIGMAS, 0};
    int64_t score_um = 0;
    int64_t shown_um = 0;
    for (uint32_t i = 0; i < trail->count; i++) {
        const ale_trail_scan_t *scan = &trail->scan[i];
        if (i == trail->newest) {
            continue;
        }
        const ale_hypothesis_t h = ale_hypothesis_at(map, scan->observation, scan->count,
                                                     ale_pose_compose(pose, scan->from), &gate, work);
        if (*work <= 0) {
            break;
        }
        score_um += h.score_um;
        shown_um += h.shown_um;
    }
    return shown_um > 0 ? (int32_t)(score_um * 256 / shown_um) : 256;
}
