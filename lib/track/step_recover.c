#include "track/step_recover.h"

#include "base/fixed.h"
#include "base/trig.h"
#include "match/pose_evidence.h"
#include "track/step_associate.h"
#include "track/step_filter.h"
#include "track/step_observe.h"

enum {
    UNWATCHED_US = 300000, /* without a scan that told the pose */
    ANYWHERE_US = 5000000, /* and for so long that it may have been carried to any place */
    ANYWHERE_PERIODS = 60,
    CANDIDATES = 4, /* poses that are fitted: those proposed, and places of the vote */
    START_SIGMA_UM = 150000,
    START_SIGMA_URAD = 60000,
    MARGIN_UM = 1500000, /* surface by which a pose must explain more than another one */
    OUTLIER_PARTS = 10,  /* of what the last scan confirms it may deny so small a part */
    CONFIRM_UM = 500000, /* the next scan finds it there, with what the robot has gone otherwise than told */
    SAME_UM = 300000,    /* poses nearer than this are one: least squares joins them */
    SAME_BAM = 200 * ALE_BAM_PER_MRAD,
    ANY_HEADING_URAD = 3141592,
    DRIFT_UM = 1500000
};

static const ale_gate_t start_gate = {300000, 200000, 6, 100000};

static int64_t since_watched_us(const ale_pipeline_t *p, const ale_prediction_t *prediction)
{
    return ale_max64(prediction->ways.believed.stamp_us - p->watched.stamp_us, prediction->dt_us);
}

bool ale_recover_may_be_anywhere(const ale_pipeline_t *p, const ale_prediction_t *prediction)
{
    const int64_t t_us = since_watched_us(p, prediction);
    const int64_t usual_us = p->timestamp_filter.usual_before_us;
    return t_us > ANYWHERE_US && usual_us > 0 && t_us > ANYWHERE_PERIODS * usual_us;
}

/* Whether wheels that may have told of a way have told of none but at the ends of the time unwatched: what
 * they count until the last scan before it, and from the first one after it, which may have been waited from,
 * is no way through it. In a dense log they may be told of late by the time from scan to scan. */
static bool has_stood(const ale_pipeline_t *p, const ale_prediction_t *prediction)
{
    const int64_t late_us =
        ale_timestamp_filter_is_dense(&p->timestamp_filter) ? p->timestamp_filter.usual_us : 0;
    const int64_t back_us = p->waited > 0 ? p->back_us : prediction->ways.believed.stamp_us;
    const int64_t from_us = p->watched.stamp_us + late_us - p->lag.lag_us;
    const int64_t to_us = back_us - late_us - p->lag.lag_us;
    const ale_pose_t nowhere = {0};
    ale_pose_t between;
    int32_t beyond_us;
    return (from_us < to_us) && ale_wheels_motion(&p->wheels, from_us, to_us, &between, &beyond_us) &&
           ale_are_near(nowhere, between, SAME_UM, SAME_BAM);
}

bool ale_recover_has_driven(const ale_pipeline_t *p, const ale_prediction_t *prediction)
{
    const ale_pose_t before = ale_witness_seen(&p->witness).robot;
    const ale_pose_t now =
        ale_pipeline_smooth_pose(p, prediction->before.pose, prediction->ways.believed.pose);
    return ale_recover_is_unwatched(p, prediction) && prediction->ways.counted &&
           !ale_are_near(before, now, SAME_UM, SAME_BAM) && !has_stood(p, prediction);
}

bool ale_recover_is_unwatched(const ale_pipeline_t *p, const ale_prediction_t *prediction)
{
    const int64_t t_us = since_watched_us(p, prediction);
    return t_us > UNWATCHED_US && ale_pipeline_is_gap(p, t_us);
}

static int32_t halfway(int32_t from_um, int32_t to_um)
{
    return (int32_t)(from_um + ((int64_t)to_um - from_um) / 2);
}

/* All that the robot can have reached since it was last watched. A prediction that it cannot have reached
 * says nothing of where that is. */
