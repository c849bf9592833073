#include "track/tracking_monitor.h"

#include "base/fixed.h"

enum {
    MISFITS_UNTIL_LOST = 8,
    VIOLATED_LEAST = 3,        /* walls seen through that make a contradiction, if they also are */
    VIOLATED_TO_FOUND = 2,     /* so many times those that are where they should be */
    DOUBT_PERCENT = 60,        /* of what is shown is found in the map: no question; */
    STRANGE_PERCENT = 35,      /* less than this is found: has the scene changed? */
    DENIED_LEAST_UM = 1000000, /* surfaces that must be gone before a change is called one, */
    SHOWN_LEAST_UM = 2000000,  /* two scans that show less of each other than this cannot be compared */
    DENIED_PERCENT = 20,       /* and the part of all that both scans looked at, */
    UNWATCHED_PERCENT = 5,     /* or this one where nothing was seen of the way between them */
    CONFIRM_PERCENT = 20,      /* two scans confirm this much of each other at the least, */
    CLOSE_PERCENT = 45,  /* this much when taken side by side, or nothing was seen of the way between, */
    EMPTY_LEAST = 2,     /* as in so many scans that showed nothing, */
    MISFIT_PERCENT = 10, /* and this much more if there was doubt before */
    BELIEVE_SHOWN_UM = 2500000,
    BELIEVE_WALLS = 4,
    BELIEVE_PERCENT = 70,
    EXPECT_PERCENT = 80,   /* where the robot is said to be, whatever the number of walls */
    WEAK_SIGMA_UM = 60000, /* pose sigma above which it is weak whatever the scan shows */
    LOST_SIGMA_UM = 1000000,
    MAP_SIGMA_UM = 40000, /* pose sigmas up to which walls may be added */
    MAP_SIGMA_URAD = 25000,
    ANCHOR_SIGMA_URAD = 150000, /* and that of the heading up to which walls not found were not there: */
                                /* of two sigmas off they would still be matched */
    ANCHOR_SHOWN_UM = 1500000   /* surfaces that the next scan will find again */
};

static int64_t square(int64_t v)
{
    return v * v;
}

static int64_t position_var(const ale_motion_t *m)
{
    return ale_max64(m->cov.m[0][0], m->cov.m[1][1]);
}

void ale_tracking_init(ale_tracking_monitor_t *monitor)
{
    *monitor = (ale_tracking_monitor_t){.state = ALE_STATE_GOOD};
}

static ale_state_t by_variance(const ale_motion_t *m)
{
    return position_var(m) > square(LOST_SIGMA_UM) ? ALE_STATE_LOST : ALE_STATE_WEAK;
}

static bool contradicts(const ale_fit_t *fit, const ale_visibility_counts_t *visibility)
{
    const uint32_t found = (uint32_t)fit->matched + visibility->supported;
    return visibility->violated >= VIOLATED_LEAST && visibility->violated > VIOLATED_TO_FOUND * found;
}

bool ale_tracking_doubts(const ale_fit_t *fit)
{
    return fit->matched_um * 100 < fit->shown_um * DOUBT_PERCENT;
}

bool ale_tracking_is_strange(const ale_tracking_monitor_t *monitor, const ale_fit_t *fit)
{
    const int64_t percent = monitor->misfits > 0 ? BELIEVE_PERCENT : STRANGE_PERCENT;
    return fit->matched_um * 100 < fit->shown_um * percent;
}

/* What the robot did since the last scan that showed anything was not seen: only the wheels measured it. */
static bool is_unwatched(const ale_tracking_monitor_t *monitor)
{
    return monitor->empty_scans >= EMPTY_LEAST;
}

static bool confirms(const ale_testimony_t *testimony, int64_t percent)
{
    return testimony->confirmed_um * 100 >= testimony->shown_um * percent;
}

/* Once a scan did not fit, the next must be confirmed, not only not denied. */
static bool is_confirmed(const ale_tracking_monitor_t *monitor, const ale_testimony_t *testimony)
{
    const bool much = testimony->close || is_unwatched(monitor);
    const int64_t percent =
        (much ? CLOSE_PERCENT : CONFIRM_PERCENT) + (monitor->misfits > 0 ? MISFIT_PERCENT : 0);
    return confirms(testimony, percent);
}

/* Without wheels nobody knows where the robot went while a scan did not fit: only the map can say. */
static bool is_adrift(const ale_tracking_monitor_t *monitor, bool counted)
{
    return monitor->misfits > 0 && !counted;
}

static bool denies(const ale_testimony_t *testimony, int64_t percent)
{
    const int64_t compared_um = testimony->denied_um + testimony->confirmed_um;
    return testimony->denied_um > DENIED_LEAST_UM && testimony->denied_um * 100 > compared_um * percent;
}

bool ale_tracking_denies(const ale_testimony_t *testimony)
{
    return denies(testimony, UNWATCHED_PERCENT);
}

bool ale_tracking_denies_step(const ale_testimony_t *testimony)
{
    return denies(testimony, DENIED_PERCENT);
}

