#include "track/step_track.h"

#include "match/observability.h"
#include "track/step_associate.h"
#include "track/step_filter.h"
#include "track/step_monitor.h"
#include "track/step_observe.h"
#include "track/step_recover.h"
#include "track/step_update.h"

enum {
    WAITS_MOST = 3,  /* scans in a row that wait for the next one */
    EVEN_US = 250000 /* a scan that comes later says nothing of a speed */
};

/* A scan that contradicts the last one leaves the prediction as it is; else what goes along with the robot is
 * left out, and the scan is the one that the next is compared with. True: it is. */
static bool filter(ale_pipeline_t *p, ale_scene_verdict_t verdict, const ale_prediction_t *prediction,
                   const ale_motion_t *predicted, ale_fit_t *fit)
{
    if (verdict == ALE_SCENE_CHANGED) {
        const ale_scene_t scene = ale_observed_scene(p);
        ale_register_reject(predicted, &scene, fit);
        return false;
    }
    if (verdict == ALE_SCENE_KNOWN) {
        ale_filter_attached(p, prediction->before.pose, fit);
    }
    return ale_filter_keep(p, prediction->before.pose, &fit->motion);
}

static bool is_speed_known(const ale_pipeline_t *p, const ale_prediction_t *prediction,
                           const ale_observability_t *observability)
{
    const int64_t dt_us = prediction->ways.believed.stamp_us - prediction->before.stamp_us;
    const bool even = dt_us <= EVEN_US && ale_timestamp_filter_accepts(&p->timestamp_filter, dt_us) &&
                      !p->monitor.contradicted;
    return observability->determined || (p->speed_known && even);
}

static ale_scene_verdict_t lose(ale_pipeline_t *p)
{
    ale_tracking_lose(&p->monitor);
    return ALE_SCENE_CHANGED;
}

/* What could be said of where the robot is, if this scan were to lose it. Scans that are waited for belong to
 * the same time unwatched; scans that were denied have watched something else than a drive. */
static ale_claim_t claim_of(const ale_pipeline_t *p, const ale_prediction_t *prediction)
{
    if (p->waited > 0) {
        return p->next_claim;
    }
    if (!ale_recover_is_unwatched(p, prediction)) {
        return ALE_CLAIM_NEAR;
    }
    if (p->monitor.misfits == 0 && p->driven) {
        return ALE_CLAIM_DRIVEN;
    }
    return ale_recover_may_be_anywhere(p, prediction) ? ALE_CLAIM_NONE : ALE_CLAIM_REACHED;
}

/* Whether *fit explains the scan, and no other pose does as well. */
static bool explains(ale_recovery_t recovery, const ale_fit_t *fit)
{
    return recovery == ALE_RECOVER_MOVED || recovery == ALE_RECOVER_FOLLOWED ||
           (recovery == ALE_RECOVER_CONFIRMED && !ale_tracking_doubts(fit));
}

/* Whether the next scan is waited for: wheels may be told of late after a gap, a pose that is proposed needs
 * to be confirmed, and of several poses that explain the scan one may turn out to be right. Not where wheels
 * have told of a way: it may have led to what the map does not hold, and then none of them is. */
static bool may_wait(const ale_pipeline_t *p, ale_recovery_t recovery, bool counted, bool driven)
{
    const bool several = recovery == ALE_RECOVER_OPEN;
    return p->waited < WAITS_MOST && (several ? !driven : counted || recovery == ALE_RECOVER_UNDECIDED);
}

/* Whether this scan speaks against the pose after a time that nobody watched: the map has changed, several
 * poses explain the scan, or this one does not and no wheels have told of a way. */
static bool is_refuted(ale_scene_verdict_t verdict, ale_recovery_t recovery, bool driven,
                       const ale_fit_t *fit)
{
    const bool unsure = ale_tracking_doubts(fit) && !driven;
    const bool others = recovery == ALE_RECOVER_OPEN || recovery == ALE_RECOVER_UNDECIDED;
    return recovery != ALE_RECOVER_CONFIRMED && (verdict == ALE_SCENE_CHANGED || others || unsure);
}

/* Another pose may be right, which the next scan must confirm. */
static ale_scene_verdict_t leave_open(ale_scene_verdict_t verdict)
{
    return verdict == ALE_SCENE_CHANGED ? verdict : ALE_SCENE_UNDECIDED;
}

/* What a scan that the prediction does not explain, or that nobody watched, comes to. */
static ale_scene_verdict_t recover(ale_pipeline_t *p, const ale_prediction_t *prediction,
                                   ale_scene_verdict_t verdict, ale_ways_t *ways, ale_fit_t *fit)
{
    const ale_recovery_t recovery = ale_step_recover(p, prediction, ways, fit);
    if (recovery == ALE_RECOVER_MOVED) {
        ale_tracking_found(&p->monitor);
    }
    if (explains(recovery, fit)) {
        p->monitor.contradicted = false;
        return ALE_SCENE_KNOWN;
    }
    if (ale_recover_is_unwatched(p, prediction) && is_refuted(verdict, recovery, p->driven, fit)) {
        p->waits = (uint8_t)(may_wait(p, recovery, ways->counted, p->driven) ? p->waited + 1 : 0);
        return p->waits > 0 ? ALE_SCENE_CHANGED : lose(p);
    }
    return recovery == ALE_RECOVER_UNDECIDED ? leave_open(verdict) : verdict;
}