static ale_vote_region_t region_of(const ale_pipeline_t *p, const ale_prediction_t *prediction)
{
    const int64_t t_ms = ale_min64(since_watched_us(p, prediction) / 1000, 1000000);
    const int64_t way_um = t_ms * p->config.max_speed_mm_s + SAME_UM;
    const int64_t turn_urad = t_ms * p->config.max_turn_mrad_s + (int64_t)2 * START_SIGMA_URAD;
    const ale_pose_t from = prediction->before.pose;
    const ale_pose_t predicted = prediction->ways.believed.pose;
    const ale_apart_t told = ale_apart(from, predicted);
    const bool possible = told.way_um <= way_um && told.turn_urad <= turn_urad;
    const ale_pose_t to = possible ? predicted : from;
    return (ale_vote_region_t){
        .centre = {halfway(from.x_um, to.x_um), halfway(from.y_um, to.y_um), to.theta_bam},
        .reach_um = (int32_t)ale_min64(way_um, ALE_VOTE_REACH_UM),
        .reach_urad = (int32_t)ale_min64(turn_urad, ANY_HEADING_URAD)};
}

/* A fit and what speaks for it. */
typedef struct {
    ale_fit_t *fit;
    int64_t evidence_um;
    bool heard; /* the last scan has been asked */
    ale_testimony_t testimony;
} candidate_t;

static int64_t evidence_um(ale_pipeline_t *p, const ale_fit_t *fit)
{
    const ale_scene_t scene = ale_observed_scene(p);
    const ale_posed_scan_t from = {&p->observed.scan, ale_observed_bearings(&p->observed),
                                   ale_pose_compose(fit->motion.pose, p->config.sensor)};
    return ale_pose_evidence_um(&scene, fit, &from);
}

static ale_motion_t start_at(const ale_motion_t *predicted, ale_pose_t pose)
{
    ale_motion_t start = *predicted;
    start.pose = pose;
    ale_motion_widen(&start, START_SIGMA_UM, START_SIGMA_URAD);
    return start;
}

static bool is_same(const ale_fit_t *a, const ale_fit_t *b)
{
    return ale_are_near(a->motion.pose, b->motion.pose, SAME_UM, SAME_BAM);
}

/* Least squares may have left the region. */
static bool is_in_region(const ale_vote_region_t *region, ale_pose_t pose)
{
    const int64_t most_um = (int64_t)region->reach_um + SAME_UM;
    return ale_abs64((int64_t)pose.x_um - region->centre.x_um) < most_um &&
           ale_abs64((int64_t)pose.y_um - region->centre.y_um) < most_um;
}

/* Takes a candidate in: *best is the one that explains most; returns what the best of those apart from it
 * explains, which was `rival_um`. */
static int64_t compare(candidate_t *best, const candidate_t *candidate, int64_t rival_um)
{
    const bool same = is_same(candidate->fit, best->fit);
    if (candidate->evidence_um <= best->evidence_um) {
        return same ? rival_um : ale_max64(rival_um, candidate->evidence_um);
    }
    rival_um = same ? rival_um : ale_max64(rival_um, best->evidence_um);
    *best->fit = *candidate->fit;
    best->evidence_um = candidate->evidence_um;
    return rival_um;
}

/* Fits from a pose, and takes in what is found within the region; returns as compare(). */
static int64_t compare_from(ale_pipeline_t *p, const ale_motion_t *predicted, ale_pose_t pose,
                            const ale_vote_region_t *region, candidate_t *best, int64_t rival_um)
{
    const ale_scene_t scene = ale_observed_scene(p);
    const ale_motion_t start = start_at(predicted, pose);
    ale_register_pose(&start, &scene, &start_gate, &p->other);
    ale_register_associate(&scene, &p->other);
    int64_t explained_um = rival_um;
    if (is_in_region(region, p->other.motion.pose)) {
        const candidate_t candidate = {.fit = &p->other, .evidence_um = evidence_um(p, &p->other)};
        explained_um = compare(best, &candidate, rival_um);
    }
    return explained_um;
}

/* The same of a pose that was proposed, and stays within that. */
static int64_t compare_again(ale_pipeline_t *p, const ale_motion_t *predicted, ale_pose_t pose,
                             candidate_t *best, int64_t rival_um)
{
    ale_vote_region_t around = {.reach_um = SAME_UM};
    around.centre = pose;
    return compare_from(p, predicted, pose, &around, best, rival_um);
}

