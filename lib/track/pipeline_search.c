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
    p->claims = 0;
    ale_relocation_clear(&p->relocation);
    ale_tracker_found(&p->tracker);
}

/* Where the robot is said to be is looked at first, for a few scans. */
static bool is_where_claimed(ale_pipeline_t *p)
{
    if (p->claims == 0) {
        return false;
    }
    p->claims--;
    try_at(p, p->motion.pose);
    return ale_tracker_expected(&p->fit);
}

void ale_pipeline_search(ale_pipeline_t *p, ale_pose_t way)
{
    p->broken = true;
    if (is_where_claimed(p)) {
        settle(p);
        ale_stage_end(&p->hook, ALE_STAGE_MATCH);
        return;
    }
    const ale_point_t anywhere = {0, 0};
    ale_local_map_approach(&p->map, anywhere, WHOLE_MAP_UM);
    const ale_scene_t scene = {&p->map, p->view, p->view_count};
    const ale_eye_t eye = {&p->scan, ale_pipeline_bearings(p), p->config.sensor};
    if (ale_relocate(&p->relocation, &scene, &eye, &p->motion, way, &p->fit) &&
        ale_tracker_believes(&p->fit)) {
        settle(p);
    }
    ale_stage_end(&p->hook, ALE_STAGE_MATCH);
}