/* A piece of a tile takes the time of the comparison with other poses: what the last scan has proposed stands
 * for the next. */
static ale_scene_verdict_t put_off(ale_pipeline_t *p, ale_scene_verdict_t verdict)
{
    p->proposal = p->proposed;
    return p->proposal.advantage_um > 0 ? leave_open(verdict) : verdict;
}

/* The scan is believed where the prediction has led to, or where else it fits better; after a time in which
 * nobody watched it must fit. */
static ale_scene_verdict_t judge(ale_pipeline_t *p, const ale_prediction_t *prediction, ale_ways_t *ways,
                                 ale_fit_t *fit)
{
    p->driven = ale_recover_has_driven(p, prediction);
    const ale_scene_verdict_t verdict = ale_step_monitor(p, prediction, ways->counted, fit);
    p->next_claim = claim_of(p, prediction);
    const bool unwatched = ale_recover_is_unwatched(p, prediction);
    const bool doubtful = unwatched || ale_tracking_doubts(fit) || verdict == ALE_SCENE_CHANGED;
    if (p->observed.count == 0 || !doubtful) {
        return verdict;
    }
    if (p->next_claim == ALE_CLAIM_NONE) {
        return lose(p);
    }
    if (p->tile_waits && !unwatched && p->waited == 0) {
        return put_off(p, verdict);
    }
    return recover(p, prediction, verdict, ways, fit);
}

/* What the walls tell of this scan that were there before nothing but the prediction told where the robot is:
 * where they determine every direction they confirm it. p->other: the fit by them alone. */
static void confirm_prediction(ale_pipeline_t *p, const ale_fit_t *fit)
{
    p->other = *fit;
    int64_t matched_um = 0;
    for (uint32_t i = 0; i < p->observed.count; i++) {
        ale_association_t *a = &p->other.association[i];
        a->landmark = ALE_NO_LANDMARK;
        if (a->wall != ALE_NO_WALL && p->map.wall[a->wall].born >= p->unconfirmed_from &&
            p->map.wall[a->wall].born != ALE_BORN_BEFORE) {
            a->wall = ALE_NO_WALL;
        }
        matched_um += a->wall == ALE_NO_WALL ? 0 : ale_observation_length_um(&p->observed.observation[i]);
    }
    const ale_observability_t told =
        ale_observability_of(&p->map, p->observed.observation, p->observed.count, &p->other);
    p->other.matched_um = matched_um;
    if (told.determined && ale_tracking_explains(&p->other)) {
        p->unconfirmed_from = 0;
    }
}

ale_tracked_t ale_step_track(ale_pipeline_t *p, const ale_prediction_t *prediction)
{
    ale_tracked_t tracked = {.slips = p->slips};
    ale_fit_t *fit = &tracked.fit;
    ale_ways_t ways = ale_step_associate(p, prediction, fit);
    ale_step_solve(p, fit);
    const ale_scene_verdict_t verdict = judge(p, prediction, &ways, fit);
    const bool changed = verdict == ALE_SCENE_CHANGED;
    tracked.kept = filter(p, verdict, prediction, &ways.believed, fit);

    const ale_scale_error_t scale_error = p->scale_error;
    const ale_observability_t observability =
        ale_observability_of(&p->map, p->still.observation, p->still.count, fit);
    ale_update_uncertainty(p, prediction, &ways, &observability, fit);
    tracked.undecided = verdict == ALE_SCENE_UNDECIDED;
    if ((p->unconfirmed_from != 0) && (verdict == ALE_SCENE_KNOWN)) {
        confirm_prediction(p, fit);
    }
    tracked.determined = observability.determined && !tracked.undecided && (p->unconfirmed_from == 0);
    tracked.speed_known = is_speed_known(p, prediction, &observability);
    if (observability.degenerate && tracked.speed_known && !ways.counted) {
        /* chance matches go along with the robot and would stop it; wheels outvote them */
        ale_motion_keep_along(&fit->motion, &ways.believed, observability.along_bam);
    }
    if (!changed) {
        ale_update_learn(p, prediction, &ways, &scale_error, fit);
        tracked.slips = ways.part ? ale_ways_slip(&ways, fit->motion.pose, p->slips) : p->slips;
    }
    ale_stage_end(&p->hook, ALE_STAGE_MATCH);

    ale_update_reanchor(p, fit);
    const bool good = p->monitor.state == ALE_STATE_GOOD && !changed;
    ale_filter_newcomers(p, prediction->before.pose, good, fit);
    tracked.matched_corners = ale_update_map(p, fit, !changed && ale_tracking_may_map(&p->monitor, fit));
    const ale_visibility_counts_t counts = ale_update_decay(p, fit->motion.pose);
    ale_monitor_judge(p, fit, &counts);
    return tracked;
}

ale_tracked_t ale_step_track_first(ale_pipeline_t *p)
{
    ale_tracked_t tracked = {.determined = p->determined, .speed_known = p->speed_known};
    ale_pipeline_fit(p, &p->motion, p->observed.scan.range_max_um, &tracked.fit);
    tracked.fit.motion = p->motion;
    ale_stage_end(&p->hook, ALE_STAGE_MATCH);
    tracked.matched_corners = ale_update_map(p, &tracked.fit, true);
    return tracked;
}