/* Fits what the scan before has proposed, where it was found and where the prediction has led it, and the
 * best places of the vote on the region, and takes them in. */
static int64_t compare_region(ale_pipeline_t *p, const ale_motion_t *predicted,
                              const ale_vote_region_t *region, const ale_proposal_t *proposed,
                              candidate_t *best)
{
    int64_t rival_um = INT64_MIN / 2;
    uint32_t again = 0;
    ale_pipeline_approach(p, region->centre, p->observed.scan.range_max_um);
    ale_pose_vote(&p->vote, &p->map, p->observed.observation, p->observed.count, region);
    if (proposed->advantage_um > 0) {
        rival_um = compare_again(p, predicted, proposed->found, best, rival_um);
        again++;
        if (!ale_are_near(proposed->found, proposed->pose, SAME_UM, SAME_BAM)) {
            rival_um = compare_again(p, predicted, proposed->pose, best, rival_um);
            again++;
        }
    }
    for (uint32_t k = 0; k + again < CANDIDATES && k < p->vote.places; k++) {
        rival_um = compare_from(p, predicted, p->vote.place[k].pose, region, best, rival_um);
    }
    return rival_um;
}

bool ale_recover_in_region(ale_pipeline_t *p, ale_pose_t centre)
{
    const ale_vote_region_t region = {centre, ALE_VOTE_REACH_UM, ANY_HEADING_URAD};
    candidate_t best = {.fit = &p->best, .evidence_um = INT64_MIN / 2};
    const ale_scene_t scene = ale_observed_scene(p);
    ale_register_reject(&p->motion, &scene, &p->best);
    const ale_proposal_t none = {.advantage_um = 0};
    const int64_t rival_um = compare_region(p, &p->motion, &region, &none, &best);
    if (!ale_tracking_accepts(&p->best) || best.evidence_um < rival_um + MARGIN_UM) {
        return false;
    }
    ale_register_weigh(&scene, &p->best);
    return true;
}

/* The pose of *best takes the place of what the prediction has led to. */
static void take(ale_pipeline_t *p, const candidate_t *best, ale_ways_t *ways, ale_fit_t *fit)
{
    const ale_scene_t scene = ale_observed_scene(p);
    ways->believed = start_at(&ways->believed, best->fit->motion.pose);
    ways->counted = false;
    *fit = *best->fit;
    ale_register_weigh(&scene, fit);
}

/* What the last scan says of a pose: asked once. */
static const ale_testimony_t *hear(const ale_pipeline_t *p, ale_pose_t before, candidate_t *candidate)
{
    if (!candidate->heard) {
        candidate->heard = true;
        candidate->testimony = ale_step_testimony(p, before, candidate->fit->motion.pose);
    }
    return &candidate->testimony;
}

/* What it says for that, half for the surfaces of either scan. */
static int64_t heard_um(const ale_pipeline_t *p, ale_pose_t before, candidate_t *candidate)
{
    const ale_testimony_t *heard = hear(p, before, candidate);
    return (heard->confirmed_um - heard->denied_um) / 2;
}

/* By how much more surface it speaks for a pose than for the given one. */
static int64_t heard_more_um(const ale_pipeline_t *p, ale_pose_t before, candidate_t *best,
                             candidate_t *given)
{
    return heard_um(p, before, best) - heard_um(p, before, given);
}

/* Whether the last scan has seen that the robot went there: it confirms much of that pose and denies none of
 * it but outliers; it denies the given one; and it speaks for this one by clearly more surface. Of a log that
 * holds but some of the scans: where they come one upon the other the next one tells, and shows nothing new.
 */
static bool is_seen_there(const ale_pipeline_t *p, ale_pose_t before, candidate_t *best, candidate_t *given)
{
    if (ale_timestamp_filter_is_dense(&p->timestamp_filter) || !ale_tracking_denies(hear(p, before, given))) {
        return false;
    }
    const ale_testimony_t *there = hear(p, before, best);
    const int64_t outliers_um = there->confirmed_um / OUTLIER_PARTS;
    return ale_tracking_witnesses(there) && (there->denied_um <= outliers_um) &&
           (heard_more_um(p, before, best, given) > MARGIN_UM);
}

