#include "operator/drive_arbiter.h"

#include <stdio.h>
#include <string.h>

const char *ale_drive_desk_holder(const ale_drive_desk_t *desk, int64_t now_us)
{
    return now_us < desk->held_until_us ? desk->holder : "";
}

ale_desk_answer_t ale_drive_desk_drive(ale_drive_desk_t *desk, const char *name, int32_t v_um_s,
                                       int32_t w_urad_s, int64_t now_us)
{
    const char *holder = ale_drive_desk_holder(desk, now_us);
    if (holder[0] != '\0' && strcmp(holder, name) != 0) {
        return ALE_DESK_TAKEN;
    }
    const bool paused = now_us - desk->asked_us >= ALE_DEAD_MAN_US;
    desk->asked_us = now_us;
    if (desk->stopped && !paused) {
        return ALE_DESK_STOPPED;
    }
    desk->stopped = false;
    snprintf(desk->holder, sizeof desk->holder, "%s", name);
    desk->held_until_us = now_us + ALE_DESK_HOLD_US;
    desk->wish =
        (ale_wish_t){.v_um_s = v_um_s, .w_urad_s = w_urad_s, .valid_until_us = now_us + ALE_DEAD_MAN_US};
    return ALE_DESK_HIS;
}

void ale_drive_desk_stop(ale_drive_desk_t *desk, int64_t now_us)
{
    *desk = (ale_drive_desk_t){.stopped = true, .asked_us = now_us};
}