bool ale_tracking_witnesses(const ale_testimony_t *testimony)
{
    return testimony->shown_um > SHOWN_LEAST_UM && confirms(testimony, CLOSE_PERCENT);
}

void ale_tracking_notice(ale_tracking_monitor_t *monitor, const ale_testimony_t *testimony, bool counted,
                         bool mapped)
{
    const bool denied =
        testimony && denies(testimony, is_unwatched(monitor) ? UNWATCHED_PERCENT : DENIED_PERCENT);
    monitor->in_reach = counted || !mapped;
    monitor->contradicted_nearby =
        monitor->misfits > 0 ? monitor->contradicted_nearby : testimony && testimony->close;
    monitor->contradicted = testimony && testimony->shown_um > SHOWN_LEAST_UM &&
                            (denied || !is_confirmed(monitor, testimony) || is_adrift(monitor, counted));
}

static bool is_undisturbed(const ale_tracking_monitor_t *monitor)
{
    return monitor->state != ALE_STATE_LOST && monitor->misfits == 0 && !monitor->contradicted;
}

static bool is_well_known(const ale_motion_t *m)
{
    return position_var(m) < square(MAP_SIGMA_UM) && m->cov.m[2][2] < square(MAP_SIGMA_URAD);
}

/* A scan shows enough, but without wheels the heading is so uncertain that not finding it in the map says
 * nothing: the robot may be in the midst of what the map holds. */
static bool is_out_of_reach(const ale_tracking_monitor_t *monitor, const ale_fit_t *fit)
{
    return is_undisturbed(monitor) && !monitor->in_reach && fit->shown_um > ANCHOR_SHOWN_UM &&
           fit->motion.cov.m[2][2] >= square(ANCHOR_SIGMA_URAD);
}

/* Scans that showed nothing count until one is believed to be where the pose says. */
static void count_empty_scans(ale_tracking_monitor_t *monitor, const ale_fit_t *fit)
{
    if (fit->shown_um == 0) {
        monitor->empty_scans = (uint16_t)ale_min64(monitor->empty_scans + 1, EMPTY_LEAST);
    } else if (!monitor->contradicted) {
        monitor->empty_scans = 0;
    }
}

ale_state_t ale_tracking_judge(ale_tracking_monitor_t *monitor, const ale_fit_t *fit,
                               const ale_visibility_counts_t *visibility, bool proposed)
{
    const bool out_of_reach = is_out_of_reach(monitor, fit);
    count_empty_scans(monitor, fit);
    if (monitor->contradicted || contradicts(fit, visibility)) {
        monitor->misfits++;
    } else if (monitor->misfits > 0) {
        monitor->misfits--;
    }
    if (monitor->misfits >= MISFITS_UNTIL_LOST || (out_of_reach && !proposed)) {
        monitor->state = ALE_STATE_LOST;
    } else if (position_var(&fit->motion) < square(WEAK_SIGMA_UM) &&
               ale_information_determines(&fit->information, ALE_DETERMINED_UM)) {
        monitor->state = ALE_STATE_GOOD;
    } else {
        monitor->state = proposed ? ALE_STATE_WEAK : by_variance(&fit->motion);
    }
    return monitor->state;
}

bool ale_tracking_explains(const ale_fit_t *fit)
{
    return fit->shown_um >= BELIEVE_SHOWN_UM && fit->matched_um * 100 >= fit->shown_um * BELIEVE_PERCENT;
}

bool ale_tracking_accepts(const ale_fit_t *fit)
{
    return fit->matched >= BELIEVE_WALLS && ale_tracking_explains(fit);
}

bool ale_tracking_confirms(const ale_fit_t *fit)
{
    return fit->shown_um >= BELIEVE_SHOWN_UM && fit->matched_um * 100 >= fit->shown_um * EXPECT_PERCENT &&
           ale_information_determines(&fit->information, ALE_DETERMINED_UM);
}

void ale_tracking_found(ale_tracking_monitor_t *monitor)
{
    monitor->state = ALE_STATE_WEAK;
    monitor->misfits = MISFITS_UNTIL_LOST / 2; /* on probation */
    monitor->contradicted = false;
    monitor->empty_scans = 0;
}

void ale_tracking_lose(ale_tracking_monitor_t *monitor)
{
    monitor->misfits = MISFITS_UNTIL_LOST;
    monitor->contradicted = true;
}

ale_state_t ale_tracking_skip(ale_tracking_monitor_t *monitor, const ale_motion_t *predicted)
{
    if (monitor->state != ALE_STATE_LOST) {
        monitor->state = by_variance(predicted);
    }
    return monitor->state;
}

bool ale_tracking_may_map(const ale_tracking_monitor_t *monitor, const ale_fit_t *fit)
{
    return is_undisturbed(monitor) && is_well_known(&fit->motion);
}

bool ale_tracking_may_reanchor(const ale_tracking_monitor_t *monitor, const ale_fit_t *fit)
{
    return is_undisturbed(monitor) && !is_well_known(&fit->motion) && !is_out_of_reach(monitor, fit) &&
           fit->shown_um > ANCHOR_SHOWN_UM;
}
