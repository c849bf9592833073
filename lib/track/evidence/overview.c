#include "track/evidence/overview.h"

#include <string.h>

#include "base/trig.h"

enum { KEPT_US = 2000000, KEPT_UM = 500000, KEPT_BAM = 500 * ALE_BAM_PER_MRAD, RICHER = 2 };

void ale_overview_clear(ale_overview_t *overview)
{
    overview->observation_count = 0;
    overview->shown_um = 0;
}

void ale_overview_keep(ale_overview_t *overview, const ale_seen_t *seen, int64_t stamp_us)
{
    const bool stale = stamp_us - overview->stamp_us > KEPT_US ||
                       !ale_are_near(overview->robot, seen->robot, KEPT_UM, KEPT_BAM);
    if (!stale && ale_overview_is_richer(overview, seen->observation, seen->observation_count)) {
        return;
    }
    memcpy(overview->observation, seen->observation,
           seen->observation_count * sizeof overview->observation[0]);
    overview->observation_count = seen->observation_count;
    overview->shown_um = ale_observations_length_um(seen->observation, seen->observation_count);
    overview->stamp_us = stamp_us;
    overview->robot = seen->robot;
}

void ale_overview_stand(ale_overview_t *overview, int64_t stamp_us, ale_pose_t robot)
{
    if (overview->stamp_us == stamp_us) {
        overview->robot = robot;
    }
}

bool ale_overview_is_richer(const ale_overview_t *overview, const ale_observation_t observation[],
                            uint32_t count)
{
    return overview->shown_um > RICHER * ale_observations_length_um(observation, count);
}
