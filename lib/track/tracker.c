#include "track/tracker.h"

#include "base/fixed.h"

enum {
    MISFITS_UNTIL_LOST = 5,
    ENOUGH_SHOWN_UM = 1500000, /* walls a scan must show before their misfit means anything */
    FIT_PERCENT = 0,           /* of the length shown that must be found in the map */
    DETERMINED_UM = 30000,     /* the scan alone knows each direction better than this */
    WEAK_SIGMA_UM = 60000,     /* pose sigma above which it is weak whatever the scan shows */
    LOST_SIGMA_UM = 1000000,
    MAP_SIGMA_UM = 40000, /* pose sigmas up to which walls may be added */
    MAP_SIGMA_URAD = 25000
};

static int64_t square(int64_t v)
{
    return v * v;
}

static int64_t position_var(const ale_motion_t *m)
{
    return ale_max64(m->cov.m[0][0], m->cov.m[1][1]);
}

void ale_tracker_init(ale_tracker_t *tracker)
{
    *tracker = (ale_tracker_t){.state = ALE_STATE_GOOD};
}

static ale_state_t by_variance(const ale_motion_t *m)
{
    return position_var(m) > square(LOST_SIGMA_UM) ? ALE_STATE_LOST : ALE_STATE_WEAK;
}

ale_state_t ale_tracker_judge(ale_tracker_t *tracker, const ale_fit_t *fit)
{
    const bool enough = fit->shown_um >= ENOUGH_SHOWN_UM;
    const bool fits = fit->matched_um * 100 >= fit->shown_um * FIT_PERCENT;
    tracker->blind = 0;
    if (enough && !fits) {
        tracker->misfits++;
    } else if (fits && fit->matched > 1) {
        tracker->misfits = 0;
    }
    if (tracker->misfits >= MISFITS_UNTIL_LOST) {
        tracker->state = ALE_STATE_LOST;
    } else if (tracker->misfits == 0 && position_var(&fit->motion) < square(WEAK_SIGMA_UM) &&
               ale_information_determines(&fit->information, DETERMINED_UM)) {
        tracker->state = ALE_STATE_GOOD;
    } else {
        tracker->state = by_variance(&fit->motion);
    }
    return tracker->state;
}

ale_state_t ale_tracker_skip(ale_tracker_t *tracker, const ale_motion_t *predicted)
{
    tracker->blind++;
    if (tracker->state != ALE_STATE_LOST) {
        tracker->state = by_variance(predicted);
    }
    return tracker->state;
}

bool ale_tracker_may_map(const ale_tracker_t *tracker, const ale_fit_t *fit)
{
    return tracker->state != ALE_STATE_LOST && tracker->misfits == 0 &&
           position_var(&fit->motion) < square(MAP_SIGMA_UM) &&
           fit->motion.cov.m[2][2] < square(MAP_SIGMA_URAD);
}
