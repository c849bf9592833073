#include "track/zero_motion.h"

#include "observe/seen.h"

enum { LOOKS_MOST = 1 << 20 };

void ale_rest_clear(ale_rest_t *rest)
{
    rest->looks = 0;
}

void ale_rest_look(ale_rest_t *rest, ale_pose_t smooth)
{
    if (rest->looks == 0 || !ale_are_near(rest->at, smooth, ALE_REST_UM, ALE_REST_BAM)) {
        *rest = (ale_rest_t){smooth, 0};
    }
    rest->looks += rest->looks < LOOKS_MOST;
}

bool ale_rest_is_long(const ale_rest_t *rest)
{
    return rest->looks > ALE_REST_WHOLE;
}

uint32_t ale_rest_dilution(const ale_rest_t *rest)
{
    return ale_rest_is_long(rest) ? rest->looks / ALE_REST_WHOLE : 1;
}
