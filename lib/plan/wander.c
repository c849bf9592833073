#include "plan/wander.h"

#include "base/fixed.h"
#include "plan/safe_speed.h"

/* Counted in scans, ten a second. */
enum { STANDING_STEPS = 30, LONGEST_STEPS = 1800 };
#define ROUND_URAD_STEPS INT64_C(62831853) /* a turn, in tenths of a second */
enum { HALF = 2, CLOSED = 4 };             /* closed: where not a quarter of that speed is safe */

void ale_wander_begin(ale_wander_t *wander)
{
    *wander = (ale_wander_t){.steps = 0};
}

bool ale_wander_is_active(const ale_wander_t *wander)
{
    return wander->steps < LONGEST_STEPS;
}

/* It turns in one direction only: a robot that looks left and right in turn stays in a corner. */
static ale_velocity_t drive_about(ale_wander_t *wander, const ale_follower_t *follower,
                                  const ale_scan_t *scan)
{
    const int32_t wanted_um_s = follower->speed_um_s / HALF;
    const int32_t safe_um_s = ale_safe_speed_um_s(scan, &follower->sensor, &follower->shape, wanted_um_s, 0);
    wander->turning = wander->turning ? safe_um_s < wanted_um_s : safe_um_s < wanted_um_s / CLOSED;
    if (wander->turning) {
        return (ale_velocity_t){0, follower->turn_urad_s / HALF};
    }
    return (ale_velocity_t){safe_um_s, 0};
}

ale_velocity_t ale_wander_step(ale_wander_t *wander, const ale_follower_t *follower, const ale_scan_t *scan)
{
    const int64_t turn_urad_s = ale_max64(1, follower->turn_urad_s / HALF);
    const int64_t round_steps = ale_min64(ROUND_URAD_STEPS / turn_urad_s, LONGEST_STEPS);
    if (!ale_wander_is_active(wander)) {
        return (ale_velocity_t){0, 0};
    }
    wander->steps++;
    if (wander->steps <= STANDING_STEPS) {
        return (ale_velocity_t){0, 0};
    }
    if (wander->steps <= STANDING_STEPS + round_steps) {
        return (ale_velocity_t){0, (int32_t)turn_urad_s};
    }
    return drive_about(wander, follower, scan);
}
