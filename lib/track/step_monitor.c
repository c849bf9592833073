#include "track/step_monitor.h"

#include <stddef.h>

#include "base/fixed.h"
#include "track/step_filter.h"
#include "track/step_recover.h"

enum {
    SLACK_URAD = 30000,
    SLACK_MOST_UM = 200000, /* a displacement that may be off by more says nothing of what was seen where */
    SLACK_MOST_URAD = 100000
};

/* How far the pose may be off when the last scan is compared: two sigmas more than is always allowed for. */
static ale_slack_t slack_of(const ale_matrix_t *cov, bool counted)
{
    const int64_t offset_um =
        ALE_WITNESS_SLACK_UM + 2 * ale_max64(ale_matrix_sigma(cov, 0), ale_matrix_sigma(cov, 1));
    return (ale_slack_t){
        (int32_t)ale_min64(offset_um, counted ? SLACK_MOST_UM : 2 * ALE_WITNESS_SLACK_UM),
        (int32_t)ale_min64(2 * ale_matrix_sigma(cov, 2), counted ? SLACK_MOST_URAD : SLACK_URAD), false};
}

/* Whether the last scan denies that the robot is where it was, after a time that nobody watched and in which
 * no wheels told of a way: a robot that stood sees what it saw. What has denied it once does so while scans
 * are waited for. */
static bool is_denied_to_stand(const ale_pipeline_t *p, const ale_prediction_t *prediction, bool strange,
                               const ale_seen_t *now)
{
    if (!ale_recover_is_unwatched(p, prediction) || p->driven) {
        return false;
    }
    if (p->waited > 0 && p->denied_to_stand) {
        return true;
    }
    if (strange) {
        return false; /* the last scan has been heard */
    }
    const ale_testimony_t testimony =
        ale_witness_hear(&p->witness, now, (ale_slack_t){ALE_WITNESS_SLACK_UM, SLACK_URAD, false});
    return ale_tracking_denies(&testimony);
}

ale_scene_verdict_t ale_step_monitor(ale_pipeline_t *p, const ale_prediction_t *prediction, bool counted,
                                     const ale_fit_t *fit)
{
    const bool strange = ale_tracking_is_strange(&p->monitor, fit);
    const ale_seen_t now = ale_pipeline_seen_from(p, prediction->before.pose, fit->motion.pose);
    ale_testimony_t testimony = {0};
    if (strange) {
        testimony = ale_witness_hear(&p->witness, &now, slack_of(&fit->motion.cov, counted));
    }
    ale_tracking_notice(&p->monitor, strange ? &testimony : NULL, counted, p->map.count > 0);
    p->denied_to_stand = is_denied_to_stand(p, prediction, strange, &now);
    p->monitor.contradicted = p->monitor.contradicted || p->denied_to_stand;
    if (p->monitor.contradicted) {
        return ALE_SCENE_CHANGED;
    }
    return strange ? ALE_SCENE_STRANGE : ALE_SCENE_KNOWN;
}

void ale_monitor_judge(ale_pipeline_t *p, const ale_fit_t *fit, const ale_visibility_counts_t *counts)
{
    ale_tracking_judge(&p->monitor, fit, counts, p->proposal.advantage_um > 0);
}
