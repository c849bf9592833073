#include "track/witness.h"

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
    witness->view_count = 0;
}

void ale_witness_keep(ale_witness_t *witness, const ale_seen_t *seen)
{
    ale_seen_copy(&witness->seen, seen);
    witness->view_count = seen->view_count;
    memcpy(witness->view, seen->view, seen->view_count * sizeof witness->view[0]);
}

void ale_witness_stand(ale_witness_t *witness, ale_pose_t robot, ale_pose_t sensor)
{
    witness->seen.robot = robot;
    witness->seen.sensor = sensor;
}

ale_seen_t ale_witness_seen(const ale_witness_t *witness)
{
    const ale_seen_copy_t *then = &witness->seen;
    return (ale_seen_t){&then->scan,  ale_seen_bearings(then), then->robot,
                        then->sensor, witness->view,           witness->view_count};
}

/* What a scan says of the surfaces of another one. Spots have no side from which they are seen. */
static void ask(const ale_seen_t *of, const ale_seen_t *asked, ale_slack_t slack, ale_testimony_t *sum)
{
    const ale_stand_t stand = ale_stand(of->robot);
    for (uint32_t i = 0; i < of->view_count; i++) {
        if (of->view[i].kind == ALE_VIEW_SPOT || !ale_is_chosen(i, of->view_count, ASKED_MOST)) {
            continue;
        }
        const ale_view_t moved = ale_view_from(&of->view[i], &stand);
        const int64_t length_um = ale_view_length_um(&moved);
        ale_wall_t surface;
        ale_wall_from_view(&surface, &moved);
        const ale_points_sight_t sight =
            ale_wall_points_sight(&surface, asked->scan, asked->bearing_bam, asked->sensor, slack);
        sum->shown_um += length_um;
        sum->confirmed_um += length_um * sight.supported / ALE_SIGHT_POINTS;
        sum->denied_um += length_um * sight.through / ALE_SIGHT_POINTS;
    }
}

ale_testimony_t ale_witness_hear(const ale_witness_t *witness, const ale_seen_t *seen, ale_slack_t slack)
{
    const ale_seen_t before = ale_witness_seen(witness);
    ale_testimony_t sum = {0, 0, 0, false};
    if (witness->view_count > 0) {
        sum.close = ale_are_near(before.robot, seen->robot, CLOSE_UM, CLOSE_BAM);
        ask(seen, &before, slack, &sum);
        ask(&before, seen, slack, &sum);
    }
    return sum;
}
