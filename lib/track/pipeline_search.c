/* Lost: the search for the place that fits. */
#include "track/pipeline_steps.h"

enum {
    WHOLE_MAP_UM = 2000000000, /* a reach beyond any map */
    SEARCH_SIGMA_UM = 100000,
    SEARCH_SIGMA_URAD = 50000
};

/* Fits the scan to the map at about this pose. */
static void try_at(ale_pipeline_t *p, ale_pose_t pose)
{
    ale_motion_t there = p->motion;
    there.pose = pose;
    ale_motion_widen(&there, SEARCH_SIGMA_UM, SEARCH_SIGMA_URAD);
    ale_pipeline_match(p, &there, WHOLE_MAP_UM);
}

static void settle(ale_pipeline_t *p)
{
    p->motion = p->fit.motion;
    p->scale_error = (ale_scale_error_t){0, 0};
    p->claims = 0;
    ale_relocation_clear(&p->relocation);
    ale_tracking_found(&p->monitor);
}

/* Where the robot is said to be is looked at in every other scan, for a while. */
static bool is_claim_due(ale_pipeline_t *p)
{
    p->claims = (uint16_t)(p->claims > 0 ? p->claims - 1 : 0);
    return p->claims % 2 == 1;
}

static bool is_where_claimed(ale_pipeline_t *p)
{
    try_at(p, p->motion.pose);
    return ale_tracking_confirms(&p->fit);
}

static bool is_found(ale_pipeline_t *p)
{
    const ale_point_t anywhere = {0, 0};
    ale_local_map_approach(&p->map, anywhere, WHOLE_MAP_UM);
    const ale_scene_t scene = ale_pipeline_scene(p);
    const ale_mounted_scan_t mounted = {&p->scan, ale_pipeline_bearings(p), p->config.sensor};
    return ale_relocate(&p->relocation, &scene, &mounted, &p->motion, &p->fit) &&
           ale_tracking_accepts(&p->fit);
}

void ale_pipeline_search(ale_pipeline_t *p, ale_pose_t way, bool counted)
{
    p->broken = true;
    ale_relocation_follow(&p->relocation, way, counted);
    const bool found = is_claim_due(p) ? is_where_claimed(p) : is_found(p);
    if (found) {
        settle(p);
    }
    ale_stage_end(&p->hook, ALE_STAGE_MATCH);
}
