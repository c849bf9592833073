#include "lcm/vouch.h"

#include <lcmtypes_ale_vouched_t.h>

#include "command/vouched.h"

void ale_vouch_pose(ale_vouch_t *vouch, int32_t scan, const uint8_t *bytes, size_t count)
{
    const uint64_t slot = vouch->sent++ % ALE_VOUCHED_POSES;
    vouch->pose_scan[slot] = scan;
    vouch->pose_digest[slot] = ale_digest(bytes, count);
}

int ale_vouch_encode(ale_vouch_t *vouch, const lcmtypes_ale_status_t *status, uint8_t *bytes, int capacity)
{
    const ale_public_key_t half = ale_public_half(vouch->key);
    lcmtypes_ale_vouched_t message = {
        .utime = status->utime,
        .key = ale_vouched_key(&half),
        .boot = status->boot,
        .counter = ++vouch->counter,
        .clock_ppm = vouch->clock_ppm,
        .status = *status,
        .num_poses = (int32_t)(vouch->sent < ALE_VOUCHED_POSES ? vouch->sent : ALE_VOUCHED_POSES),
        .pose_scan = vouch->pose_scan,
        .pose_digest = vouch->pose_digest,
    };
    const int count = lcmtypes_ale_vouched_t_encode(bytes, 0, capacity, &message);
    if (count > 0) {
        ale_vouched_sign(vouch->key, bytes, (size_t)count);
    }
    return count;
}
