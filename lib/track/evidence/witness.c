#include "track/evidence/witness.h"

#include <string.h>

#include "base/fixed.h"
#include "base/trig.h"
#include "map/wall.h"

enum {
    CLOSE_UM = 500000,
    CLOSE_BAM = 25 * ALE_BAM_PER_DEGREE,
    ASKED_MOST = 32 /* surfaces of either scan; of more an even choice */
};

void ale_witness_clear(ale_witness_t *witness)
{
    witness->observation_count = 0;
}

void ale_witness_keep(ale_witness_t *witness, const ale_seen_t *seen)
{
    ale_seen_copy(&witness->seen, seen);
    witness->observation_count = seen->observation_count;
    memcpy(witness->observation, seen->observation, seen->observation_count * sizeof witness->observation[0]);
}

void ale_witness_stand(ale_witness_t *witness, ale_pose_t robot, ale_pose_t sensor)
{
    witness->seen.robot = robot;
    witness->seen.sensor = sensor;
}

ale_seen_t ale_witness_seen(const ale_witness_t *witness)
{
    return (ale_seen_t){ale_seen_copy_posed(&witness->seen), witness->seen.robot, witness->observation,
                        witness->observation_count};
}

/* What a scan says of the surfaces of another one. Spots have no side from which they are seen. */
static void ask(const ale_seen_t *of, const ale_seen_t *asked, ale_slack_t slack, ale_testimony_t *sum)
{
    const ale_viewpoint_t viewpoint = ale_viewpoint(of->robot);
    for (uint32_t i = 0; i < of->observation_count; i++) {
        if (of->observation[i].kind == ALE_OBSERVATION_POINT ||
            !ale_is_chosen(i, of->observation_count, ASKED_MOST)) {
            continue;
        }
        const ale_observation_t moved = ale_observation_from(&of->observation[i], &viewpoint);
        const int64_t length_um = ale_observation_length_um(&moved);
        ale_wall_t surface;
        ale_wall_from_observation(&surface, &moved);
        const ale_points_visibility_t visibility = ale_wall_points_visibility(&surface, &asked->posed, slack);
        sum->shown_um += length_um;
        sum->confirmed_um += length_um * visibility.supported / ALE_VISIBILITY_POINTS;
        sum->denied_um += length_um * visibility.violated / ALE_VISIBILITY_POINTS;
    }
}

ale_testimony_t ale_witness_hear(const ale_witness_t *witness, const ale_seen_t *seen, ale_slack_t slack)
{
    const ale_seen_t before = ale_witness_seen(witness);
    ale_testimony_t sum = {0, 0, 0, false};
    if (witness->observation_count > 0) {
        sum.close = ale_are_near(before.robot, seen->robot, CLOSE_UM, CLOSE_BAM);
        ask(seen, &before, slack, &sum);
        ask(&before, seen, slack, &sum);
    }
    return sum;
}