/* How much surface the last scan weighs for a pose against the given one. Where the map ends it knows what
 * the map does not hold: without it a place like this one, but mapped, would explain more. It weighs for a
 * pose only where it has seen the robot go there: of one nearer to where it was taken it has always seen
 * more. Nor does it weigh against one so near that the robot may have drifted from it since long before: then
 * the last scan has drifted, too. seen: is_seen_there(). */
static int64_t last_scan_um(const ale_pipeline_t *p, ale_pose_t before, candidate_t *best, candidate_t *given,
                            bool seen)
{
    const bool near =
        !seen && ale_are_near(best->fit->motion.pose, given->fit->motion.pose, DRIFT_UM, SAME_BAM);
    const int64_t more_um = near ? 0 : heard_more_um(p, before, best, given);
    return seen ? more_um : ale_min64(more_um, 0);
}

/* Whether anything but the map tells that the robot is there after a time that nobody watched: that is where
 * the prediction has led, wheels have told of a way, or the last scan before confirms what is seen from
 * there. The map alone does not: a place that it does not hold may look like one that it does. */
static bool is_told(const ale_pipeline_t *p, const ale_prediction_t *prediction, candidate_t *candidate)
{
    return p->driven || !ale_recover_is_unwatched(p, prediction) ||
           ale_are_near(prediction->ways.believed.pose, candidate->fit->motion.pose, SAME_UM, SAME_BAM) ||
           ale_tracking_witnesses(hear(p, prediction->before.pose, candidate));
}

/* Whether wheels and the last scan agree on the given pose. A log that holds but some of the scans has one
 * after each so much of a way, however long that took: of such a step the last scan has seen both ends. */
static bool is_step_witnessed(const ale_pipeline_t *p, const ale_prediction_t *prediction, candidate_t *given)
{
    return p->driven && !ale_timestamp_filter_is_dense(&p->timestamp_filter) &&
           !ale_tracking_denies_step(hear(p, prediction->before.pose, given));
}

/* Whether wheels that have told of a way deny the pose. They may have led to what the map does not hold, and
 * such ground may look like a place that it does. */
static bool is_denied(const ale_pipeline_t *p, const ale_motion_t *predicted, const candidate_t *best,
                      const candidate_t *given)
{
    return p->driven && !is_same(best->fit, given->fit) &&
           ale_pose_against_um(predicted, best->fit->motion.pose) >= ALE_EVIDENCE_AGAINST_UM;
}

/* By how much more surface, what the prediction weighs against it taken off, a pose explains than another. */
static int64_t gain_um(const ale_motion_t *predicted, const candidate_t *best, const candidate_t *given)
{
    return best->evidence_um - ale_pose_against_um(predicted, best->fit->motion.pose) - given->evidence_um +
           ale_pose_against_um(predicted, given->fit->motion.pose);
}

/* What the scan before has found for a pose, where it has proposed it; else 0. */
static int64_t proposed_um(const ale_pipeline_t *p, ale_pose_t pose)
{
    const bool again = ale_are_near(p->proposed.found, pose, CONFIRM_UM, SAME_BAM) ||
                       ale_are_near(p->proposed.pose, pose, CONFIRM_UM, SAME_BAM);
    return again ? p->proposed.advantage_um : 0;
}

/* A pose that explains clearly more than any other is taken where it is beside the given one, where the last
 * scan has seen the robot go, or where the scan before has proposed it; else it is proposed to the next.
 * seen: is_seen_there(). */
static ale_recovery_t take_or_propose(ale_pipeline_t *p, const ale_prediction_t *prediction,
                                      candidate_t *given, candidate_t *best, bool seen, ale_ways_t *ways)
{
    const ale_pose_t pose = best->fit->motion.pose;
    const bool followed = is_same(best->fit, given->fit) || seen;
    const int64_t before_um = proposed_um(p, pose);
    const int64_t seen_um = last_scan_um(p, prediction->before.pose, best, given, seen);
    const int64_t more_um = best->evidence_um - given->evidence_um + seen_um;
    const bool enough = before_um + gain_um(&ways->believed, best, given) + seen_um > MARGIN_UM;
    if (enough && (followed || before_um > 0) && is_told(p, prediction, best)) {
        take(p, best, ways, given->fit);
        return followed ? ALE_RECOVER_FOLLOWED : ALE_RECOVER_MOVED;
    }
    if (enough || more_um > MARGIN_UM) {
        p->proposal = (ale_proposal_t){pose, pose, before_um + ale_max64(more_um, 1)};
        return ALE_RECOVER_UNDECIDED;
    }
    return ALE_RECOVER_STAYS;
}

