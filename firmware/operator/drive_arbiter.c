#include "operator/drive_arbiter.h"

#include <stdio.h>
#include <string.h>

const char *ale_drive_arbiter_holder(const ale_drive_arbiter_t *arbiter, int64_t now_us)
{
    return now_us < arbiter->held_until_us ? arbiter->holder : "";
}

ale_arbiter_answer_t ale_drive_arbiter_drive(ale_drive_arbiter_t *arbiter, const char *name, int32_t v_um_s,
                                             int32_t w_urad_s, int64_t now_us)
{
    const char *holder = ale_drive_arbiter_holder(arbiter, now_us);
    if (holder[0] != '\0' && strcmp(holder, name) != 0) {
        return ALE_ARBITER_TAKEN;
    }
    const bool paused = now_us - arbiter->asked_us >= ALE_DEAD_MAN_US;
    arbiter->asked_us = now_us;
    if (arbiter->stopped && !paused) {
        return ALE_ARBITER_STOPPED;
    }
    arbiter->stopped = false;
    snprintf(arbiter->holder, sizeof arbiter->holder, "%s", name);
    arbiter->held_until_us = now_us + ALE_ARBITER_HOLD_US;
    arbiter->request = (ale_velocity_request_t){
        .v_um_s = v_um_s, .w_urad_s = w_urad_s, .valid_until_us = now_us + ALE_DEAD_MAN_US};
    return ALE_ARBITER_GRANTED;
}

void ale_drive_arbiter_stop(ale_drive_arbiter_t *arbiter, int64_t now_us)
{
    *arbiter = (ale_drive_arbiter_t){.stopped = true, .asked_us = now_us};
}
