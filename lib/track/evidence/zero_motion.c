#include "track/evidence/zero_motion.h"

#include "observe/seen.h"

enum { LOOKS_MOST = 1 << 20 };

void ale_zero_motion_clear(ale_zero_motion_t *zero_motion)
{
    zero_motion->scans = 0;
}

void ale_zero_motion_update(ale_zero_motion_t *zero_motion, ale_pose_t smooth)
{
    if (zero_motion->scans == 0 ||
        !ale_are_near(zero_motion->at, smooth, ALE_ZERO_MOTION_UM, ALE_ZERO_MOTION_BAM)) {
        *zero_motion = (ale_zero_motion_t){smooth, 0};
    }
    zero_motion->scans += zero_motion->scans < LOOKS_MOST;
}

bool ale_zero_motion_is_long(const ale_zero_motion_t *zero_motion)
{
    return zero_motion->scans > ALE_ZERO_MOTION_WHOLE;
}

uint32_t ale_zero_motion_dilution(const ale_zero_motion_t *zero_motion)
{
    return ale_zero_motion_is_long(zero_motion) ? zero_motion->scans / ALE_ZERO_MOTION_WHOLE : 1;
}