/* What comes of a pose that explains more than any other. Where the last scan has seen the robot go there, it
 * does not matter that wheels deny it, nor that the map holds but little of the scan: new ground comes into
 * view. Of a log that holds but some of the scans wheels may have told a part of the way alone, unless the
 * last scan agrees. */
static ale_recovery_t decide_on_best(ale_pipeline_t *p, const ale_prediction_t *prediction,
                                     candidate_t *given, candidate_t *best, ale_ways_t *ways)
{
    const bool seen = is_seen_there(p, prediction->before.pose, best, given);
    const bool denied = !seen && is_denied(p, &ways->believed, best, given);
    if (denied && is_step_witnessed(p, prediction, given)) {
        return ALE_RECOVER_STAYS;
    }
    if (denied && ale_timestamp_filter_is_dense(&p->timestamp_filter)) {
        return ALE_RECOVER_UNDECIDED;
    }
    return seen || ale_tracking_explains(best->fit) ? take_or_propose(p, prediction, given, best, seen, ways)
                                                    : ALE_RECOVER_STAYS;
}

/* What the comparison comes to, whatever tells of the given pose. rival_um: as compare(). */
static ale_recovery_t decide(ale_pipeline_t *p, const ale_prediction_t *prediction, candidate_t *given,
                             candidate_t *best, int64_t rival_um, ale_ways_t *ways)
{
    if (best->evidence_um <= rival_um + MARGIN_UM) {
        const bool more = best->evidence_um > given->evidence_um + MARGIN_UM;
        const bool open = (more || !ways->counted) && ale_tracking_accepts(best->fit);
        return open && !is_step_witnessed(p, prediction, given) ? ALE_RECOVER_OPEN : ALE_RECOVER_STAYS;
    }
    return best->evidence_um == given->evidence_um ? ALE_RECOVER_CONFIRMED
                                                   : decide_on_best(p, prediction, given, best, ways);
}

/* Whether another pose explains the scan clearly better than the given one, by the map and by the last scan,
 * but not so surely that it was taken, for then they are the same: nothing but the prediction tells that the
 * robot is here. */
static bool is_doubted(const ale_pipeline_t *p, ale_pose_t before, candidate_t *best, candidate_t *given)
{
    const int64_t more_um = best->evidence_um - given->evidence_um;
    if ((more_um <= 0) || is_same(best->fit, given->fit)) {
        return false;
    }
    const int64_t last_um = heard_more_um(p, before, best, given);
    return (last_um > 0) && ((more_um + last_um) > MARGIN_UM);
}

ale_recovery_t ale_step_recover(ale_pipeline_t *p, const ale_prediction_t *prediction, ale_ways_t *ways,
                                ale_fit_t *fit)
{
    const ale_vote_region_t region = region_of(p, prediction);
    candidate_t given = {.fit = fit, .evidence_um = evidence_um(p, fit)};
    candidate_t best = {.fit = &p->best, .evidence_um = given.evidence_um};
    p->best = *fit;
    p->searched = true;
    const int64_t rival_um = compare_region(p, &ways->believed, &region, &p->proposed, &best);
    const ale_recovery_t recovery = decide(p, prediction, &given, &best, rival_um, ways);
    if ((p->unconfirmed_from == 0) && (ale_recover_may_be_anywhere(p, prediction) ||
                                       is_doubted(p, prediction->before.pose, &best, &given))) {
        p->unconfirmed_from = p->scans;
    }
    switch (recovery) {
    case ALE_RECOVER_CONFIRMED:
    case ALE_RECOVER_STAYS:
        return is_told(p, prediction, &given) ? recovery : ALE_RECOVER_OPEN;
    default:
        return recovery;
    }
}
