#include "track/step_search.h"

#include "track/step_associate.h"
#include "track/step_observe.h"
#include "track/step_update.h"

enum {
    WHOLE_MAP_UM = 2000000000, /* a reach beyond any map */
    SEARCH_SIGMA_UM = 100000,
    SEARCH_SIGMA_URAD = 50000
};

/* Where the robot is said to be is tried with every other scan, for a while. */
static bool is_claim_due(ale_pipeline_t *p)
{
    p->claims = (uint16_t)(p->claims > 0 ? p->claims - 1 : 0);
    return p->claims % 2 == 1;
}

static bool is_where_claimed(ale_pipeline_t *p, const ale_motion_t *predicted, ale_fit_t *fit)
{
    ale_motion_t there = *predicted;
    ale_motion_widen(&there, SEARCH_SIGMA_UM, SEARCH_SIGMA_URAD);
    ale_pipeline_fit(p, &there, WHOLE_MAP_UM, fit);
    return ale_tracking_confirms(fit);
}

static bool is_found(ale_pipeline_t *p, const ale_motion_t *predicted, ale_fit_t *fit)
{
    const ale_point_t anywhere = {0, 0};
    ale_local_map_approach(&p->map, anywhere, WHOLE_MAP_UM);
    const ale_scene_t scene = ale_observed_scene(p);
    const ale_posed_scan_t mounted = {&p->observed.scan, ale_observed_bearings(&p->observed),
                                      p->config.sensor};
    return ale_relocate(&p->relocation, &scene, &mounted, predicted, fit) && ale_tracking_accepts(fit);
}

bool ale_step_search(ale_pipeline_t *p, const ale_prediction_t *prediction, ale_fit_t *fit)
{
    const ale_motion_t *predicted = &prediction->ways.believed;
    ale_relocation_follow(&p->relocation, ale_pose_between(prediction->before.pose, predicted->pose),
                          prediction->ways.counted);
    const bool found = is_claim_due(p) ? is_where_claimed(p, predicted, fit) : is_found(p, predicted, fit);
    if (found) {
        p->claims = 0;
        ale_relocation_clear(&p->relocation);
        ale_tracking_found(&p->monitor);
        ale_update_restart(p);
    }
    ale_stage_end(&p->hook, ALE_STAGE_MATCH);
    return found;
}
